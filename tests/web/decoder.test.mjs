// The package in Node.
import assert from "node:assert/strict";
import { test } from "node:test";
import { readFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { checkAll } from "./decode_all.mjs";
import { damagedFolder, packageFolder, vector, vectorNames, vectorsFolder } from "./setup.mjs";

const { GimDecoder, GimError } = await import(pathToFileURL(join(packageFolder, "decoder.mjs")));
await GimDecoder.ready;

// As an ArrayBuffer of its own.
async function read(path) {
  const [first, ...rest] = path.split("/");
  const bytes = await readFile(join(first === "vectors" ? vectorsFolder : damagedFolder, ...rest));
  return bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
}

const throws = (call, statusName, message = /./) =>
  assert.throws(call, (error) => {
    assert.ok(error instanceof GimError && error instanceof Error);
    assert.equal(error.name, "GimError");
    assert.equal(error.statusName, statusName);
    assert.match(error.message, message);
    return true;
  });

test("vectors and damaged files decode as they do natively", async (t) => {
  const { complaints, checked } = await checkAll(GimDecoder, vectorNames(), read);
  t.diagnostic(`${checked} files compared`);
  assert.deepEqual(complaints, []);
  assert.ok(checked > 10000);
});

test("an engine without SIMD is told apart", async () => {
  assert.equal(GimDecoder.supported, true);
  const { validate } = WebAssembly;
  try {
    WebAssembly.validate = () => false;
    const old = await import(`${pathToFileURL(join(packageFolder, "decoder.mjs"))}?without-simd`);
    assert.equal(old.GimDecoder.supported, false);
    await assert.rejects(old.GimDecoder.ready, /SIMD/);
  } finally {
    WebAssembly.validate = validate;
  }
});

test("errors have a class, a number and a name", () => {
  const file = vector("sphere-33-lossy.gim");
  throws(() => GimDecoder.info(file.subarray(0, 9)), "NEED_MORE_INPUT", /ends too early/);
  throws(() => GimDecoder.info(new TextEncoder().encode("not such a file")), "NOT_GIM");
  throws(() => GimDecoder.decodeMesh(file, { level: 13 }), "NO_SUCH_LEVEL");
  throws(() => GimDecoder.decodePlane(file, { plane: "colors" }), "NO_SUCH_PLANE");
  throws(() => GimDecoder.decodePlane(file, { plane: "smells" }), "BAD_ARGUMENT", /normals, colors/);
  throws(() => GimDecoder.decodeMesh(file, { level: -1 }), "BAD_ARGUMENT", /level/);
  throws(() => GimDecoder.decodeMesh(file, { level: 0.5 }), "BAD_ARGUMENT");
  throws(() => GimDecoder.decodeMesh(file, { image: 1 }), "BAD_ARGUMENT");
  throws(() => GimDecoder.info("sphere.gim"), "BAD_ARGUMENT", /ArrayBuffer/);
  assert.equal(new GimError(-1, "x").statusName, "NEED_MORE_INPUT");
  assert.equal(new GimError(7, "x").status, 7);
});

test("limits refuse before memory is taken", () => {
  const file = vector("sphere-33-lossy.gim");
  throws(() => GimDecoder.info(file, { maxSamples: 1000 }), "LIMIT_EXCEEDED");
  throws(() => GimDecoder.decodeMesh(file, { maxSide: 32 }), "LIMIT_EXCEEDED");
  throws(() => GimDecoder.decodeMesh(vector("two-images-lossy.gim"), { maxImages: 1 }), "LIMIT_EXCEEDED");
  throws(() => GimDecoder.decodeMesh(file, { maxMemory: 50000 }), "LIMIT_EXCEEDED", /maxMemory/);
  assert.equal(GimDecoder.decodeMesh(file, { maxMemory: 500000 }).positions.length, 3 * GimDecoder.levelInfo(file).vertexCount);
});

test("a file may be any view, and stays as it is", () => {
  const file = vector("tiles-torus-lossy.gim");
  const wanted = GimDecoder.decodeMesh(file);
  const shared = new SharedArrayBuffer(file.length + 3);
  new Uint8Array(shared).set(file, 3);
  const copy = file.buffer.slice(file.byteOffset, file.byteOffset + file.length);
  const before = Uint8Array.from(file);
  for (const bytes of [copy, new Uint8Array(copy), new DataView(copy), new Uint8Array(shared, 3)])
    assert.deepEqual(GimDecoder.decodeMesh(bytes), wanted);
  assert.deepEqual(Uint8Array.from(file), before);
  assert.equal(copy.byteLength, file.length);
});

test("a level needs its prefix and no more", () => {
  const file = vector("sphere-33-lossy.gim");
  const { prefixSize } = GimDecoder.levelInfo(file, { level: 1 });
  assert.ok(prefixSize < file.length);
  assert.deepEqual(GimDecoder.decodeMesh(file.subarray(0, prefixSize), { level: 1 }), GimDecoder.decodeMesh(file, { level: 1 }));
  throws(() => GimDecoder.decodeMesh(file.subarray(0, prefixSize - 1), { level: 1 }), "NEED_MORE_INPUT");
});

test("what a request leaves out is not there", () => {
  const file = vector("planes-sphere-17.gim");
  const mesh = GimDecoder.decodeMesh(file, { normals: false, texcoords: false, triangles: false });
  assert.deepEqual(Object.keys(mesh), ["positions"]);
  const { width, height, positions } = GimDecoder.decodePositions(file);
  assert.deepEqual([width, height, positions.length], [17, 17, 17 * 17 * 3]);
  assert.deepEqual(GimDecoder.decodeGrid(file).positions, positions);
});

test("text is read where it is not compressed", () => {
  assert.equal(GimDecoder.readText(vector("text-plain.gim")), "a short text");
  assert.equal(GimDecoder.readText(vector("sphere-33-lossy.gim")), "");
  throws(() => GimDecoder.readText(vector("text-zstd.gim")), "UNSUPPORTED_VERSION", /zstd/);
});

test("seams have a number for each sample of the rim", () => {
  const seams = GimDecoder.readSeams(vector("torus-33-lossy.gim"));
  assert.equal(seams.classOf.length, 4 * 32);
  assert.ok(seams.pathCount > 0);
  assert.equal(GimDecoder.readSeams(vector("tiles-torus-lossy.gim")).classOf, null);
});

test("memory does not grow with the number of decodes", () => {
  const file = vector("sphere-33-lossy.gim");
  const used = () => process.memoryUsage().arrayBuffers;
  for (let i = 0; i < 50; ++i) GimDecoder.decodeMesh(file);
  globalThis.gc?.();
  const before = used();
  for (let i = 0; i < 2000; ++i) GimDecoder.decodeMesh(file);
  globalThis.gc?.();
  assert.ok(used() - before < 100e6, `${used() - before} bytes more`);
});

test("decodeAsync gives the same, works in turn and obeys a signal", async () => {
  const file = vector("tiles-torus-lossy.gim");
  GimDecoder.useWorkers(2); // Node has no workers of this kind: it decodes here
  const all = await Promise.all(["mesh", "hardMesh", "grid", "positions"].map((what) => GimDecoder.decodeAsync(what, file)));
  assert.deepEqual(all[0], GimDecoder.decodeMesh(file));
  assert.deepEqual(all[2], GimDecoder.decodeGrid(file));
  await assert.rejects(GimDecoder.decodeAsync("mesh", file, { level: 9 }), { name: "GimError", statusName: "NO_SUCH_LEVEL" });
  await assert.rejects(GimDecoder.decodeAsync("soup", file), { statusName: "BAD_ARGUMENT" });
  const controller = new AbortController();
  const first = GimDecoder.decodeAsync("mesh", file);
  const waiting = GimDecoder.decodeAsync("mesh", file, { signal: controller.signal });
  controller.abort();
  await assert.rejects(waiting, { name: "AbortError" });
  assert.deepEqual(await first, all[0]);
  await assert.rejects(GimDecoder.decodeAsync("mesh", file, { signal: controller.signal }), { name: "AbortError" });
  throws(() => GimDecoder.useWorkers(1.5), "BAD_ARGUMENT");
  GimDecoder.useWorkers(0);
});

test("require() gives the same decoder", async () => {
  const other = createRequire(import.meta.url)(join(packageFolder, "decoder.cjs"));
  await other.GimDecoder.ready;
  const file = vector("torus-33-lossy.gim");
  assert.deepEqual(other.GimDecoder.decodeMesh(file), GimDecoder.decodeMesh(file));
  assert.throws(() => other.GimDecoder.info(file.subarray(0, 3)), other.GimError);
});
