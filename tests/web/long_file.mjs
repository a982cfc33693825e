// A valid file with a long chunk that readers skip, behind its levels: a plane of any content would do as well.
import { crc16, crc32 } from "./checksums.mjs";

function leb(number) {
  const bytes = [];
  do bytes.push((number & 127) | (number > 127 ? 128 : 0));
  while ((number = Math.floor(number / 128)) > 0);
  return bytes;
}
function readLeb(bytes, at) {
  let value = 0, scale = 1;
  for (;; scale *= 128) {
    const byte = bytes[at++];
    value += (byte & 127) * scale;
    if (byte < 128) return { value, at };
  }
}

// Returns {bytes} of the file with a chunk of `size` bytes of an unknown, optional type at its end.
export function longFile(file, size) {
  const index = readLeb(file, 8);
  const payload = Uint8Array.from({ length: size }, (_, i) => (i * 2654435761) >>> 24);
  const crc = crc16(payload);
  const record = [...leb(77 * 4 + 1), ...leb(size), crc & 255, crc >> 8];
  const body = [...file.subarray(index.at, index.value - 4), ...record];
  let length = index.value;
  while (8 + leb(length).length + body.length + 4 !== length) length = 8 + leb(length).length + body.length + 4;
  const head = [...file.subarray(0, 8), ...leb(length), ...body];
  const check = crc32(head);
  const tail = [check & 255, (check >> 8) & 255, (check >> 16) & 255, check >>> 24];
  return { bytes: Uint8Array.from([...head, ...tail, ...file.subarray(index.value), ...payload]) };
}
