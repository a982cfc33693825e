// Valid files that are made from others (spec/gim-format.md, chapter 3).
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

const bytesOf = (number) => [number & 255, (number >> 8) & 255, (number >> 16) & 255, number >>> 24];

// Returns a file of one image, that has no cut and whose origin is of binary32, with its surface `scale` times as large.
export function scaledFile(file, scale) {
  const made = Uint8Array.from(file), index = readLeb(file, 8), view = new DataView(made.buffer);
  for (let i = 0; i < 4; ++i) {
    const at = index.at + 5 + 4 * i; // Kind, Bits, Level_Count, Image_Count and Side_Exponent come before Origin and Step
    view.setFloat32(at, view.getFloat32(at, true) * scale, true);
  }
  made.set(bytesOf(crc32(made.subarray(0, index.value - 4))), index.value - 4);
  return made;
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
  const tail = bytesOf(crc32(head));
  return { bytes: Uint8Array.from([...head, ...tail, ...file.subarray(index.value), ...payload]) };
}
