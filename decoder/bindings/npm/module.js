// A WebAssembly module taken apart into streams, each of one kind of bytes: opcodes, local variables, constants and so on.
// What is alike stands together, so that brotli finds more of it. What follows from the rest is left out: sizes of code,
// and alignments, which are hints.

const REST = 0, DECLARED = 1, BRANCH = 2, CALL = 3, CONSTANT = 4, OFFSET = 5, LOCAL = 6, OPCODE = 7, BLOCK = OPCODE,
  VECTOR = 8;
export const STREAMS = 9;
export const SIZE_BYTES = 3; // of code, in a module that is put together

// Goes through a module from its start to its end. byte(stream) returns the next byte, which belongs to that stream;
// more() tells whether another section follows. aligned() is called at an alignment, sized(content) at a size; content()
// goes through what has that size.
export function traverse(byte, more, aligned, sized) {
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
    aligned();
    number(OFFSET);
  };
  const simd = () => {
    const opcode = number(OPCODE);
    if (opcode < 12 || (opcode > 83 && opcode < 94)) memory();
    if (opcode === 12 || opcode === 13) bytes(VECTOR, 16);
    if ((opcode > 20 && opcode < 35) || (opcode > 83 && opcode < 92)) byte(CONSTANT);
  };
  // Conversions that saturate, memory.copy and memory.fill.
  const memoryOfAnySize = () => {
    const opcode = number(OPCODE);
    bytes(CALL, opcode === 10 ? 2 : opcode === 11 ? 1 : 0);
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
      else if (opcode === 252) memoryOfAnySize();
      else if (opcode === 253) simd();
    }
  };
  bytes(REST, 8);
  while (more()) {
    if (byte(REST) !== 10) bytes(REST, number(REST));
    else
      sized(() => {
        for (let functions = number(REST); functions > 0; --functions)
          sized(() => {
            for (let kinds = number(DECLARED); kinds > 0; --kinds) number(DECLARED), byte(DECLARED);
            code();
          });
      });
  }
}

// Puts a module together. all: the bytes of all streams, one stream after the other; sizes: of each; size: of the module.
export function join(all, sizes, size) {
  let sum = 0, to = 0;
  const at = sizes.map((size) => (sum += size) - size);
  const module = new Uint8Array(size), end = sizes[REST];
  traverse(
    (stream) => (module[to++] = all[at[stream]++]),
    () => at[REST] < end,
    () => ++to,
    (content) => {
      const begin = (to += SIZE_BYTES);
      content();
      for (let i = 1, size = to - begin; i <= SIZE_BYTES; ++i, size >>= 7)
        module[begin - SIZE_BYTES - 1 + i] = i < SIZE_BYTES ? size | 128 : size;
    },
  );
  return module;
}
