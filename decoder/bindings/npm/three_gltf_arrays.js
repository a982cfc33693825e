// The arrays that primitives with EXT_gim_geometry have at a level. Numbers are those of the steps in the extension's text.
import { BufferAttribute, BufferGeometry, Vector3 } from "three";
import { GimDecoder } from "gim/decoder";
import { levelOf, smallTriangles } from "./three_geometry.js";

export const extensionName = "EXT_gim_geometry";

// What a primitive asks for.
export function shapeOf({ attributes, extensions }) {
  const { label, places } = extensions[extensionName];
  const isTextured = attributes.TEXCOORD_0 !== undefined;
  return { isTextured, hasTangents: isTextured && attributes.TANGENT !== undefined, label, places };
}

// Decodes images at a level of the file. primitives: of shapeOf(). ofLabels: bytes with header, index, seams and labels. how: as
// that of decodeParts().
export function decodeImages(bytes, ofLabels, images, level, primitives, { signal, atOnce = true, ...limits }) {
  const isTextured = primitives.some((primitive) => primitive.isTextured);
  const isLabelled = primitives.some(({ label }) => label !== undefined);
  return Promise.all(images.map(async (image) => {
    const own = levelOf(image, level), request = { ...limits, image: image.image, level: own };
    const isSmall = atOnce && image.levels[own].triangles <= smallTriangles;
    const decode = (kind, now) => (isSmall ? now(bytes, request) : GimDecoder.decodeAsync(kind, bytes, { ...request, signal }));
    const [hard, grid] = await Promise.all([
      decode("hardMesh", GimDecoder.decodeHardMesh), isTextured ? decode("grid", GimDecoder.decodeGrid) : null,
    ]);
    return { image: image.image, hard, grid, labels: isLabelled ? labelsOf(ofLabels, request) : null };
  }));
}
// Null: the file has none, so all are 0.
function labelsOf(bytes, request) {
  try {
    return GimDecoder.decodeLabels(bytes, request);
  } catch (error) {
    if (error.statusName !== "NO_SUCH_PLANE") throw error;
    return null;
  }
}

// Returns a geometry for each primitive.
export function makeGeometries(images, primitives, info) {
  const surfaces = images.map(({ hard, grid }) => {
    if (grid) takeNormals(grid, hard); // 1
    for (const surface of [hard, grid]) if (surface) finish(surface, info); // 4, 5
    return new Map();
  });
  return primitives.map((primitive) => {
    const parts = images.map((image, i) => choose(surfaceFor(image, primitive, surfaces[i]), image.labels, primitive.label));
    return joined(parts, primitive);
  });
}

// Samples have the normals that the mesh for shading has at the same corners.
function takeNormals(grid, hard) {
  for (let i = 0; i < grid.triangles.length; ++i)
    for (let k = 0; k < 3; ++k) grid.normals[3 * grid.triangles[i] + k] = hard.normals[3 * hard.triangles[i] + k];
}
function finish({ positions, normals }, { isRelative, origin }) {
  if (isRelative) for (let i = 0; i < positions.length; ++i) positions[i] += origin[i % 3];
  for (let i = 0; i < normals.length; i += 3) if (!normals[i] && !normals[i + 1] && !normals[i + 2]) normals[i + 2] = 1;
}

// The arrays of an image before its triangles are chosen. Primitives that ask for the same ones share them. made: those that
// were made.
function surfaceFor({ image, hard, grid }, { isTextured, hasTangents, places }, made) {
  if (!isTextured) return { positions: hard.positions, normals: hard.normals, triangles: hard.triangles };
  const place = places?.slice(3 * image, 3 * image + 3), key = JSON.stringify([place, hasTangents]);
  if (!made.has(key)) {
    const { positions, normals, triangles } = grid;
    const texcoords = place ? grid.texcoords.map((x, i) => place[i % 2] + place[2] * x) : grid.texcoords; // 6
    const surface = { positions, normals, triangles, texcoords };
    if (hasTangents) surface.tangents = tangentsOf(surface); // 7
    made.set(key, surface);
  }
  return made.get(key);
}

