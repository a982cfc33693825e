// EXT_gim_geometry for GLTFLoader: meshes whose geometry is a .gim file in a buffer view.
import { BufferAttribute, BufferGeometry, Group, Mesh, MeshStandardMaterial, Vector3 } from "three";
import { GimDecoder } from "gim/decoder";

const name = "EXT_gim_geometry";

export class GIMGLTFExtension {
  // parser: of GLTFLoader. options: {level, limits}.
  constructor(parser, { level = 0, limits = {} } = {}) {
    this.parser = parser;
    this.name = name;
    this.level = level;
    this.limits = limits;
  }

  // Null: a mesh without the extension, which GLTFLoader loads.
  loadMesh(index) {
    const mesh = this.parser.json.meshes[index];
    return mesh.primitives.some((primitive) => primitive.extensions?.[name]) ? this.makeMesh(index, mesh) : null;
  }
  async makeMesh(index, definition) {
    const { parser } = this;
    await GimDecoder.ready;
    const parts = await Promise.all(definition.primitives.map((primitive) => this.makePart(primitive)));
    const title = parser.createUniqueName(definition.name || `mesh_${index}`);
    parts.forEach((part, i) => {
      part.name = title;
      Object.assign(part.userData, definition.extras);
      parser.assignFinalMaterial(part);
      parser.associations.set(part, { meshes: index, primitives: i });
    });
    if (parts.length === 1) return parts[0];
    const group = new Group().add(...parts);
    group.name = title;
    parser.associations.set(group, { meshes: index });
    return group;
  }
  async makePart(primitive) {
    const { parser } = this;
    const material = primitive.material === undefined ? new MeshStandardMaterial() : await parser.getDependency("material", primitive.material);
    const extension = primitive.extensions?.[name];
    if (!extension) return new Mesh((await parser.loadGeometries([primitive]))[0], material);
    const bytes = new Uint8Array(await parser.getDependency("bufferView", extension.bufferView));
    const geometry = geometryOf(bytes, primitive.attributes, extension, this.level, this.limits);
    return new Mesh(geometry, material);
  }
}

// The arrays of a level, as the extension's text numbers the steps.
function geometryOf(bytes, attributes, { label, places }, level, limits) {
  const info = GimDecoder.info(bytes, limits), parts = [];
  const isTextured = attributes.TEXCOORD_0 !== undefined;
  for (let image = 0; image < info.imageCount; ++image) {
    const { coarsestLevel } = GimDecoder.levelInfo(bytes, { ...limits, image });
    const options = { ...limits, image, level: Math.min(level, coarsestLevel) };
    const part = isTextured ? texturedPart(bytes, options) : GimDecoder.decodeHardMesh(bytes, options);
    finishPart(part, info, places?.slice(3 * image, 3 * image + 3));
    if (attributes.TANGENT !== undefined) part.tangents = tangentsOf(part);
    parts.push(choose(part, label === undefined ? null : labelled(bytes, options, label)));
  }
  const geometry = new BufferGeometry(), widths = { positions: 3, normals: 3 };
  if (isTextured) widths.texcoords = 2;
  if (attributes.TANGENT !== undefined) widths.tangents = 4;
  const names = { positions: "position", normals: "normal", texcoords: "uv", tangents: "tangent" };
  for (const [field, width] of Object.entries(widths))
    geometry.setAttribute(names[field], new BufferAttribute(Float32Array.from(parts.flatMap((part) => Array.from(part[field]))), width));
  let first = 0;
  const triangles = parts.flatMap((part) => {
    const moved = Array.from(part.triangles, (v) => v + first);
    first += part.positions.length / 3;
    return moved;
  });
  geometry.setIndex(new BufferAttribute(new (first > 65535 ? Uint32Array : Uint16Array)(triangles), 1));
  return geometry;
}

// Samples as vertices, with the normals that the mesh for shading has at the same corners.
function texturedPart(bytes, options) {
  const grid = GimDecoder.decodeGrid(bytes, options), hard = GimDecoder.decodeHardMesh(bytes, options);
  grid.triangles.forEach((v, i) => grid.normals.set(hard.normals.subarray(3 * hard.triangles[i], 3 * hard.triangles[i] + 3), 3 * v));
  return grid;
}

function finishPart({ positions, normals, texcoords }, info, place) {
  if (info.isRelative) for (let i = 0; i < positions.length; ++i) positions[i] += info.origin[i % 3];
  for (let i = 0; i < normals.length; i += 3) if (!normals[i] && !normals[i + 1] && !normals[i + 2]) normals[i + 2] = 1;
  if (place) for (let i = 0; i < texcoords.length; ++i) texcoords[i] = place[i % 2] + place[2] * texcoords[i];
}

// Which triangles stay: pairs of them share a label.
function labelled(bytes, options, label) {
  if (!GimDecoder.decodeLabels) throw new Error("this decoder does not read the labels that a primitive asks for");
  let labels;
  try {
    labels = GimDecoder.decodeLabels(bytes, options);
  } catch (error) {
    if (error.statusName !== "NO_SUCH_PLANE") throw error;
    return () => label === 0; // the file has none
  }
  return (triangle) => labels[triangle >> 1] === label;
}
// The part with the triangles that stay (null: all) and the vertices that they use.
function choose(part, stays) {
  const kept = [], isUsed = new Uint8Array(part.positions.length / 3);
  for (let i = 0; i < part.triangles.length; ++i) {
    if (stays && !stays(Math.floor(i / 3))) continue;
    kept.push(part.triangles[i]);
    isUsed[part.triangles[i]] = 1;
  }
  const vertices = [], numbers = new Uint32Array(isUsed.length);
  isUsed.forEach((used, v) => used && (numbers[v] = vertices.push(v) - 1));
  const pick = (array, width) => Float32Array.from({ length: vertices.length * width }, (_, i) => array[vertices[Math.floor(i / width)] * width + (i % width)]);
  const chosen = { positions: pick(part.positions, 3), normals: pick(part.normals, 3), texcoords: pick(part.texcoords, 2), triangles: kept.map((v) => numbers[v]) };
  if (part.tangents) chosen.tangents = pick(part.tangents, 4);
  return chosen;
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
