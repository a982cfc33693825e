// node embed.mjs IN.wasm OUT.js: writes a script whose makeBytes() returns the bytes of IN.wasm. They are ASCII text that
// compresses well: base64 would break up what repeats. The module is taken apart first (decoder/bindings/npm/module.js);
// then the frequent bytes are one character each, the others two.
import { readFileSync, writeFileSync } from "node:fs";
import { dirname, relative } from "node:path";
import { fileURLToPath } from "node:url";
import { SIZE_BYTES, STREAMS, join, traverse } from "../npm/module.js";

const [input, output] = process.argv.slice(2);
const moduleScript = relative(dirname(output), fileURLToPath(new URL("../npm/module.js", import.meta.url)));
const module = readFileSync(input);

// The streams of a module. size: of the module that join() makes of them.
function split(module) {
  const streams = Array.from({ length: STREAMS }, () => []);
  let from = 0, size = module.length;
  const take = (stream) => {
    streams[stream].push(module[from]);
    return module[from++];
  };
  const skipNumber = (length) => {
    const begin = from;
    while (module[from++] > 127);
    size += length - (from - begin);
  };
  traverse(take, () => from < module.length, () => skipNumber(1), (content) => {
    skipNumber(SIZE_BYTES);
    content();
  });
  return { bytes: Buffer.from(streams.flat()), sizes: streams.map((stream) => stream.length), size };
}

const { bytes, sizes, size } = split(module), joined = join(bytes, sizes, size);
if (!WebAssembly.validate(joined) || Buffer.compare(split(joined).bytes, bytes) !== 0)
  throw new Error(`${input}: an opcode is not known`);

// Characters that need no escape in a string and none in a page's <script>.
const alphabet = Array.from({ length: 95 }, (_, i) => String.fromCharCode(32 + i)).filter((c) => !"\"\\<'`".includes(c)).join("");
const escapes = 2, singles = alphabet.length - escapes;

const counts = new Array(256).fill(0);
for (const byte of bytes) ++counts[byte];
const byFrequency = counts.map((_, byte) => byte).sort((a, b) => counts[b] - counts[a] || a - b);
const ascending = (list) => list.sort((a, b) => a - b);
// Characters in this order stand for bytes: first those that are single, then those after an escape.
const order = [...ascending(byFrequency.slice(0, singles)), ...ascending(byFrequency.slice(singles))];
const codes = new Array(256);
order.forEach((byte, i) => {
  const rest = i - singles, one = alphabet.length;
  codes[byte] = rest < 0 ? alphabet[i] : alphabet[singles + Math.floor(rest / one)] + alphabet[rest % one];
});
const isSingle = Array.from({ length: 64 }, (_, i) =>
  [0, 1, 2, 3].reduce((digit, k) => digit + (order.indexOf(4 * i + k) < singles ? 1 << k : 0), 0).toString(16));

writeFileSync(output, `import { join } from "${moduleScript}";

const text = "${Array.from(bytes, (byte) => codes[byte]).join("")}";

// Made by embed.mjs, which says how.
export function makeBytes() {
  const isSingle = (byte) => parseInt("${isSingle.join("")}"[byte >> 2], 16) >> (byte & 3) & 1;
  const order = Array.from({ length: 256 }, (_, i) => i).sort((a, b) => isSingle(b) - isSingle(a) || a - b);
  const place = (i) => ${JSON.stringify(alphabet)}.indexOf(text[i]);
  const bytes = new Uint8Array(${bytes.length});
  for (let from = 0, to = 0; from < text.length; ++from) {
    const first = place(from);
    bytes[to++] = order[first < ${singles} ? first : ${singles} + (first - ${singles}) * ${alphabet.length} + place(++from)];
  }
  return join(bytes, ${JSON.stringify(sizes)}, ${size});
}
`);
