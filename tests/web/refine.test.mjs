// gim/refine in Node, against the native library.
import assert from "node:assert/strict";
import { test } from "node:test";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { hashOf, wordsOf } from "./refine_all.mjs";
import { damagedFolder, importEntry, packageFolder, refinedFolder, vector } from "./setup.mjs";

const { GimDecoder, GimError } = await importEntry("decoder");
const { GimRefine } = await importEntry("refine");
await GimRefine.ready;

const linesOf = (path) => readFileSync(path, "utf8").trim().split("\n").map((line) => line.split(" "));
const throws = (call, statusName, message = /./) =>
  assert.throws(call, (error) => {
    assert.ok(error instanceof GimError);
    assert.equal(error.statusName, statusName);
    assert.match(error.message, message);
    return true;
  });

test("refined meshes, patches and clusters of all vectors are those of the native library", () => {
  const bytes = readFileSync(join(refinedFolder, "refined.bin"));
  const all = new Uint32Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
  let at = 0, opened = 0;
  for (const [name, count] of linesOf(join(refinedFolder, "refined.txt"))) {
    const found = wordsOf(GimDecoder, GimRefine, vector(`${name}.gim`)), wanted = all.subarray(at, at + Number(count));
    at += Number(count);
    const differs = found.findIndex((word, i) => word !== wanted[i]);
    assert.equal(differs, -1, `${name}: word ${differs} is ${found[differs]} instead of ${wanted[differs]}`);
    assert.equal(found.length, wanted.length, name);
    opened += found.length > 1000 ? 1 : 0;
  }
  assert.equal(at, all.length);
  assert.ok(opened > 40, `${opened} vectors have something to refine`);
});

test("damaged files give what they give natively, and no crash", (t) => {
  const damaged = readFileSync(join(damagedFolder, "damaged.bin")), sizes = linesOf(join(damagedFolder, "damaged.txt"));
  const wanted = linesOf(join(refinedFolder, "damaged-refined.txt"));
  assert.equal(wanted.length, sizes.length);
  let at = 0, opened = 0;
  wanted.forEach(([name, hash], i) => {
    const copy = damaged.subarray(at, (at += Number(sizes[i][1])));
    const words = wordsOf(GimDecoder, GimRefine, copy);
    assert.equal(hashOf(words), Number(hash), `${name}, copy ${i % 60}`);
    opened += words.length > 1000 ? 1 : 0;
  });
  t.diagnostic(`${wanted.length} copies, ${opened} of them with something to refine`);
  assert.ok(opened > 500);
});

const sphere = vector("sphere-33-lossy.gim"), torus = vector("tiles-torus-lossy.gim");

// Whether each edge of the triangles has one on its other side.
function isClosed(triangles) {
  const edges = new Set();
  const key = (a, b) => a * 1e6 + b;
  for (let i = 0; i < triangles.length; i += 3)
    for (let k = 0; k < 3; ++k) edges.add(key(triangles[i + k], triangles[i + ((k + 1) % 3)]));
  return edges.size === triangles.length && [...edges].every((edge) => edges.has(key(edge % 1e6, Math.floor(edge / 1e6))));
}

test("a mesh for a camera is fine where it is near, has no cracks, and follows by its changes", () => {
  for (const file of [sphere, torus]) {
    const { positions } = GimDecoder.decodeMesh(file), before = positions.slice();
    const domain = GimRefine.open(file, { positions }), mesh = domain.refined();
    const index = new Uint32Array(3 * mesh.mostTriangles);
    let shown = mesh.updateIndex(index);
    assert.equal(shown.triangleCount, 2 * domain.tileCount);
    const eye = [...positions.subarray(0, 3)].map((x) => 1.5 * x), view = { eye, verticalFov: 0.8, viewportHeight: 1000 };
    for (const pixelError of [8, 1, 20]) {
      assert.equal(mesh.refine({ ...view, pixelError }), true);
      shown = mesh.updateIndex(index);
      const drawn = index.subarray(0, 3 * shown.triangleCount);
      assert.deepEqual(drawn, mesh.triangles);
      assert.ok(isClosed(drawn), `${pixelError} pixels`);
      assert.ok(shown.triangleCount < domain.mostTriangles && shown.triangleCount > 2 * domain.tileCount);
    }
    mesh.refine({ ...view, pixelError: 0.001, mostTriangles: 500 });
    assert.ok(mesh.triangleCount <= 500 && mesh.triangleCount > 400);
    assert.deepEqual(mesh.updateIndex(index).triangleCount, mesh.triangleCount);
    assert.deepEqual(mesh.updateIndex(index), { triangleCount: mesh.triangleCount, start: 0, count: 0 });
    assert.deepEqual(positions, before);
    domain.dispose();
  }
});

