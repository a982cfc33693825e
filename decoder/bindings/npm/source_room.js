// The first bytes of a file, as far as they have come.
export class Room {
  // bytes: what is here already. It stays the caller's.
  constructor(bytes = new Uint8Array(0)) {
    this.room = bytes;
    this.size = bytes.length;
  }
  // They stay as they are when more come.
  get bytes() {
    return this.room.subarray(0, this.size);
  }
  // whole: the size of the file, if it is known.
  append(bytes, whole) {
    const needed = this.size + bytes.length;
    if (needed > this.room.length) {
      const larger = new Uint8Array(Math.max(needed, Math.min(2 * needed, whole ?? needed)));
      larger.set(this.bytes);
      this.room = larger;
    }
    this.room.set(bytes, this.size);
    this.size = needed;
  }
}
