// The checksums of the format (spec, 3.3), bit by bit.
export function crc32(bytes) {
  let c = 0xffffffff;
  for (const byte of bytes) {
    c ^= byte;
    for (let i = 0; i < 8; ++i) c = c & 1 ? (c >>> 1) ^ 0xedb88320 : c >>> 1;
  }
  return ~c >>> 0;
}
export function crc16(bytes) {
  let c = 0xffff;
  for (const byte of bytes) {
    c ^= byte << 8;
    for (let i = 0; i < 8; ++i) c = c & 0x8000 ? ((c << 1) ^ 0x1021) & 0xffff : (c << 1) & 0xffff;
  }
  return c;
}