test("work is cut into steps", () => {
  const mesh = GimRefine.open(sphere).refined(), rule = { objectError: 1e-6 };
  let steps = 0;
  while (!mesh.refine(rule, { mostOperations: 50 })) ++steps;
  assert.ok(steps > 5);
  mesh.owner.dispose();
});

test("positions are decoded where none are given, of the level that is asked for", () => {
  const domain = GimRefine.open(torus, { level: 1 }), { positions } = GimDecoder.decodeMesh(torus, { level: 1 });
  assert.deepEqual(domain.positions, positions);
  domain.dispose();
  for (const wrong of [positions.subarray(3), Array.from(positions), positions.map(() => NaN)])
    throws(() => GimRefine.open(torus, { level: 1, positions: wrong }), "BAD_ARGUMENT", /positions/);
});

test("details have a vertex buffer of their own", () => {
  const file = vector("displaced-sphere-17.gim"), plain = GimRefine.open(file), domain = GimRefine.open(file, { details: true });
  assert.ok(domain.vertexCount >= plain.vertexCount);
  assert.equal(domain.positions.length, 3 * domain.vertexCount);
  throws(() => GimRefine.open(sphere, { details: true }), "NO_SUCH_PLANE");
  throws(() => GimRefine.open(file, { details: true, level: 1 }), "BAD_ARGUMENT");
  plain.dispose();
  domain.dispose();
});

test("clusters of each depth are the whole surface, and those that look away are not seen", () => {
  const domain = GimRefine.open(sphere), clusters = domain.clusters(), { positions } = domain;
  for (const { firstCluster, clusterCount, triangleCount } of clusters.depths.slice(0, clusters.meshDepthCount)) {
    const indices = GimRefine.clusterIndices(clusters, firstCluster, clusterCount);
    assert.equal(indices.length, 3 * triangleCount);
    assert.ok(isClosed(indices));
  }
  const at = (v) => [...positions.subarray(3 * v, 3 * v + 3)];
  const minus = (a, b) => a.map((x, k) => x - b[k]), dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const eye = at(0).map((x) => 4 * x);
  let culled = 0;
  for (let c = 0; c < clusters.depths[0].clusterCount; ++c) {
    const [ax, ay, az, cutoff, ...axis] = clusters.cones.subarray(8 * c, 8 * c + 7), to = minus([ax, ay, az], eye);
    const indices = GimRefine.clusterIndices(clusters, c, 1);
    const [x, y, z, radius] = clusters.spheres.subarray(4 * c, 4 * c + 4);
    for (const v of indices) assert.ok(Math.hypot(...minus(at(v), [x, y, z])) <= radius);
    if (dot(to, axis) / Math.hypot(...to) < cutoff) continue;
    ++culled;
    for (let i = 0; i < indices.length; i += 3) {
      const [p, q, r] = [...indices.subarray(i, i + 3)].map(at);
      assert.ok(dot(cross(minus(q, p), minus(r, p)), minus(p, eye)) >= 0);
    }
  }
  assert.ok(culled > 0);
  throws(() => domain.clusters({ side: 5 }), "BAD_ARGUMENT");
  throws(() => domain.clusters({ maxMemory: 1000 }), "LIMIT_EXCEEDED", /maxMemory/);
  domain.dispose();
});

