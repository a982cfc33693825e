// A GLB file of which only parts are fetched: its JSON first, then what is asked for. What is asked for in one turn of the page
// and lies close together comes by one request.
import { GimSource } from "./source_levels.js";
import { GimSourceError } from "./source_error.js";
import { PartReader, bytesOf, readerOf } from "./source_reader.js";
import { Room } from "./source_room.js";

// A request costs more than so many bytes between two parts.
const gap = 4096;
// Of a .gim, in the first request for it: header, index, seams and coarse levels of most.
const firstBytesOfPart = 4096;
const headSize = 12, chunkHeadSize = 8;

// What a chunk's head says: {size, type}.
function chunkAt(bytes, at) {
  const view = new DataView(bytes.buffer, bytes.byteOffset + at, chunkHeadSize);
  return { size: view.getUint32(0, true), type: view.getUint32(4, true) };
}
const json = 0x4e4f534a, bin = 0x004e4942; // "JSON", "BIN\0"

export class GimGlb {
  // input: an address, a Blob, or the bytes.
  static async open(input, options = {}) {
    const glb = new GimGlb(input, options);
    const abort = () => glb.stop(options.signal.reason);
    try {
      options.signal?.throwIfAborted();
      options.signal?.addEventListener("abort", abort);
      await glb.begin(options.firstBytes ?? 16384);
      return glb;
    } catch (error) {
      glb.close();
      throw options.signal?.aborted ? options.signal.reason : error;
    } finally {
      options.signal?.removeEventListener("abort", abort);
    }
  }

  constructor(input, options) {
    this.limits = options.limits;
    this.onProgress = options.onProgress;
    this.reader = readerOf(input, options);
    this.room = new Room(this.reader ? undefined : bytesOf(input));
    this.controller = new AbortController();
    this.wants = []; // ranges that the next requests are for
  }
  get bytesLoaded() {
    return this.reader ? this.reader.bytesLoaded : this.room.size;
  }
  get requests() {
    return this.reader ? this.reader.requests : 0;
  }

  // The file's bytes up to the end of the JSON, and what came with them.
  async begin(firstBytes) {
    await this.reach(firstBytes);
    while (this.room.size < this.endOfJson()) {
      const wanted = this.endOfJson();
      await this.reach(wanted);
      if (this.room.size < wanted) throw this.truncated(wanted);
    }
    const { bytes } = this.room, { size } = chunkAt(bytes, headSize), from = headSize + chunkHeadSize;
    try {
      this.json = JSON.parse(new TextDecoder().decode(bytes.subarray(from, from + size)));
    } catch (cause) {
      throw new GimSourceError("FORMAT", `the JSON of the GLB is damaged: ${cause.message}`, { cause });
    }
    this.binBegin = from + size + chunkHeadSize;
    this.binSize = this.size > from + size ? this.readBin(from + size) : 0;
  }
  // Of the JSON, and of the head of the chunk behind it. The JSON's own head comes with the first bytes.
  endOfJson() {
    const { bytes } = this.room, from = headSize + chunkHeadSize, end = "the file is no GLB of version 2";
    if (bytes.length < from) throw new GimSourceError("FORMAT", end);
    const view = new DataView(bytes.buffer, bytes.byteOffset), { size, type } = chunkAt(bytes, headSize);
    if (view.getUint32(0, true) !== 0x46546c67 || view.getUint32(4, true) !== 2 || type !== json) throw new GimSourceError("FORMAT", end);
    this.size = view.getUint32(8, true);
    if (from + size > this.size) throw new GimSourceError("FORMAT", "the JSON of the GLB is longer than the file");
    return Math.min(from + size + chunkHeadSize, this.size);
  }
  readBin(at) {
    const { size, type } = chunkAt(this.room.bytes, at);
    if (type !== bin || this.binBegin + size > this.size) throw new GimSourceError("FORMAT", "the second chunk of the GLB is damaged");
    return size;
  }

  // Reads on at the end of the room.
  async reach(end) {
    const sink = {
      end,
      position: () => this.room.size,
      write: (bytes) => this.note(() => this.room.append(bytes, this.size)),
      restart: () => (this.json ? this.changed() : (this.room = new Room())),
    };
    while (this.reader && this.room.size < end) {
      const before = this.room.size;
      if ((await this.reader.read(sink, this.controller.signal)) || this.room.size === before) return;
    }
  }
  note(write) {
    if (this.controller.signal.aborted) return;
    write();
    this.onProgress?.({ loaded: this.bytesLoaded, total: this.size });
  }
  truncated(end) {
    return new GimSourceError("TRUNCATED", `the file ends before byte ${end}, which is needed`);
  }
  // Where the parts lie is told by the JSON that came first: nothing more can be read.
  changed() {
    this.stop(new GimSourceError("CHANGED", "the GLB changed while it was read: load it again"));
    throw this.controller.signal.reason;
  }

