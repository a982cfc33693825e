// GIMLoader, GIMMesh and GIMBudget without a picture.
import assert from "node:assert/strict";
import { test } from "node:test";
import { existsSync, symlinkSync } from "node:fs";
import { join } from "node:path";
import { here, importEntry, packageFolder, vector, vectorNames } from "./setup.mjs";

// The package finds three as an installed one would.
const modules = join(packageFolder, "node_modules");
if (!existsSync(modules)) symlinkSync(join(here, "node_modules"), modules);

const THREE = await import("three");
const { GimDecoder } = await importEntry("decoder");
const { GimSource } = await importEntry("source");
const { GIMBudget, GIMLoader, GIMMesh, planeTexture } = await importEntry("three");
await GimDecoder.ready;

const valid = vectorNames().valid.map(({ name }) => `${name}.gim`);
const until = (mesh, type) =>
  new Promise((resolve, reject) => {
    mesh.addEventListener(type, resolve);
    if (type !== "error") mesh.addEventListener("error", ({ error }) => reject(error));
  });
const camera = (distance) => {
  const made = new THREE.PerspectiveCamera(45, 1, 0.1, 1e6);
  made.position.set(0, 0, distance);
  return made;
};

test("the loader makes a sound geometry of each vector", async () => {
  const loader = new GIMLoader();
  for (const name of valid) {
    const bytes = vector(name), before = Uint8Array.from(bytes);
    const geometry = await loader.parseAsync(bytes);
    assert.deepEqual(Uint8Array.from(bytes), before, name);
    const { index, attributes, userData } = geometry, count = attributes.position.count;
    assert.ok(index.array.every((v) => v < count), name);
    for (const [attribute, width] of [["position", 3], ["normal", 3], ["uv", 2]]) {
      assert.equal(attributes[attribute].itemSize, width, name);
      assert.equal(attributes[attribute].count, count, name);
      assert.ok(attributes[attribute].array.every(Number.isFinite), `${name}: ${attribute}`);
    }
    const info = GimDecoder.info(bytes);
    assert.equal(userData.images.length, info.imageCount, name);
    assert.equal(geometry.groups.length, info.imageCount > 1 ? info.imageCount : 0, name);
    assert.deepEqual(userData.origin, info.isRelative ? info.origin : [0, 0, 0], name);
    assert.ok(geometry.boundingSphere.radius > 0, name);
    const point = new THREE.Vector3();
    const box = geometry.boundingBox.clone().expandByScalar(1e-4 * geometry.boundingSphere.radius);
    for (let v = 0; v < count; ++v) assert.ok(box.containsPoint(point.fromBufferAttribute(attributes.position, v)), name);
    const shows = GimDecoder.chunks(bytes).some((chunk) => ["COLR", "NRML"].includes(chunk.name));
    assert.equal(Boolean(userData.textures), shows, name);
  }
});

test("positions are those of the decoder", async () => {
  const bytes = vector("bounds.gim"), geometry = await new GIMLoader().setLevel(1).parseAsync(bytes);
  const mesh = GimDecoder.decodeHardMesh(bytes, { level: 1 });
  assert.deepEqual(geometry.attributes.position.array, mesh.positions);
  assert.deepEqual(Array.from(geometry.index.array), Array.from(mesh.triangles));
});

test("colours are texels at the samples' texture coordinates", () => {
  const name = valid.find((file) => file.includes("planes")), bytes = vector(name);
  const plane = GimDecoder.chunks(bytes).some((chunk) => chunk.name === "COLR") ? "colors" : "normals";
  const texture = planeTexture(bytes, { plane });
  const { width, height, values } = GimDecoder.decodePlane(bytes, { plane });
  assert.deepEqual([texture.image.width, texture.image.height], [width, height]);
  const uv = new THREE.Vector2(1, 0);
  texture.updateMatrix();
  uv.applyMatrix3(texture.matrix);
  assert.ok(Math.abs(uv.x * width - (width - 0.5)) < 1e-4 && Math.abs(uv.y * height - 0.5) < 1e-4);
  if (plane === "colors") assert.equal(texture.image.data[0], Math.round(255 * values[0]));
});

test("load() reports to its manager", async () => {
  const manager = new THREE.LoadingManager(), seen = [];
  manager.onStart = (url) => seen.push(`start ${url}`);
  manager.onLoad = () => seen.push("load");
  manager.onError = (url) => seen.push(`error ${url}`);
  const loader = new GIMLoader(manager);
  const data = `data:application/octet-stream;base64,${Buffer.from(vector("bounds.gim")).toString("base64")}`;
  await loader.loadAsync(data);
  await assert.rejects(loader.loadAsync("data:text/plain,nothing"), { statusName: "NOT_GIM" });
  assert.deepEqual(seen, [`start ${data}`, "load", "start data:text/plain,nothing", "error data:text/plain,nothing", "load"]);
});

