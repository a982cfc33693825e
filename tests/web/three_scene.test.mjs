// Scenes of glTF files that refine as bytes arrive, against nginx on loopback. Pictures are in three_scene_browser.test.mjs.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, symlinkSync, utimesSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { glbOf, sceneGlb } from "./glb_scene.mjs";
import { encodedGlb, withoutProgram } from "./meshes.mjs";
import { startNginx, withoutNginx } from "./nginx.mjs";
import { here, importEntry, packageFolder } from "./setup.mjs";

const modules = join(packageFolder, "node_modules");
if (!existsSync(modules)) symlinkSync(join(here, "node_modules"), modules);

const THREE = await import("three");
const { GLTFLoader } = await import("three/examples/jsm/loaders/GLTFLoader.js");
const { GimDecoder } = await importEntry("decoder");
const { GimGlb, GimSourceError } = await importEntry("source");
const { GIMBudget, GIMGLTFExtension, loadGIMScene } = await importEntry("three");
await GimDecoder.ready;

const skip = withoutProgram || withoutNginx;
let folder, nginx, file;
before(async () => {
  if (skip) return;
  file = readFileSync(await encodedGlb("scene", () => sceneGlb(false), "--size", "65", "--lossless", "--bits", "16"));
  folder = mkdtempSync(join(tmpdir(), "gim-scene-"));
  mkdirSync(join(folder, "files"));
  writeFileSync(join(folder, "files/scene.glb"), file);
  nginx = await startNginx(folder);
});
after(async () => {
  await nginx?.stop();
  if (folder) rmSync(folder, { recursive: true, force: true });
});
const check = (name, run) => test(name, { skip }, run);
const at = (place, name = "scene.glb") => `${nginx.address}/${place}/${name}`;
const bufferOf = (bytes) => Uint8Array.from(bytes).buffer;
// The head is the JSON and little more: the file is small.
const load = (input, options = {}) => loadGIMScene(input, new GLTFLoader(), { firstBytes: 4096, ...options });
const loadWhole = async (level) => {
  const loader = new GLTFLoader().register((parser) => new GIMGLTFExtension(parser, { level }));
  return (await loader.parseAsync(bufferOf(file), "")).scene;
};

const camera = (distance) => {
  const made = new THREE.PerspectiveCamera(45, 1, 0.1, 1e6);
  made.position.set(0, 0, distance);
  return made;
};
const meshesOf = (root) => {
  const found = [];
  root.traverse((object) => object.isMesh && found.push(object));
  return found;
};
// Waits until all meshes show what they want.
async function settle(gltf) {
  const isBusy = (mesh) => !mesh.error && (mesh.isBusy || !mesh.isDone());
  for (let turns = 0; gltf.gim.meshes.some(isBusy); ++turns) {
    assert.ok(turns < 20000, "meshes come to rest");
    await new Promise((resolve) => setTimeout(resolve, 5));
  }
}
// Nodes, names, materials and arrays are the same.
function sameScene(scene, wanted) {
  for (const name of ["left", "middle", "right", "corner"]) {
    const [one, other] = [scene, wanted].map((root) => root.getObjectByName(name));
    assert.deepEqual(one.position, other.position);
    assert.deepEqual(one.scale, other.scale);
    const [meshes, others] = [one, other].map(meshesOf);
    assert.equal(meshes.length, others.length, name);
    meshes.forEach((mesh, i) => {
      assert.equal(mesh.material.name, others[i].material.name, name);
      const { geometry } = others[i];
      assert.deepEqual(Object.keys(mesh.geometry.attributes).sort(), Object.keys(geometry.attributes).sort());
      for (const key of Object.keys(geometry.attributes)) assert.deepEqual(mesh.geometry.attributes[key].array, geometry.attributes[key].array, `${name}: ${key}`);
      assert.deepEqual(mesh.geometry.index.array, geometry.index.array);
    });
  }
}

