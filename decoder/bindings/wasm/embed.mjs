// node embed.mjs IN.wasm OUT.js: writes a module whose makeBytes() returns the bytes of IN.wasm.
// They are ASCII text that compresses as well as the bytes do, within 3 percent: base64 would break up what repeats. The
// frequent bytes are one character each, the others two.
import { readFileSync, writeFileSync } from "node:fs";

const [input, output] = process.argv.slice(2);
const bytes = readFileSync(input);

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

writeFileSync(output, `const text = "${Array.from(bytes, (byte) => codes[byte]).join("")}";

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
  return bytes;
}
`);
