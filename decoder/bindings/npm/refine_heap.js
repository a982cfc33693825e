// Memory of one WebAssembly instance, handed out in blocks, and what holds such blocks until it is disposed of.
import { GimError } from "gim/decoder";

export const LIMIT_EXCEEDED = 4, BAD_ARGUMENT = 5, SCRATCH_TOO_SMALL = 6;
const page = 65536, alignment = 64;

export function fail(status, text) {
  throw new GimError(status, text);
}

// value: what a caller wrote under `name`. Undefined becomes `otherwise`.
export function whole(value, name, otherwise, largest = 0xffffffff) {
  if (value === undefined) return otherwise;
  if (!(value >= 0 && value <= largest && value % 1 === 0)) fail(BAD_ARGUMENT, `${name} is no whole number in range`);
  return value;
}

export class Heap {
  // Compiles nothing. module: of gim/refine.
  static async make(module) {
    const heap = new Heap();
    const imports = { gim: { need: (...what) => heap.ask(...what) } };
    heap.wasm = (await WebAssembly.instantiate(module, imports)).exports;
    heap.base = Math.ceil(heap.wasm.__heap_base.value / alignment) * alignment;
    return heap;
  }
  constructor() {
    this.blocks = []; // {at, end}, in the order of memory
    this.need = null; // what a rule asks, while a mesh is refined
  }

  get isEmpty() {
    return this.blocks.length === 0;
  }
  get size() {
    return this.wasm.memory.buffer.byteLength;
  }

  // Returns the address of a block: in the first gap that is wide enough.
  take(size) {
    const wanted = Math.max(Math.ceil(size / alignment), 1) * alignment;
    let at = this.base, place = this.blocks.findIndex((block) => {
      if (block.at - at >= wanted) return true;
      at = block.end;
      return false;
    });
    if (place < 0) place = this.blocks.length;
    this.reach(at + wanted);
    this.blocks.splice(place, 0, { at, end: at + wanted });
    return at;
  }
  reach(end) {
    const missing = end - this.size;
    if (missing <= 0) return;
    try {
      this.wasm.memory.grow(Math.ceil(missing / page));
    } catch (error) {
      fail(LIMIT_EXCEEDED, "the browser has no memory of that size");
    }
  }
  release(at) {
    this.blocks.splice(this.blocks.findIndex((block) => block.at === at), 1);
  }

  // Views, until the next block is taken.
  floats(at, count) {
    return new Float32Array(this.wasm.memory.buffer, at, count);
  }
  numbers(at, count) {
    return new Uint32Array(this.wasm.memory.buffer, at, count);
  }
  bytes(at, count) {
    return new Uint8Array(this.wasm.memory.buffer, at, count);
  }
  row(at, count) {
    return Array.from(new Float64Array(this.wasm.memory.buffer, at, count));
  }

  check(status) {
    if (status === 0) return;
    const text = new Uint8Array(this.wasm.memory.buffer, this.wasm.gim_status_text(status));
    fail(status, String.fromCharCode(...text.subarray(0, text.indexOf(0))));
  }

  // Calls f(take, count). take(size) gives memory that is free again when f ends; count(size) takes none, and counts it.
  // most: bytes of all that.
  with(f, most = Infinity) {
    const taken = [];
    let left = most;
    const count = (size) => {
      left -= size;
      if (left < 0) fail(LIMIT_EXCEEDED, "this needs more than maxMemory");
    };
    const take = (size) => {
      count(size);
      taken.push(this.take(size));
      return taken[taken.length - 1];
    };
    try {
      return f(take, count);
    } finally {
      for (const at of taken) this.release(at);
    }
  }

  // Calls f while the module may ask `need` how much a vertex is needed. What it throws is thrown when f has ended.
  withNeed(need, f) {
    if (this.need) fail(BAD_ARGUMENT, "a need must not refine meshes itself");
    const asked = { need, error: null };
    this.need = asked;
    try {
      f();
    } finally {
      this.need = null;
    }
    if (asked.error) throw asked.error.thrown;
  }
  ask(...what) {
    const asked = this.need;
    if (asked.error) return 0;
    try {
      return asked.need(...what);
    } catch (thrown) {
      asked.error = { thrown };
      return 0;
    }
  }
}

// Something in the module's memory.
export class Handle {
  constructor(heap, owner) {
    this.heap = heap;
    this.owner = owner; // told when this is disposed of
    this.blocks = [];
    this.parts = new Set(); // handles that need this one
    owner.parts.add(this);
  }
  // Takes memory that stays until dispose().
  hold(size) {
    const at = this.heap.take(size);
    this.blocks.push(at);
    return at;
  }
  get isDisposed() {
    return this.heap === null;
  }
  // Returns the heap.
  alive() {
    if (!this.heap) fail(BAD_ARGUMENT, "it was disposed of");
    if (this.heap.need) fail(BAD_ARGUMENT, "a need must not call what is being refined");
    return this.heap;
  }
  dispose() {
    if (!this.heap) return;
    const heap = this.alive();
    for (const part of [...this.parts]) part.dispose();
    for (const at of this.blocks) heap.release(at);
    this.heap = null;
    this.owner.parts.delete(this);
    this.owner.forget?.(heap);
  }
}
if (typeof Symbol.dispose === "symbol") {
  Handle.prototype[Symbol.dispose] = function () {
    this.dispose();
  };
}
