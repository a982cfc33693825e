// Meshes that are as fine as each place needs, and clusters: gim/refine.h and gim/clusters.h for JavaScript. refine.d.ts
// describes it.
import { GimDecoder } from "gim/decoder";
import { makeBytes } from "gim-wasm"; // tools/npm.sh writes it
import { clusterIndices } from "./refine_clusters.js";
import { GimDomain } from "./refine_domain.js";
import { Heap } from "./refine_heap.js";

// Memory of an instance cannot shrink. One that has grown beyond this is replaced when nothing is in it.
const keptMemory = 64 << 20;

class Domains {
  constructor() {
    this.parts = new Set(); // domains that are not disposed of
    this.heap = null;
    this.ready = GimDecoder.ready.then(() => WebAssembly.compile(makeBytes())).then((module) => {
      this.module = module;
      return this.renew();
    });
    this.ready.catch(() => {}); // who awaits it hears of it
  }
  async renew() {
    this.heap = await Heap.make(this.module);
  }
  open(bytes, options) {
    if (!this.heap) throw new Error("gim is not ready: await GimRefine.ready first");
    return new GimDomain(this.heap, this, bytes, options);
  }
  forget(heap) {
    if (heap === this.heap && heap.isEmpty && heap.size > keptMemory) this.renew();
  }
}

const domains = new Domains();

export const GimRefine = {
  supported: GimDecoder.supported,
  ready: domains.ready,
  open: (bytes, options = {}) => domains.open(bytes, options),
  clusterIndices,
};