check("the program puts the .gim files first, one after the other", () => {
  const { length } = file, view = new DataView(bufferOf(file)), size = view.getUint32(12, true);
  const json = JSON.parse(file.subarray(20, 20 + size).toString());
  const ends = [0];
  for (const { primitives } of json.meshes.slice(0, 2)) {
    const { byteOffset, byteLength } = json.bufferViews[primitives[0].extensions.EXT_gim_geometry.bufferView];
    assert.equal(byteOffset, Math.ceil(ends.at(-1) / 4) * 4);
    ends.push(byteOffset + byteLength);
  }
  for (const view of json.bufferViews) if (view.byteOffset >= ends.at(-1)) assert.ok(view.byteOffset + view.byteLength <= length);
  assert.equal(json.bufferViews.filter(({ byteOffset }) => byteOffset < ends.at(-1)).length, 2);
});

check("the coarsest levels are shown by a part of the file, then what the camera needs", async () => {
  const gltf = await load(at("ranges")), { gim, scene } = gltf;
  assert.ok(gim.source.bytesLoaded < file.length / 2, `${gim.source.bytesLoaded} of ${file.length} bytes`);
  assert.ok(gim.source.requests <= 5, `${gim.source.requests} requests`);
  assert.equal(gim.meshes.length, 3);
  assert.ok(gim.meshes.every((mesh) => mesh.level === 2 && mesh.triangleCount > 0));
  sameScene(scene, await loadWhole(2));
  assert.equal(gltf.animations[0].name, "turn");

  const changes = [];
  for (const mesh of gim.meshes) mesh.addEventListener("levelchange", ({ level }) => changes.push(level));
  for (const mesh of gim.meshes) mesh.update(camera(1e5), 1000);
  await settle(gltf);
  assert.deepEqual(changes, [], "far away they stay coarse");
  const before = gim.source.requests;
  for (const mesh of gim.meshes) mesh.update(camera(8), 1000);
  await settle(gltf);
  assert.ok(gim.meshes.every((mesh) => mesh.level === 0));
  sameScene(scene, await loadWhole(0));
  assert.ok(gim.source.requests > before && gim.source.bytesLoaded <= file.length + 8192);
  for (const mesh of gim.meshes) mesh.update(camera(1e5), 1000);
  await settle(gltf);
  sameScene(scene, await loadWhole(2));
  gim.dispose();
});

check("the level can be fixed, and drawing chooses it else", async () => {
  const fixed = await load(at("ranges"), { level: 1 });
  await settle(fixed);
  sameScene(fixed.scene, await loadWhole(1));
  const free = await load(at("ranges"), { pixelError: 0.01 });
  const renderer = { getDrawingBufferSize: (size) => size.set(800, 600) };
  for (const part of meshesOf(free.scene)) part.onBeforeRender(renderer, free.scene, camera(10));
  await settle(free);
  sameScene(free.scene, await loadWhole(0));
  fixed.gim.dispose();
  free.gim.dispose();
});

check("nodes that share a mesh have levels of their own, and one file", async () => {
  const gltf = await load(at("ranges")), [middle, right] = ["middle", "right"].map((name) => gltf.scene.getObjectByName(name));
  assert.equal(middle.source, right.source);
  middle.update(camera(8), 1000);
  await settle(gltf);
  assert.deepEqual([middle.level, right.level], [0, 2]);
  const copy = gltf.scene.clone().getObjectByName("middle");
  await copy.first;
  copy.setLevel(0);
  await settle(gltf);
  assert.deepEqual(copy.parts[0].geometry.index.array, middle.parts[0].geometry.index.array);
  assert.equal(copy.parts[0].material, middle.parts[0].material);
  gltf.gim.dispose();
  assert.ok(copy.isDisposed);
});

check("a server without ranges, or one that compresses, gives the same", async () => {
  for (const place of ["no-ranges", "gzip"]) {
    const gltf = await load(at(place));
    for (const mesh of gltf.gim.meshes) mesh.setLevel(0);
    await settle(gltf);
    sameScene(gltf.scene, await loadWhole(0));
    if (place === "no-ranges") assert.deepEqual([gltf.gim.source.requests, gltf.gim.source.bytesLoaded], [1, file.length]);
    gltf.gim.dispose();
  }
});

