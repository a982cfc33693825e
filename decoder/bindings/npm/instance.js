// The WebAssembly module. It is compiled from the text of the script, without a fetch.
import { fail } from "./error.js";
import { makeRunner } from "./runner.js";

export class Instance {
  // makeCore: of core.js or refine.js. makeBytes() returns the module.
  constructor(makeCore, makeBytes) {
    this.makeCore = makeCore;
    this.runner = makeRunner(makeCore, fail);
    this.supported = typeof WebAssembly === "object" && typeof WebAssembly.instantiate === "function";
    this.ready = this.supported ? this.compile(makeBytes()) : Promise.reject(new Error("gim needs WebAssembly"));
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
