// Fetches a .gim file as far as it is wanted: first bytes first, then what levels need. source.d.ts describes it.
import { GimDecoder } from "gim/decoder";
import { bytesOf, readerOf } from "./source_reader.js";
import { Room } from "./source_room.js";
import { GimSourceError } from "./source_error.js";

const NEED_MORE_INPUT = -1;
// Levels that end less than this behind the wanted one come with it: a request costs more than their bytes.
const gap = 4096;

// Whom to tell when the bytes up to `end` are there.
class Waiter {
  constructor(end, signal) {
    this.end = end;
    this.promise = new Promise((resolve, reject) => {
      this.resolve = resolve;
      this.reject = reject;
    });
    if (!signal) return;
    this.abort = () => this.reject(signal.reason ?? new DOMException("loading was aborted", "AbortError"));
    this.signal = signal;
  }
}

export class GimSource {
  // input: an address, a Blob, or the bytes.
  static async open(input, options = {}) {
    const source = new GimSource(input, options);
    try {
      await Promise.all([GimDecoder.ready, source.begin(options)]);
      source.readIndex();
      return source;
    } catch (error) {
      source.close();
      throw error;
    }
  }

  constructor(input, options) {
    this.limits = { ...options.limits };
    this.firstBytes = options.firstBytes ?? 16384;
    this.onProgress = options.onProgress;
    this.waiters = [];
    this.isClosed = false;
    this.generation = 0; // how often the file was read again from the start
    this.reader = readerOf(input, options);
    this.room = new Room(this.reader ? undefined : bytesOf(input));
  }

  // Bytes of the file from its start that are here. They stay as they are when more come.
  get bytes() {
    return this.room.bytes;
  }
  get have() {
    return this.room.size;
  }
  get bytesLoaded() {
    return this.reader ? this.reader.bytesLoaded : this.have;
  }
  get requests() {
    return this.reader ? this.reader.requests : 0;
  }
  get levelCount() {
    return this.info.levelCount;
  }

  // Header and index, usually by one request.
  async begin({ signal }) {
    for (let wanted = this.firstBytes; ; wanted *= 4) {
      await this.reach(wanted, signal, true);
      await GimDecoder.ready;
      try {
        GimDecoder.info(this.bytes, this.limits);
        return;
      } catch (error) {
        if (error.status !== NEED_MORE_INPUT || this.have < wanted) throw error;
      }
    }
  }
  readIndex() {
    this.info = GimDecoder.info(this.bytes, this.limits);
    this.chunks = GimDecoder.chunks(this.bytes, this.limits);
    this.ends = this.chunks.map((chunk) => chunk.offset + chunk.size);
    this.ofGeneration = this.generation;
  }

  // Bytes of the file that a level needs.
  levelSize(level) {
    return this.endOf((chunk) => chunk.name === "LEVL" && chunk.level === level, `level ${level}`);
  }
  endOf(matches, what) {
    const i = this.chunks.findIndex(matches);
    if (i < 0) throw new RangeError(`the file has no ${what}`);
    return this.ends[i];
  }
  has(level) {
    return this.have >= this.levelSize(level);
  }

  level(level, options) {
    return this.prefix(() => this.levelSize(level), options);
  }
  plane(name, options) {
    const chunk = { normals: "NRML", colors: "COLR", displacements: "DISP" }[name];
    return this.prefix(() => this.endOf((other) => other.name === chunk, `plane: ${name}`), options);
  }
  whole(options) {
    return this.prefix(() => this.info.fileSize, options);
  }
  // sizeOf() may differ after the wait: the file may be another.
  async prefix(sizeOf, { signal } = {}) {
    signal?.throwIfAborted();
    do await this.reach(sizeOf(), signal);
    while (this.have < sizeOf());
    return this.bytes;
  }

  close() {
    this.isClosed = true;
    this.running?.abort();
    this.failAll(new GimSourceError("CLOSED", "the source was closed"));
    this.room = new Room();
  }

  // Waits until the first `end` bytes are here. isOpen: the file may be shorter.
  async reach(end, signal, isOpen = false) {
    signal?.throwIfAborted();
    if (this.isClosed) throw new GimSourceError("CLOSED", "the source was closed");
    if (end <= this.have) return;
    if (!this.reader) {
      if (isOpen) return;
      throw this.truncated(end);
    }
    const waiter = new Waiter(end, signal);
    waiter.isOpen = isOpen;
    waiter.generation = this.generation;
    signal?.addEventListener("abort", waiter.abort);
    this.waiters.push(waiter);
    this.pump();
    try {
      await waiter.promise;
    } finally {
      signal?.removeEventListener("abort", waiter.abort);
      this.waiters = this.waiters.filter((other) => other !== waiter);
      if (signal?.aborted && this.waiters.length === 0) this.running?.abort(); // nobody wants it
    }
  }
  truncated(end) {
    return new GimSourceError("TRUNCATED", `the file ends after ${this.have} bytes, and ${end} are needed`);
  }

  // One request at a time, for all that wait. Calls of one turn of the page become one request.
  pump() {
    if (this.running || this.waiters.length === 0) return;
    const running = (this.running = new AbortController());
    const work = async () => {
      await null;
      if (running.signal.aborted || this.waiters.length === 0) return;
      await this.request(this.merged(Math.max(...this.waiters.map(({ end }) => end))), running.signal);
    };
    work()
      .catch((error) => running.signal.aborted || this.failAll(error))
      .finally(() => {
        if (this.running === running) this.running = undefined;
        this.pump();
      });
  }
  // Where a request should end, for a need that ends at `end`.
  merged(end) {
    const near = (this.ends ?? []).filter((other, i) => this.chunks[i].name === "LEVL" && other - end <= gap);
    return Math.max(end, ...near);
  }
  async request(end, signal) {
    const before = this.have;
    const sink = {
      end,
      position: () => this.have,
      write: (bytes) => signal.aborted || this.append(bytes),
      restart: () => this.restart(),
    };
    const atEnd = await this.reader.read(sink, signal);
    // The reader gave what there is. Whoever needs more than that asks in vain.
    for (const waiter of [...this.waiters]) {
      const mayEnd = waiter.isOpen || waiter.generation !== this.generation; // of another file: who waits looks again
      if (waiter.end <= this.have || (mayEnd && atEnd)) waiter.resolve();
      else if (atEnd || (this.have === before && !signal.aborted)) waiter.reject(this.truncated(waiter.end));
    }
  }
  append(bytes) {
    this.room.append(bytes, this.info?.fileSize);
    if (this.info && this.ofGeneration !== this.generation) this.refresh();
    this.onProgress?.({ loaded: this.have, total: this.info?.fileSize });
    for (const waiter of this.waiters) if (waiter.end <= this.have) waiter.resolve();
  }
  // The file has changed: what came before belongs to another file.
  restart() {
    ++this.generation;
    this.room = new Room();
  }
  refresh() {
    try {
      this.readIndex();
    } catch (error) {
      if (error.status !== NEED_MORE_INPUT) throw error;
    }
  }
  failAll(error) {
    for (const waiter of this.waiters) waiter.reject(error);
  }
}