test("a mesh shows the coarsest level first, then what the camera needs, and lets go of others", async () => {
  const bytes = vector("bounds.gim"), mesh = new GIMMesh(bytes), shown = [], disposed = [];
  mesh.addEventListener("levelchange", ({ level }) => {
    shown.push(level);
    mesh.geometry.addEventListener("dispose", () => disposed.push(level));
  });
  await until(mesh, "finished");
  const coarsest = mesh.levelCount - 1;
  assert.deepEqual(shown, [coarsest]);
  mesh.update(camera(10), 1000);
  await until(mesh, "finished");
  assert.equal(mesh.level, 0);
  assert.deepEqual(shown, [coarsest, 0]);
  assert.deepEqual(disposed, [coarsest]);
  mesh.setLevel(1);
  await until(mesh, "finished");
  assert.equal(mesh.level, 1);
  mesh.dispose();
  assert.deepEqual(disposed, [coarsest, 0, 1]);
});

test("a mesh that is far away is coarse, and stays so near the limit", async () => {
  // Its level 1 is off by 5352 units. A pixel is 0.83 units in 1000 units of distance.
  const mesh = new GIMMesh(vector("bounds.gim"));
  await until(mesh, "finished");
  for (const [distance, level] of [[1e7, 1], [7e6, 1], [6e6, 0], [7e6, 0], [1e7, 1]]) {
    mesh.update(camera(distance), 1000);
    if (mesh.level !== level) await until(mesh, "finished");
    assert.equal(mesh.level, level, `at ${distance}`);
  }
  mesh.scale.setScalar(2);
  mesh.update(camera(1e7), 1000);
  await until(mesh, "finished");
  assert.equal(mesh.level, 0, "twice as large, twice the error");
});

test("failures are events, not exceptions", async () => {
  const mesh = new GIMMesh(new TextEncoder().encode("no gim file"));
  const { error } = await until(mesh, "error");
  assert.equal(error.statusName, "NOT_GIM");
  mesh.update(camera(1), 100);
  const damaged = Uint8Array.from(vector("bounds.gim"));
  damaged[damaged.length - 3] ^= 1;
  const broken = new GIMMesh(damaged);
  await until(broken, "finished");
  const failed = until(broken, "error");
  broken.update(camera(10), 1000);
  assert.equal((await failed).error.statusName, "CHECKSUM");
  assert.equal(broken.level, broken.levelCount - 1, "what was shown stays");
});

test("meshes of one source", async () => {
  const source = await GimSource.open(vector("bounds.gim"));
  const meshes = [new GIMMesh(source, undefined, { level: 0 }), new GIMMesh(source, undefined, { level: 1 })];
  await Promise.all(meshes.map((mesh) => until(mesh, "finished")));
  meshes[0].dispose();
  assert.ok(source.has(0));
  assert.equal(meshes[1].level, 1);
});

test("a budget is kept, and near meshes come first", async () => {
  const bytes = vector("bounds.gim");
  const one = new GIMMesh(bytes, undefined, { level: 0 });
  await until(one, "finished");
  const budget = new GIMBudget(8 * one.byteCount);
  const meshes = Array.from({ length: 20 }, (_, i) => {
    const mesh = new GIMMesh(Uint8Array.from(bytes), undefined, { budget });
    mesh.position.z = -5000 * i;
    return mesh;
  });
  let most = 0;
  const eye = camera(0);
  const nextFrame = () => new Promise((resolve) => setTimeout(resolve, 5));
  for (let frame = 0; frame < 200; ++frame) {
    eye.position.z = 4000 - frame * 500;
    budget.update(eye, 1000);
    await nextFrame();
    most = Math.max(most, budget.byteCount);
  }
  assert.ok(most <= budget.maxBytes, `${most} bytes of ${budget.maxBytes}`);
  assert.ok(most > budget.maxBytes / 2, "it is used");
  eye.position.z = 4000;
  for (let frame = 0; frame < 100; ++frame) {
    budget.update(eye, 1000);
    await nextFrame();
  }
  assert.equal(meshes[0].level, 0);
  assert.ok(meshes.at(-1).level !== 0);
  assert.ok(meshes.every((mesh) => !mesh.error));
});
