// A worker: distances of points to the original mesh, and triangles that are folded over.
import { BufferAttribute, BufferGeometry, Vector3 } from "three";
import { MeshBVH } from "three-mesh-bvh";

const steepest = Math.cos((150 * Math.PI) / 180); // between the normals of triangles at an edge
let tree = null, original = null;

function setOriginal({ positions, triangles }) {
  original = new BufferGeometry();
  original.setAttribute("position", new BufferAttribute(positions, 3));
  original.setIndex(new BufferAttribute(triangles, 1));
  tree = new MeshBVH(original);
}

// Of each vertex; NaN for samples without a position.
function distances({ positions }) {
  const found = new Float32Array(positions.length / 3).fill(NaN), point = new Vector3(), hit = {};
  for (let v = 0; v < found.length; ++v) {
    point.fromArray(positions, 3 * v);
    if (!Number.isNaN(point.x)) found[v] = tree.closestPointToPoint(point, hit).distance;
  }
  return found;
}

const a = new Vector3(), b = new Vector3(), c = new Vector3();
function normalOf(positions, i, j, k, normal) {
  a.fromArray(positions, 3 * i);
  b.fromArray(positions, 3 * j).sub(a);
  c.fromArray(positions, 3 * k).sub(a);
  return normal.crossVectors(b, c).normalize();
}

// 1 for triangles that look away from the nearest point of the original.
function foldedAgainst({ positions, triangles }) {
  const folded = new Uint8Array(triangles.length / 3), n = new Vector3(), m = new Vector3(), centre = new Vector3(), hit = {};
  const corners = original.index.array, places = original.attributes.position.array;
  for (let t = 0; t < folded.length; ++t) {
    const [i, j, k] = triangles.subarray(3 * t, 3 * t + 3);
    normalOf(positions, i, j, k, n);
    centre.set(0, 0, 0);
    for (const v of [i, j, k]) centre.add(a.fromArray(positions, 3 * v));
    const face = tree.closestPointToPoint(centre.divideScalar(3), hit).faceIndex;
    normalOf(places, corners[3 * face], corners[3 * face + 1], corners[3 * face + 2], m);
    folded[t] = n.dot(m) < 0 ? 1 : 0;
  }
  return folded;
}

// Vertices at one place are one.
function weld(positions) {
  const first = new Map(), same = new Uint32Array(positions.length / 3);
  for (let v = 0; v < same.length; ++v) {
    const key = `${positions[3 * v]},${positions[3 * v + 1]},${positions[3 * v + 2]}`;
    if (!first.has(key)) first.set(key, v);
    same[v] = first.get(key);
  }
  return same;
}

// 1 for both triangles at an edge where the normal turns by more than 150 degrees.
function foldedBack({ positions, triangles }) {
  const folded = new Uint8Array(triangles.length / 3), same = weld(positions), edges = new Map();
  const n = new Vector3(), m = new Vector3();
  for (let i = 0; i < triangles.length; ++i) {
    const t = Math.floor(i / 3), v = same[triangles[i]], w = same[triangles[3 * t + ((i + 1) % 3)]];
    if (v === w) continue;
    const key = Math.min(v, w) * same.length + Math.max(v, w), other = edges.get(key);
    if (other === undefined) {
      edges.set(key, t);
      continue;
    }
    normalOf(positions, triangles[3 * t], triangles[3 * t + 1], triangles[3 * t + 2], n);
    normalOf(positions, triangles[3 * other], triangles[3 * other + 1], triangles[3 * other + 2], m);
    if (n.lengthSq() > 0 && m.lengthSq() > 0 && n.dot(m) < steepest) folded[t] = folded[other] = 1;
  }
  return folded;
}

const work = {
  original: setOriginal,
  distances: (mesh) => (tree ? distances(mesh) : null),
  folds: (mesh) => (tree ? foldedAgainst(mesh) : foldedBack(mesh)),
};
self.onmessage = ({ data: { id, what, mesh } }) => {
  try {
    self.postMessage({ id, made: work[what](mesh) });
  } catch (error) {
    self.postMessage({ id, error: error.message });
  }
};
