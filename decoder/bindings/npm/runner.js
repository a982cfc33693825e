// Runs requests on an instance, and replaces the instance where it must. A worker gets this function as text, as it gets
// core.js.

// makeCore: of core.js or refine.js. fail(status, text) throws an error with a status.
export function makeRunner(makeCore, fail) {
  // An instance's memory cannot shrink. One that has grown beyond this is replaced when its call is done.
  const keptMemory = 64 << 20;
  let module, core;
  const renew = () =>
    WebAssembly.instantiate(module, {}).then((instance) => {
      core = makeCore(instance.exports, fail);
    });
  return {
    open(compiled) {
      module = compiled;
      return renew();
    },
    run(bytes, request) {
      if (!core) throw new Error("gim is not ready: await GimDecoder.ready first");
      const used = core;
      let isIntact = false;
      try {
        const made = used.run(bytes, request);
        isIntact = true;
        return made;
      } catch (error) {
        isIntact = error.status !== undefined; // else the instance itself failed
        throw error;
      } finally {
        if (!isIntact || used.memorySize() > keptMemory) renew();
      }
    },
  };
}
