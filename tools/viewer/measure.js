// Asks the worker that measures.
export class Measure {
  constructor() {
    this.worker = new Worker(new URL("measure_worker.js", import.meta.url), { type: "module" });
    this.waiting = new Map();
    this.next = 0;
    this.worker.onmessage = ({ data: { id, made, error } }) => {
      const { resolve, reject } = this.waiting.get(id);
      this.waiting.delete(id);
      if (error) reject(new Error(error));
      else resolve(made);
    };
  }
  // what: "original", "distances" or "folds". mesh: {positions, triangles}.
  ask(what, mesh) {
    return new Promise((resolve, reject) => {
      const id = this.next++;
      this.waiting.set(id, { resolve, reject });
      this.worker.postMessage({ id, what, mesh });
    });
  }
}
