// Everything that gim/refine makes of a file, as words of 32 bits, in the order of write_refined.cpp. Works in Node and in a
// browser.
import { smallLimits } from "./decode_all.mjs";

const nothing = 0xffffffff;

class Words {
  constructor() {
    this.parts = [];
  }
  // A number of 32 bits, or a typed array. All NaNs are one.
  add(value) {
    if (typeof value === "number") return this.parts.push(Uint32Array.of(value));
    if (value instanceof Uint8Array) return this.parts.push(Uint32Array.from(value));
    const words = Uint32Array.from(new Uint32Array(value.buffer, value.byteOffset, value.length));
    if (value instanceof Float32Array) words.forEach((word, i) => (word & 0x7fffffff) > 0x7f800000 && (words[i] = 0x7fc00000));
    this.parts.push(words);
  }
  addFloat(value) {
    this.add(Float32Array.of(value));
  }
  all() {
    const words = new Uint32Array(this.parts.reduce((sum, part) => sum + part.length, 0));
    let at = 0;
    for (const part of this.parts) {
      words.set(part, at);
      at += part.length;
    }
    return words;
  }
}

// Adds the status of call(), 0 or that of what it throws. Returns what it returns; undefined if it throws.
function tried(words, call) {
  try {
    const made = call();
    words.add(0);
    return made ?? true;
  } catch (error) {
    if (typeof error.status !== "number") throw error;
    words.add(error.status);
    return undefined;
  }
}

function addWorths(domain, words) {
  const worths = new Float32Array(2 * domain.vertexCount);
  let worst = 0;
  for (let vertex = 0; vertex < domain.vertexCount; ++vertex) {
    const { error, radius } = domain.vertexWorth(vertex);
    worths.set([error, radius], 2 * vertex);
    worst = Math.max(worst, error);
  }
  words.add(worths);
  return worst;
}

// The rules of write_refined.cpp.
function rulesOf(domain, worst) {
  const first = domain.positions.subarray(0, 3), last = domain.positions.subarray(-3);
  const share = Math.fround(worst / 4);
  return [
    [{ objectError: worst / 8 }],
    [{ pixelError: 1, eye: first, verticalFov: Math.PI / 2, viewportHeight: 512, keep: 0.5 }, { mostOperations: 100 }],
    [{ objectError: worst / 16, mostTriangles: 2 * domain.tileCount + 50 }],
    [{ need: (vertex, x, y, z, error) => Math.fround(error / share) }],
    [{
      objectError: worst / 32, sphere: { center: last, radius: worst * 4 }, planes: [0, 0, 1, -last[2], 0, 1, 0, worst],
      box: { low: first.map((x, k) => Math.min(x, last[k])), high: first.map((x, k) => Math.max(x, last[k])) },
    }],
  ];
}

function addRefined(mesh, rule, options, words) {
  const done = tried(words, () => ({ done: mesh.refine(rule, options) }));
  if (!done) return;
  words.add(done.done ? 1 : 0);
  words.add(mesh.triangles);
  const { added, removed, triangles, trianglesBefore, triangleCount } = mesh.takeChanges();
  for (const part of [added, removed, triangles, trianglesBefore, triangleCount]) words.add(part);
}

function addHalfEdges(mesh, words) {
  for (let h = 0; h < 3 * mesh.triangleCount; ++h) {
    const edge = tried(words, () => mesh.halfEdge(h));
    if (!edge) return;
    const { mate, vertex, tile, start, end, level } = edge;
    words.add(Uint32Array.of(mate ?? nothing, vertex, tile, ...start, ...end, level));
  }
}

function addClusters(refine, domain, side, words) {
  const made = tried(words, () => domain.clusters({ side }));
  if (!made) return;
  words.add(0); // sizes and clusters are two calls of gim/clusters.h
  words.add(made.meshDepthCount);
  for (const d of made.depths) {
    words.add(Uint32Array.of(d.firstCluster, d.clusterCount, d.firstVertex, d.vertexCount, d.firstTriangle, d.triangleCount));
    words.addFloat(d.error);
  }
  for (let i = 0; i < made.clusterCount; ++i) {
    words.add(made.spheres.subarray(4 * i, 4 * i + 4));
    words.add(made.cones.subarray(8 * i, 8 * i + 7));
    words.add(made.errors.subarray(2 * i, 2 * i + 2));
    words.add(made.links.subarray(4 * i, 4 * i + 4));
    words.add(made.ranges.subarray(4 * i, 4 * i + 4));
  }
  words.add(made.vertices);
  words.add(made.triangles);
  words.add(refine.clusterIndices(made, made.depths[0].firstCluster, made.depths[0].clusterCount));
}

function walk(refine, domain, words) {
  words.add(Uint32Array.of(domain.tileCount, domain.intervals, domain.vertexCount, domain.width, domain.height, domain.mostTriangles));
  const worst = addWorths(domain, words);
  words.add(domain.sampleVertices());
  words.add(domain.layOutSamples(domain.positions, 3));
  const mesh = tried(words, () => domain.refined());
  if (!mesh) return;
  for (const [rule, options] of rulesOf(domain, worst)) addRefined(mesh, rule, options, words);
  addHalfEdges(mesh, words);
  const patches = tried(words, () => mesh.patches());
  if (patches) words.add(new Uint32Array(patches.buffer));
  tried(words, () => mesh.split(0));
  tried(words, () => mesh.weld(domain.vertexCount - 1));
  words.add(mesh.triangles);
  for (const side of [8, 4]) addClusters(refine, domain, side, words);
}

// Opens a domain, adds all of it, and disposes of it.
function addDomain(refine, bytes, options, words) {
  const domain = refine.open(bytes, options);
  words.add(0);
  if (options.details) words.add(domain.positions);
  walk(refine, domain, words);
  domain.dispose();
}

export function wordsOf(decoder, refine, bytes) {
  const words = new Words();
  const attempt = (call) => {
    try {
      return call();
    } catch (error) {
      if (typeof error.status !== "number") throw error;
      words.add(error.status);
      return undefined;
    }
  };
  const info = attempt(() => decoder.info(bytes, smallLimits));
  for (let image = 0; image < (info?.imageCount ?? 0); ++image) {
    for (let level = 0, coarsest = 0; level <= coarsest; ++level) {
      const at = { ...smallLimits, image, level };
      const found = attempt(() => decoder.levelInfo(bytes, at));
      if (!found) break;
      coarsest = found.coarsestLevel;
      const mesh = attempt(() => decoder.decodeMesh(bytes, { ...at, normals: false, texcoords: false, triangles: false }));
      if (!mesh) continue;
      attempt(() => addDomain(refine, bytes, { ...at, positions: mesh.positions }, words));
      if (level === 0) attempt(() => addDomain(refine, bytes, { ...at, positions: mesh.positions, details: true }, words));
    }
  }
  return words.all();
}

export function hashOf(words) {
  return words.reduce((hash, word) => Math.imul(hash ^ word, 16777619), 2166136261 | 0) >>> 0;
}
