// The WebAssembly module. It is compiled from the text of the script, without a fetch.
import { fail } from "./error.js";
import { makeRunner } from "./runner.js";

// A module with one SIMD instruction: () => v128, which splats a number.
const probe = [0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 8, 1, 6, 0, 65, 0, 253, 15, 11];

export class Instance {
  // makeCore: of core.js or refine.js. makeBytes() returns the module.
  constructor(makeCore, makeBytes) {
    this.makeCore = makeCore;
    this.runner = makeRunner(makeCore, fail);
    this.supported = typeof WebAssembly === "object" && WebAssembly.validate(new Uint8Array(probe));
    this.ready = this.supported ? this.compile(makeBytes()) : Promise.reject(new Error("gim needs WebAssembly with SIMD"));
    this.ready.catch(() => {}); // who awaits it hears of it
  }

  compile(bytes) {
    return WebAssembly.compile(bytes).then((module) => {
      this.module = module;
      return this.runner.open(module);
    });
  }

  run(bytes, request) {
    return this.runner.run(bytes, request);
  }
}