test("what cannot be refined is refused, and takes no memory", () => {
  throws(() => GimRefine.open(vector("charts-torus-lossy.gim")), "BAD_ARGUMENT", /mcgim/);
  throws(() => GimRefine.open(sphere, { image: 1 }), "BAD_ARGUMENT");
  throws(() => GimRefine.open(sphere, { level: 9 }), "NO_SUCH_LEVEL");
  throws(() => GimRefine.open(sphere.subarray(0, 60)), "NEED_MORE_INPUT");
  throws(() => GimRefine.open("sphere.gim"), "BAD_ARGUMENT");
  throws(() => GimRefine.open(sphere, { maxSamples: 100 }), "LIMIT_EXCEEDED");
  const { positions } = GimDecoder.decodeMesh(sphere);
  throws(() => GimRefine.open(sphere, { positions, maxMemory: 20000 }), "LIMIT_EXCEEDED", /maxMemory/);
});

test("rules that cannot be are refused, and the mesh stays", () => {
  const domain = GimRefine.open(sphere), mesh = domain.refined({ mostTriangles: 1000 }), before = mesh.triangles;
  const bad = [
    { pixelError: NaN }, { pixelError: -1 }, { eye: [1, 2] }, { eye: [1, 2, Infinity] }, { eye: "abc" }, { keep: 2 }, { planes: [1, 2, 3] },
    { box: { low: [1, 1, 1], high: [0, 0, 0] } }, { sphere: { center: [0, 0, 0], radius: -1 } }, { mostTriangles: 1.5 },
    { need: 5 }, { verticalFov: 4, viewportHeight: 100 }, { verticalFov: 1 }, { objectError: "much" },
  ];
  for (const rule of bad) throws(() => mesh.refine(rule), "BAD_ARGUMENT");
  throws(() => mesh.refine({}, { mostOperations: -1 }), "BAD_ARGUMENT");
  throws(() => mesh.halfEdge(3 * mesh.triangleCount), "BAD_ARGUMENT");
  throws(() => mesh.split(1e9), "BAD_ARGUMENT");
  throws(() => mesh.weld(domain.vertexCount), "BAD_ARGUMENT");
  throws(() => domain.vertexWorth(domain.vertexCount), "BAD_ARGUMENT");
  throws(() => domain.layOutSamples(new Float32Array(5), 3), "BAD_ARGUMENT");
  throws(() => domain.refined({ mostTriangles: 1 }), "BAD_ARGUMENT", /base/);
  throws(() => mesh.updateIndex(new Uint32Array(6)), "SCRATCH_TOO_SMALL");
  assert.deepEqual(mesh.triangles, before);
  domain.dispose();
});

test("a need may throw, and may not touch its mesh", () => {
  const domain = GimRefine.open(sphere), mesh = domain.refined();
  assert.throws(() => mesh.refine({ need: () => { throw new TypeError("not today"); } }), /not today/);
  throws(() => mesh.refine({ need: () => mesh.triangleCount }), "BAD_ARGUMENT");
  throws(() => mesh.refine({ need: () => domain.dispose() }), "BAD_ARGUMENT");
  const asked = [];
  mesh.refine({ need: (...what) => asked.push(what) && 0 });
  assert.ok(asked.length > 0 && asked.every((what) => what.length === 6));
  const [vertex, x, y, z, error, radius] = asked[0];
  assert.deepEqual([x, y, z], [...domain.positions.subarray(3 * vertex, 3 * vertex + 3)]);
  assert.deepEqual({ error, radius }, domain.vertexWorth(vertex));
  domain.dispose();
});