const widths = { positions: 3, normals: 3, texcoords: 2, tangents: 4 };
const names = { positions: "position", normals: "normal", texcoords: "uv", tangents: "tangent" };
const fieldsOf = ({ isTextured, hasTangents }) =>
  ["positions", "normals", ...(isTextured ? ["texcoords"] : []), ...(hasTangents ? ["tangents"] : [])];

// The part with the triangles of a label (undefined: all) and the vertices that they use: 2.
function choose(surface, labels, label) {
  const { triangles } = surface, numbers = new Uint32Array(surface.positions.length / 3);
  const stays = (triangle) => label === undefined || (labels ? labels[triangle >> 1] : 0) === label;
  const kept = new Uint32Array(triangles.length);
  let count = 0, next = 0;
  for (let i = 0; i < triangles.length; i += 3)
    if (stays(i / 3)) for (let k = 0; k < 3; ++k) numbers[(kept[count++] = triangles[i + k])] = 1;
  const vertices = new Uint32Array(numbers.length);
  for (let v = 0; v < numbers.length; ++v) {
    if (numbers[v] === 0) continue;
    vertices[next] = v;
    numbers[v] = next++;
  }
  const chosen = { triangles: kept.subarray(0, count).map((v) => numbers[v]), count: next };
  for (const field of Object.keys(widths)) {
    if (!surface[field]) continue;
    const width = widths[field], from = surface[field], to = (chosen[field] = new Float32Array(next * width));
    for (let i = 0; i < next; ++i) for (let k = 0; k < width; ++k) to[i * width + k] = from[vertices[i] * width + k];
  }
  return chosen;
}

// One geometry of the images: 3. parts: none for an empty one.
export function joined(parts, primitive) {
  const geometry = new BufferGeometry(), vertexCount = parts.reduce((sum, { count }) => sum + count, 0);
  for (const field of fieldsOf(primitive)) {
    const all = new Float32Array(vertexCount * widths[field]);
    let at = 0;
    for (const part of parts) {
      all.set(part[field], at);
      at += part[field].length;
    }
    geometry.setAttribute(names[field], new BufferAttribute(all, widths[field]));
  }
  const indexCount = parts.reduce((sum, { triangles }) => sum + triangles.length, 0);
  const index = new (vertexCount > 65535 ? Uint32Array : Uint16Array)(indexCount);
  let first = 0, at = 0;
  for (const { triangles, count } of parts) {
    for (let i = 0; i < triangles.length; ++i) index[at++] = triangles[i] + first;
    first += count;
  }
  geometry.setIndex(new BufferAttribute(index, 1));
  return geometry;
}

function tangentsOf({ positions, normals, texcoords, triangles }) {
  const sums = new Float64Array(positions.length), tangents = new Float32Array((positions.length / 3) * 4);
  const place = (v, k) => positions[3 * v + k], uv = (v, k) => texcoords[2 * v + k];
  for (let i = 0; i < triangles.length; i += 3) {
    const [a, b, c] = triangles.subarray(i, i + 3), p = uv(b, 0) - uv(a, 0), q = uv(b, 1) - uv(a, 1), r = uv(c, 0) - uv(a, 0), s = uv(c, 1) - uv(a, 1);
    const sign = p * s - r * q < 0 ? -1 : 1;
    for (let k = 0; k < 3; ++k) {
      const along = sign * ((place(b, k) - place(a, k)) * s - (place(c, k) - place(a, k)) * q);
      for (const v of [a, b, c]) sums[3 * v + k] += along;
    }
  }
  const t = new Vector3(), n = new Vector3(), other = new Vector3();
  for (let v = 0; v < positions.length / 3; ++v) {
    t.fromArray(sums, 3 * v);
    n.fromArray(normals, 3 * v);
    const length = t.length();
    t.addScaledVector(n, -n.dot(t));
    // Any direction at right angles to n will do.
    if (!(t.length() > 1e-6 * length)) t.crossVectors(n, Math.abs(n.x) < 0.5 ? other.set(1, 0, 0) : other.set(0, 1, 0));
    t.normalize().toArray(tangents, 4 * v);
    tangents[4 * v + 3] = -1;
  }
  return tangents;
}