  // Resolves to bytes of the BIN chunk.
  async read(offset, size, { signal } = {}) {
    const part = new Room();
    await this.fetch(...this.placeOf(offset, size), (bytes) => part.append(bytes, size), signal);
    return part.bytes;
  }
  // Opens a .gim in the BIN chunk.
  async source(offset, size, options = {}) {
    const [begin, end] = this.placeOf(offset, size), isHere = end <= this.room.size;
    const input = isHere ? this.room.bytes.subarray(begin, end) : new PartReader(this, begin, size);
    return GimSource.open(input, { limits: this.limits, firstBytes: firstBytesOfPart, ...options });
  }
  placeOf(offset, size) {
    if (!(offset >= 0 && size >= 0 && offset + size <= this.binSize)) throw new RangeError("the part is not in the BIN chunk");
    return [this.binBegin + offset, this.binBegin + offset + size];
  }
  close() {
    this.stop(new GimSourceError("CLOSED", "the source was closed"));
    this.room = new Room();
  }
  stop(reason) {
    if (this.controller.signal.aborted) return;
    this.controller.abort(reason);
    for (const want of this.wants.splice(0)) want.settle(() => want.reject(reason));
  }

  // Calls write(bytes) with the bytes of the file from begin to end, one part after the other.
  fetch(begin, end, write, signal) {
    const { signal: closed } = this.controller;
    if (closed.aborted) return Promise.reject(closed.reason);
    if (signal?.aborted) return Promise.reject(signal.reason);
    return new Promise((resolve, reject) => {
      const want = { end, at: begin, write, resolve, reject, isDone: false };
      const abort = () => want.settle(() => reject(signal.reason));
      want.settle = (how) => {
        if (want.isDone) return;
        want.isDone = true;
        signal?.removeEventListener("abort", abort);
        how();
        want.group?.leave();
      };
      signal?.addEventListener("abort", abort);
      deliver(want, 0, this.room.bytes);
      if (want.isDone) return;
      if (!this.reader) return want.settle(() => reject(this.truncated(end)));
      this.wants.push(want);
      this.timer ??= setTimeout(() => this.send(), 0);
    });
  }
  send() {
    this.timer = undefined;
    const wants = this.wants.splice(0).filter((want) => !want.isDone).sort((a, b) => a.at - b.at);
    for (let first = 0, next; first < wants.length; first = next) {
      let { end } = wants[first];
      for (next = first + 1; next < wants.length && wants[next].at - end <= gap; ++next) end = Math.max(end, wants[next].end);
      this.request(wants.slice(first, next), end);
    }
  }
  async request(wants, end) {
    const controller = new AbortController();
    const leave = () => wants.every((want) => want.isDone) && controller.abort();
    for (const want of wants) want.group = { leave };
    const close = () => controller.abort(this.controller.signal.reason);
    this.controller.signal.addEventListener("abort", close);
    try {
      await this.readRange(wants, end, controller.signal);
      for (const want of wants) want.settle(() => want.reject(this.truncated(want.end)));
    } catch (error) {
      for (const want of wants) want.settle(() => want.reject(controller.signal.aborted ? controller.signal.reason : error));
    } finally {
      this.controller.signal.removeEventListener("abort", close);
    }
  }
  async readRange(wants, end, signal) {
    if (this.reader.hasRanges === false) return this.readAll(wants);
    let at = wants[0].at;
    const sink = {
      end,
      position: () => at,
      write: (bytes) => {
        this.note(() => wants.forEach((want) => deliver(want, at, bytes)));
        at += bytes.length;
      },
      restart: () => this.changed(),
    };
    while (at < end && !signal.aborted) {
      const before = at;
      if ((await this.reader.read(sink, signal)) || at === before) return;
    }
  }
  // The server has no ranges after all.
  async readAll(wants) {
    await (this.all ??= this.reach(this.size));
    for (const want of wants) deliver(want, 0, this.room.bytes);
  }
}

// Hands a want what it misses, of bytes that begin at `at`.
function deliver(want, at, bytes) {
  if (want.isDone || at > want.at) return;
  const part = bytes.subarray(want.at - at, Math.max(want.end - at, 0));
  if (part.length > 0) want.write(part);
  want.at += part.length;
  if (want.at === want.end) want.settle(want.resolve);
}