test("numbers of any size do no harm", () => {
  const domain = GimRefine.open(sphere), mesh = domain.refined();
  for (const size of [1e-40, 1e-20, 1e20, 1e38, 1e300]) {
    try {
      mesh.refine({ pixelError: 1, eye: [size, -size, size], verticalFov: 1, viewportHeight: 1000 });
      mesh.refine({ pixelError: size, eye: [0, 0, 0], verticalFov: 1, viewportHeight: size });
      mesh.refine({ objectError: size, sphere: { center: [size, 0, 0], radius: size } });
    } catch (error) {
      assert.equal(error.statusName, "BAD_ARGUMENT", error);
    }
    assert.ok(isClosed(mesh.triangles));
  }
  domain.dispose();
  const huge = GimDecoder.decodeMesh(sphere).positions.map((x) => x * 1e35), other = GimRefine.open(sphere, { positions: huge });
  const large = other.refined();
  for (const eye of [[0, 0, 0], [1e38, 1e38, 1e38], [1e37, 0, 0]]) {
    large.refine({ pixelError: 1, eye, verticalFov: 1, viewportHeight: 1000 });
    assert.ok(isClosed(large.triangles));
  }
  other.clusters();
  other.dispose();
});

test("what is disposed of is gone, with all that needs it, and its memory is used again", () => {
  const domain = GimRefine.open(sphere), mesh = domain.refined();
  domain.dispose();
  domain.dispose();
  assert.ok(domain.isDisposed && mesh.isDisposed);
  for (const call of [() => mesh.triangles, () => mesh.refine({}), () => domain.refined(), () => domain.clusters(), () => domain.sampleVertices()])
    throws(call, "BAD_ARGUMENT", /disposed/);
  assert.equal(domain.positions.length, 3 * domain.vertexCount);
  const used = () => process.memoryUsage().arrayBuffers;
  const work = () => {
    const own = GimRefine.open(sphere);
    own.refined().refine({ objectError: 0.01 });
    own.refined({ mostTriangles: 3000 }).dispose();
    own.dispose();
  };
  for (let i = 0; i < 20; ++i) work();
  globalThis.gc?.();
  const before = used();
  for (let i = 0; i < 500; ++i) work();
  globalThis.gc?.();
  assert.ok(used() - before < 50e6, `${used() - before} bytes more`);
});

test("meshes of many domains live side by side", () => {
  const names = ["sphere-33-lossy", "torus-33-lossy", "tiles-cube-lossy", "tiles-genus-2-sharp-lossy", "tiles-torus-lossy"];
  const domains = names.map((name) => GimRefine.open(vector(`${name}.gim`)));
  const meshes = [...domains, ...domains].map((domain) => domain.refined());
  meshes.forEach((mesh, i) => mesh.refine({ objectError: 0.002 * (i + 1) }));
  domains[1].dispose();
  const again = GimRefine.open(vector("torus-33-lossy.gim")).refined();
  again.refine({ objectError: 0.004 });
  meshes.forEach((mesh, i) => {
    if (mesh.isDisposed) return assert.equal(i % names.length, 1);
    const alone = GimRefine.open(vector(`${names[i % names.length]}.gim`)), other = alone.refined();
    other.refine({ objectError: 0.002 * (i + 1) });
    assert.deepEqual(mesh.triangles, other.triangles, names[i % names.length]);
    alone.dispose();
  });
  for (const domain of [...domains, again.owner]) domain.dispose();
});

test("Symbol.dispose is there where the engine has it", () => {
  const domain = GimRefine.open(sphere);
  assert.equal(typeof domain[Symbol.dispose ?? "dispose"], "function");
  domain[Symbol.dispose ?? "dispose"]();
  assert.ok(domain.isDisposed);
});

test("require() gives the same", async () => {
  const require = createRequire(import.meta.url), other = require(join(packageFolder, "refine.cjs"));
  await other.GimRefine.ready;
  const domain = other.GimRefine.open(torus), mine = GimRefine.open(torus);
  assert.deepEqual(domain.clusters(), mine.clusters());
  assert.throws(() => other.GimRefine.open(torus, { level: 9 }), require(join(packageFolder, "decoder.cjs")).GimError);
  domain.dispose();
  mine.dispose();
});
