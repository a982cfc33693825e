// Workers that decode, made from the text of core.js. Where a policy of the page forbids them, work goes back to the
// thread that asked.
import { GimError } from "./error.js";
import { makeRunner } from "./runner.js";

// Runs in a worker.
function work(makeRunner, makeCore) {
  const runner = makeRunner(makeCore, (status, text) => {
    throw { status, text };
  });
  const answer = ({ id, bytes, request }) => {
    try {
      const made = runner.run(bytes, request);
      const arrays = Object.keys(made).map((name) => made[name]).filter((value) => ArrayBuffer.isView(value));
      self.postMessage({ id, made }, arrays.map((array) => array.buffer));
    } catch (error) {
      self.postMessage({ id, status: error.status, text: error.text || String(error) });
    }
  };
  self.onmessage = ({ data }) => {
    if (data.module) runner.open(data.module).then(() => self.postMessage({ isReady: true }));
    else answer(data);
  };
}

// Throws where there are no workers, or where a policy of the page forbids those of its own text.
function startWorker(source) {
  const blob = new Blob([source], { type: "text/javascript" });
  const url = URL.createObjectURL(blob);
  try {
    return new Worker(url);
  } finally {
    setTimeout(() => URL.revokeObjectURL(url), 10000); // browsers load it later
  }
}

export class Pool {
  // runHere(bytes, request): decodes on this thread.
  constructor(instance, runHere) {
    this.instance = instance;
    this.runHere = runHere;
    this.size = 0;
    this.workers = [];
    this.waiting = []; // jobs that no worker has yet
    this.jobs = new Map(); // those that a worker has, by number
    this.next = 0;
  }

  resize(size) {
    this.size = size;
    while (this.workers.length > size) this.dismiss(this.workers.pop());
    if (size === 0) this.flush();
  }

  // Returns a promise of what the request makes.
  submit(bytes, request, signal) {
    return new Promise((resolve, reject) => {
      const job = { bytes, request, resolve, reject, signal };
      const abort = () => {
        this.waiting = this.waiting.filter((other) => other !== job);
        this.settle(job, () => reject(signal.reason ?? new DOMException("decoding was aborted", "AbortError")));
      };
      if (signal) {
        if (signal.aborted) return abort();
        signal.addEventListener("abort", abort);
        job.release = () => signal.removeEventListener("abort", abort);
      }
      this.waiting.push(job);
      this.flush();
    });
  }

  settle(job, how) {
    if (job.isDone) return;
    job.isDone = true;
    if (job.release) job.release();
    how();
  }

  // Hands jobs to workers that have none, or does them here where there are none.
  flush() {
    if (this.size === 0) return this.flushHere();
    while (this.waiting.length > 0 && this.size > 0) {
      const worker = this.workers.find((w) => w.isReady && w.job === undefined);
      const starting = this.workers.filter((w) => !w.isReady).length;
      if (worker) this.hand(worker, this.waiting.shift());
      else if (this.workers.length < this.size && starting < this.waiting.length) this.hire();
      else return;
    }
  }

  // One job at a time, so that the page gets its turn between them, and so that a signal stops those that wait.
  flushHere() {
    if (this.isHere || this.waiting.length === 0) return;
    this.isHere = true;
    const turn = () => {
      this.isHere = false;
      const job = this.waiting.shift();
      if (!job) return;
      try {
        const made = this.runHere(job.bytes, job.request);
        this.settle(job, () => job.resolve(made));
      } catch (error) {
        this.settle(job, () => job.reject(error));
      }
      this.flush();
    };
    this.instance.ready.then(() => setTimeout(turn, 0), (error) => {
      this.isHere = false;
      for (const job of this.waiting.splice(0)) this.settle(job, () => job.reject(error));
    });
  }

  hand(worker, job) {
    const id = this.next++;
    const bytes = job.bytes.slice(); // the caller's stay his
    worker.job = id;
    this.jobs.set(id, { job, worker });
    worker.postMessage({ id, bytes, request: job.request }, [bytes.buffer]);
  }

  hire() {
    let worker;
    try {
      worker = startWorker(`(${work})(${makeRunner},${this.instance.makeCore})`);
    } catch (error) {
      return this.giveUp();
    }
    this.workers.push(worker);
    worker.onerror = (event) => {
      if (event.preventDefault) event.preventDefault();
      this.giveUp();
    };
    worker.onmessage = ({ data }) => {
      if (data.isReady) worker.isReady = true;
      else this.receive(worker, data);
      this.flush();
    };
    this.instance.ready.then(() => worker.postMessage({ module: this.instance.module }), () => this.giveUp());
  }

  receive(worker, { id, made, status, text }) {
    const { job } = this.jobs.get(id);
    this.jobs.delete(id);
    worker.job = undefined;
    if (made !== undefined) this.settle(job, () => job.resolve(made));
    else this.settle(job, () => job.reject(status === undefined ? new Error(text) : new GimError(status, text)));
  }

  dismiss(worker) {
    worker.terminate();
    for (const [id, entry] of this.jobs) {
      if (entry.worker !== worker) continue;
      this.jobs.delete(id);
      if (!entry.job.isDone) this.waiting.unshift(entry.job);
    }
  }

  // No workers are to be had: their work is done here.
  giveUp() {
    this.resize(0);
  }
}
