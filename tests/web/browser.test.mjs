// The package in Chromium, from a plain <script type=module>. Skips where there is no browser.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { damagedFolder, here, launch, noBrowser, open, packageFolder, refinedFolder, serve, vectorNames, vectorsFolder } from "./setup.mjs";

const roots = { "": here, package: packageFolder, vectors: vectorsFolder, damaged: damagedFolder, refined: refinedFolder };
const skip = noBrowser;
const timeout = 120000;
let browser, served;
before(async () => {
  if (skip) return;
  served = await serve(roots);
  browser = await launch();
});
after(async () => {
  await browser?.close();
  served?.close();
});

async function openPage(address = served.address) {
  const opened = await open(browser, `${address}/page.html`);
  await opened.page.waitForFunction(() => window.GimDecoder);
  return opened;
}

test("vectors and damaged files decode as they do natively", { skip, timeout }, async (t) => {
  const { page, errors } = await openPage();
  const { complaints, checked } = await page.evaluate(async (names) => {
    await GimDecoder.ready;
    return checkAll(GimDecoder, names, read);
  }, vectorNames());
  t.diagnostic(`${checked} files compared`);
  assert.deepEqual(complaints, []);
  assert.ok(checked > 10000);
  assert.deepEqual(errors, []);
});

// Decodes all valid vectors at once by decodeAsync and compares with the synchronous calls. Runs in the page.
async function decodeAtOnce({ names, workers }) {
  await GimDecoder.ready;
  const started = [];
  const Original = window.Worker;
  window.Worker = class extends Original {
    constructor(...all) {
      super(...all);
      started.push(this);
    }
  };
  GimDecoder.useWorkers(workers);
  const files = await Promise.all(names.map((name) => read(`vectors/valid/${name}.gim`)));
  const sizes = files.map((file) => file.byteLength);
  const asynchronous = await Promise.all(files.map((file) => GimDecoder.decodeAsync("mesh", file)));
  const wrong = files.filter((file, i) => {
    const mesh = GimDecoder.decodeMesh(file);
    return Object.keys(mesh).some((key) => mesh[key].length !== asynchronous[i][key].length || mesh[key].some((x, k) => !Object.is(x, asynchronous[i][key][k])));
  });
  const failed = await GimDecoder.decodeAsync("mesh", new Uint8Array(5)).catch((error) => [error instanceof GimError, error.statusName]);
  GimDecoder.useWorkers(0);
  window.Worker = Original;
  return { wrong: wrong.length, started: started.length, failed, kept: files.every((file, i) => file.byteLength === sizes[i]) };
}
const valid = vectorNames().valid.map((v) => v.name);

test("workers give the same, and leave the caller his buffers", { skip, timeout }, async () => {
  const { page, errors } = await openPage();
  const found = await page.evaluate(decodeAtOnce, { names: valid, workers: 2 });
  assert.deepEqual(found, { wrong: 0, started: 2, failed: [true, "NOT_GIM"], kept: true });
  assert.deepEqual(errors, []);
});

// script-src lets the module compile; worker-src forbids workers made of text.
const policy = "script-src 'self' 'unsafe-inline' 'wasm-unsafe-eval'; worker-src 'none'";
test("a page that forbids workers decodes on its own thread", { skip, timeout }, async (t) => {
  const strict = await serve(roots, policy);
  t.after(strict.close);
  const { page, errors } = await openPage(strict.address);
  const found = await page.evaluate(decodeAtOnce, { names: valid.slice(0, 12), workers: 2 });
  assert.deepEqual({ ...found, started: 0 }, { wrong: 0, started: 0, failed: [true, "NOT_GIM"], kept: true });
  assert.deepEqual(errors, []);
});

test("gim/refine gives what it gives natively, under a strict policy", { skip, timeout }, async (t) => {
  const strict = await serve(roots, policy);
  t.after(strict.close);
  const { page, errors } = await openPage(strict.address);
  const wrong = await page.evaluate(async () => {
    const { GimRefine } = await import("/package/refine.mjs"), { wordsOf } = await import("/refine_all.mjs");
    await GimRefine.ready;
    const all = new Uint32Array(await read("refined/refined.bin")), wrong = [];
    const lines = new TextDecoder().decode(await read("refined/refined.txt")).trim().split("\n");
    let at = 0;
    for (const line of lines) {
      const [name, count] = line.split(" "), wanted = all.subarray(at, (at += Number(count)));
      const found = wordsOf(GimDecoder, GimRefine, await read(`vectors/valid/${name}.gim`));
      if (found.length !== wanted.length || found.some((word, i) => word !== wanted[i])) wrong.push(name);
    }
    return { wrong, compared: lines.length, words: at };
  });
  assert.deepEqual(wrong.wrong, []);
  assert.ok(wrong.compared > 60 && wrong.words > 1e6);
  assert.deepEqual(errors, []);
});

test("a page that forbids WebAssembly is told", { skip, timeout }, async (t) => {
  const strict = await serve(roots, "script-src 'self' 'unsafe-inline'");
  t.after(strict.close);
  const { page, errors } = await openPage(strict.address);
  const found = await page.evaluate(() =>
    GimDecoder.ready.then(
      () => "ready",
      (error) => error.name,
    ),
  );
  assert.equal(found, "CompileError");
  const rejected = await page.evaluate(() => GimDecoder.decodeAsync("mesh", new Uint8Array(5)).catch((error) => error.name));
  assert.equal(rejected, "CompileError");
  assert.deepEqual(errors, []);
});

test("a signal rejects at once: while a worker decodes, while a file waits, before it begins", { skip, timeout }, async () => {
  const { page, errors } = await openPage();
  const found = await page.evaluate(async (name) => {
    await GimDecoder.ready;
    GimDecoder.useWorkers(1);
    const file = await read(`vectors/valid/${name}.gim`);
    await GimDecoder.decodeAsync("mesh", file); // the worker is there
    const controllers = [new AbortController(), new AbortController(), new AbortController()];
    controllers[2].abort();
    const jobs = controllers.map(({ signal }) => GimDecoder.decodeAsync("grid", file, { signal }));
    controllers[0].abort();
    controllers[1].abort();
    const names = await Promise.all(jobs.map((job) => job.then(() => "decoded", (error) => error.name)));
    const custom = new AbortController();
    const job = GimDecoder.decodeAsync("grid", file, { signal: custom.signal });
    custom.abort(new Error("enough"));
    names.push(await job.catch((error) => error.message));
    names.push((await GimDecoder.decodeAsync("mesh", file)).positions.length > 0); // the worker goes on
    return names;
  }, "sphere-33-lossy");
  assert.deepEqual(found, ["AbortError", "AbortError", "AbortError", "enough", true]);
  assert.deepEqual(errors, []);
});

test("jobs survive a change of the number of workers", { skip, timeout }, async () => {
  const { page, errors } = await openPage();
  const found = await page.evaluate(async (name) => {
    GimDecoder.useWorkers(3); // not ready yet
    const file = await read(`vectors/valid/${name}.gim`);
    const jobs = Array.from({ length: 20 }, () => GimDecoder.decodeAsync("mesh", file));
    GimDecoder.useWorkers(1);
    await jobs[0];
    GimDecoder.useWorkers(0);
    return (await Promise.all(jobs)).length;
  }, "sphere-33-lossy");
  assert.equal(found, 20);
  assert.deepEqual(errors, []);
});
