// A WebAssembly module taken apart into streams, each of one kind of bytes: opcodes, local variables, constants and so on.
// What is alike stands together, so that brotli finds more of it.

const REST = 0, BLOCK = 1, BRANCH = 2, CALL = 3, CONSTANT = 4, ALIGNMENT = 5, OFFSET = 6, LOCAL = 7, OPCODE = 8;
export const STREAMS = 9;

// Goes through a module from its start to its end. byte(stream) returns the next byte, which belongs to that stream;
// more() tells whether another section follows.
export function traverse(byte, more) {
  const bytes = (stream, count) => {
    while (count-- > 0) byte(stream);
  };
  const number = (stream) => {
    for (let value = 0, shift = 0; ; shift += 7) {
      const next = byte(stream);
      value |= (next & 127) << shift;
      if (next < 128) return value >>> 0;
    }
  };
  const memory = () => {
    number(ALIGNMENT);
    number(OFFSET);
  };
  const simd = () => {
    const opcode = number(OPCODE);
    if (opcode < 12 || (opcode > 83 && opcode < 94)) memory();
    if (opcode === 12 || opcode === 13) bytes(CONSTANT, 16);
    if ((opcode > 20 && opcode < 35) || (opcode > 83 && opcode < 92)) byte(CONSTANT);
  };
  const between = (x, first, last) => x >= first && x <= last;
  const code = () => {
    for (let depth = 1; depth > 0; ) {
      const opcode = byte(OPCODE);
      if (between(opcode, 2, 4)) ++depth, number(BLOCK);
      else if (opcode === 11) --depth;
      else if (between(opcode, 12, 13)) number(BRANCH);
      else if (opcode === 14) for (let count = number(BRANCH); count >= 0; --count) number(BRANCH);
      else if (opcode === 16) number(CALL);
      else if (opcode === 17) number(CALL), number(CALL);
      else if (between(opcode, 32, 34)) number(LOCAL);
      else if (between(opcode, 35, 36)) number(CALL);
      else if (between(opcode, 40, 62)) memory();
      else if (between(opcode, 63, 64)) byte(CALL);
      else if (between(opcode, 65, 66)) number(CONSTANT);
      else if (between(opcode, 67, 68)) bytes(CONSTANT, opcode === 67 ? 4 : 8);
      else if (opcode === 253) simd();
    }
  };
  bytes(REST, 8);
  while (more()) {
    const section = byte(REST), size = number(REST);
    if (section !== 10) bytes(REST, size);
    else
      for (let functions = number(REST); functions > 0; --functions) {
        number(REST);
        for (let locals = number(REST); locals > 0; --locals) number(REST), byte(REST);
        code();
      }
  }
}

// Puts a module together. all: the bytes of all streams, one stream after the other; sizes: of each.
export function join(all, sizes) {
  let sum = 0, to = 0;
  const at = sizes.map((size) => (sum += size) - size);
  const module = new Uint8Array(sum), end = sizes[REST];
  traverse(
    (stream) => (module[to++] = all[at[stream]++]),
    () => at[REST] < end,
  );
  return module;
}