check("bytes and blobs do as well, and a small file takes one request", async () => {
  for (const input of [file, bufferOf(file), new Blob([file])]) {
    const gltf = await load(input, { level: 0 });
    await settle(gltf);
    sameScene(gltf.scene, await loadWhole(0));
    gltf.gim.dispose();
  }
  const gltf = await load(at("ranges"), { level: 0, firstBytes: 1 << 20 });
  await settle(gltf);
  assert.equal(gltf.gim.source.requests, 1);
  gltf.gim.dispose();
});

check("levels are shown as their bytes come", async (t) => {
  const server = createServer(async (request, response) => {
    const [begin, end] = /^bytes=(\d+)-(\d+)$/.exec(request.headers.range).slice(1).map(Number), part = file.subarray(begin, end + 1);
    response.writeHead(206, { "content-range": `bytes ${begin}-${begin + part.length - 1}/${file.length}`, "content-length": part.length });
    for (let from = 0; from < part.length; from += 1000) {
      response.write(part.subarray(from, from + 1000));
      await new Promise((resolve) => setTimeout(resolve, 10));
    }
    response.end();
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  t.after(() => (server.closeAllConnections(), server.close()));
  const gltf = await load(`http://127.0.0.1:${server.address().port}/scene.glb`), shown = gltf.gim.meshes.map(({ level }) => [level]);
  gltf.gim.meshes.forEach((mesh, i) => {
    mesh.addEventListener("levelchange", ({ level }) => shown[i].push(level));
    mesh.setLevel(0);
  });
  await settle(gltf);
  assert.deepEqual(shown, [[2, 1, 0], [2, 1, 0], [2, 1, 0]]);
  sameScene(gltf.scene, await loadWhole(0));
  gltf.gim.dispose();
});

check("a file that changes is an error, and what is shown stays", async () => {
  const path = join(folder, "files/changing.glb");
  writeFileSync(path, file);
  const gltf = await load(at("ranges", "changing.glb")), errors = [];
  for (const mesh of gltf.gim.meshes) mesh.addEventListener("error", ({ error }) => errors.push(error));
  writeFileSync(path, Buffer.concat([file, Buffer.alloc(4)]));
  utimesSync(path, 1e9, 1e9);
  for (const mesh of gltf.gim.meshes) mesh.setLevel(0);
  await settle(gltf);
  assert.equal(errors.length, 3);
  assert.ok(errors.every((error) => error instanceof GimSourceError && error.code === "CHANGED"), String(errors[0]));
  sameScene(gltf.scene, await loadWhole(2));
  gltf.gim.dispose();
});

check("what is no such file, or is missing, damaged or cut off, is rejected", async () => {
  const put = (name, bytes) => (writeFileSync(join(folder, "files", name), bytes), at("ranges", name));
  await assert.rejects(load(at("ranges", "nothing.glb")), { name: "GimSourceError", code: "HTTP" });
  await assert.rejects(load(put("text.glb", Buffer.from("not a glb file at all, but some text"))), { code: "FORMAT" });
  await assert.rejects(load(put("short.glb", file.subarray(0, 30))), { code: "TRUNCATED" });
  await assert.rejects(load(put("tail.glb", file.subarray(0, 8000))), { name: "GimSourceError" });
  const damaged = Uint8Array.from(file), size = new DataView(damaged.buffer).getUint32(12, true);
  damaged[28 + size + 80] ^= 1; // in the first .gim
  await assert.rejects(load(put("damaged.glb", damaged)), { name: "GimError", statusName: "CHECKSUM" });
  const wrong = Uint8Array.from(file);
  wrong[20] ^= 1;
  await assert.rejects(load(put("json.glb", wrong)), { code: "FORMAT" });
});

check("a signal ends the load; dispose() ends requests and gives memory back", async () => {
  const controller = new AbortController();
  const loading = load(at("ranges"), { signal: controller.signal });
  controller.abort();
  await assert.rejects(loading, { name: "AbortError" });
  const gltf = await load(at("ranges")), [mesh] = gltf.gim.meshes, errors = [], disposed = [];
  mesh.addEventListener("error", ({ error }) => errors.push(error));
  for (const part of mesh.parts) part.geometry.addEventListener("dispose", () => disposed.push(part));
  mesh.setLevel(0);
  gltf.gim.dispose();
  await new Promise((resolve) => setTimeout(resolve, 50));
  assert.deepEqual(errors, []);
  assert.equal(disposed.length, mesh.parts.length);
  assert.equal(gltf.gim.meshes.length, 0);
  await assert.rejects(gltf.gim.source.read(0, 4), { code: "CLOSED" });
});

check("meshes share a budget", async () => {
  const fine = await load(at("ranges"), { level: 0 });
  await settle(fine);
  const all = fine.gim.meshes.reduce((sum, mesh) => sum + mesh.byteCount, 0);
  fine.gim.dispose();
  const budget = new GIMBudget(all * 0.8), gltf = await load(at("ranges"), { budget });
  let most = 0;
  const isFull = () => gltf.gim.meshes.some(({ level }) => level === 0);
  for (let frame = 0; frame < 60 || (!isFull() && frame < 5000); ++frame) {
    budget.update(camera(8), 1000);
    await new Promise((resolve) => setTimeout(resolve, 5));
    most = Math.max(most, budget.byteCount);
  }
  assert.ok(most <= budget.maxBytes, `${most} of ${budget.maxBytes}`);
  const levels = gltf.gim.meshes.map(({ level }) => level);
  assert.ok(isFull() && levels.some((level) => level !== 0), String(levels));
  gltf.gim.dispose();
  assert.equal(budget.byteCount, 0);
});

check("a loader's manager hears of it", async () => {
  const manager = new THREE.LoadingManager(), seen = [];
  manager.onStart = (url) => seen.push(`start ${url}`);
  manager.onLoad = () => seen.push("load");
  manager.onError = (url) => seen.push(`error ${url}`);
  manager.setURLModifier((url) => url.replace("other", "scene"));
  const loader = new GLTFLoader(manager).setPath(at("ranges", ""));
  (await loadGIMScene("other.glb", loader, { firstBytes: 4096 })).gim.dispose();
  await assert.rejects(loadGIMScene("nothing.glb", loader));
  assert.equal(seen[0], `start ${at("ranges")}`);
  assert.ok(seen.includes(`error ${at("ranges", "nothing.glb")}`) && seen.at(-1) === "load");
  assert.equal(loader.pluginCallbacks.filter((callback) => callback.name === "register").length, 0);
});

// ---- parts of a file ----

const body = Buffer.from(Array.from({ length: 60000 }, (_, i) => (i * 2654435761) >>> 24));
check("parts of one turn that lie close together come by one request", async () => {
  writeFileSync(join(folder, "files/parts.glb"), glbOf({ asset: { version: "2.0" } }, body));
  const glb = await GimGlb.open(at("ranges", "parts.glb"), { firstBytes: 64 }), before = glb.requests;
  assert.equal(glb.binSize, body.length);
  const wanted = [[9000, 100], [1000, 5000], [9050, 200], [7000, 10], [40000, 20000], [30, 0], [1000, 10]];
  const parts = await Promise.all(wanted.map(([offset, size]) => glb.read(offset, size)));
  parts.forEach((part, i) => assert.deepEqual(Buffer.from(part), body.subarray(wanted[i][0], wanted[i][0] + wanted[i][1]), String(wanted[i])));
  assert.equal(glb.requests, before + 2);
  await assert.rejects(glb.read(59999, 2), RangeError);
  const controller = new AbortController(), kept = glb.read(30000, 100), dropped = glb.read(30000, 200, { signal: controller.signal });
  controller.abort(new Error("enough"));
  await assert.rejects(dropped, /enough/);
  assert.deepEqual(Buffer.from(await kept), body.subarray(30000, 30100));
  const waiting = glb.read(20000, 5);
  glb.close();
  await assert.rejects(waiting, { code: "CLOSED" });
});
