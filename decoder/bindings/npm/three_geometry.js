// From decoded images to one BufferGeometry.
import { Box3, BufferAttribute, BufferGeometry, Sphere, Vector3 } from "three";
import { GimDecoder } from "gim/decoder";

// How large a mesh may be that is decoded at once instead of in a turn or a worker of its own.
export const smallTriangles = 8192;

// What a file holds at each level, once its seams are here (with any level).
// kind: "hardMesh" or "grid". Returns for each image {coarsest, levels: [{vertices, triangles, end}]}; vertices: at most.
export function survey(bytes, info, kind, limits) {
  const images = [];
  for (let image = 0; image < info.imageCount; ++image) {
    const at = (level) => GimDecoder.levelInfo(bytes, { ...limits, image, level });
    const coarsest = at(0).coarsestLevel;
    const levels = Array.from({ length: coarsest + 1 }, (_, level) => {
      const { width, height, vertexCount, triangleCount, prefixSize } = at(level);
      const isSplit = kind === "grid" || info.layout === "tiles";
      return { vertices: isSplit ? width * height : vertexCount, triangles: triangleCount, end: prefixSize };
    });
    images.push({ image, coarsest, levels });
  }
  return images;
}

// Of an image at a level of the file.
export const levelOf = (image, level) => Math.min(level, image.coarsest);

// Bytes of the arrays of a geometry, at most.
export function geometrySize(images, level) {
  let vertices = 0, triangles = 0;
  for (const image of images) {
    const { vertices: v, triangles: t } = image.levels[levelOf(image, level)];
    vertices += v;
    triangles += t;
  }
  return vertices * 32 + triangles * (vertices > 65535 ? 12 : 6);
}

// Decodes images at a level of the file. options: limits, signal, and whether small ones are decoded at once. Others take
// their turns, so that many meshes do not hold up a frame.
export async function decodeParts(bytes, images, level, kind, { signal, atOnce = true, ...limits }) {
  const decode = async (image) => {
    const own = levelOf(image, level), request = { ...limits, image: image.image, level: own };
    const isSmall = atOnce && image.levels[own].triangles <= smallTriangles;
    const now = kind === "grid" ? GimDecoder.decodeGrid : GimDecoder.decodeHardMesh;
    const mesh = isSmall ? now(bytes, request) : await GimDecoder.decodeAsync(kind, bytes, { ...request, signal });
    return { level: own, image: image.image, ...(kind === "grid" ? withoutHoles(mesh) : mesh) };
  };
  const parts = [];
  let pending = [];
  for (const image of images) {
    pending.push(decode(image));
    if (pending.length < 64) continue;
    parts.push(...(await Promise.all(pending)));
    pending = [];
  }
  parts.push(...(await Promise.all(pending)));
  return parts;
}

// Leaves out samples that are in no triangle: their positions are no numbers.
function withoutHoles(mesh) {
  const { positions, normals, texcoords, triangles } = mesh;
  if (!positions.some(Number.isNaN)) return mesh;
  const placeOf = new Uint32Array(positions.length / 3), kept = [];
  for (let v = 0; v < placeOf.length; ++v) {
    if (Number.isNaN(positions[3 * v])) continue;
    placeOf[v] = kept.length;
    kept.push(v);
  }
  const pick = (array, width) => {
    const picked = new Float32Array(kept.length * width);
    kept.forEach((v, to) => picked.set(array.subarray(v * width, v * width + width), to * width));
    return picked;
  };
  return {
    positions: pick(positions, 3),
    normals: pick(normals, 3),
    texcoords: pick(texcoords, 2),
    triangles: triangles.map((v) => placeOf[v]),
  };
}

function joined(arrays) {
  if (arrays.length === 1) return arrays[0];
  const all = new Float32Array(arrays.reduce((sum, { length }) => sum + length, 0));
  let at = 0;
  for (const array of arrays) {
    all.set(array, at);
    at += array.length;
  }
  return all;
}

// One geometry of all parts, with a group for each image.
export function makeGeometry(parts, info, level) {
  const geometry = new BufferGeometry();
  const attribute = (name, field, width) =>
    geometry.setAttribute(name, new BufferAttribute(joined(parts.map((part) => part[field])), width));
  attribute("position", "positions", 3);
  attribute("normal", "normals", 3);
  attribute("uv", "texcoords", 2);
  const vertexCount = geometry.attributes.position.count;
  const indexCount = parts.reduce((sum, { triangles }) => sum + triangles.length, 0);
  const index = new (vertexCount > 65535 ? Uint32Array : Uint16Array)(indexCount);
  const images = [];
  let vertexStart = 0, indexStart = 0;
  for (const part of parts) {
    const { triangles } = part, first = vertexStart;
    for (let i = 0; i < triangles.length; ++i) index[indexStart + i] = triangles[i] + first;
    images.push({
      image: part.image, level: part.level, vertexStart, vertexCount: part.positions.length / 3,
      indexStart, indexCount: triangles.length,
    });
    if (info.imageCount > 1) geometry.addGroup(indexStart, triangles.length, part.image);
    vertexStart += part.positions.length / 3;
    indexStart += triangles.length;
  }
  geometry.setIndex(new BufferAttribute(index, 1));
  setBounds(geometry, info);
  geometry.userData = {
    level, images, isRelative: info.isRelative, origin: info.isRelative ? [...info.origin] : [0, 0, 0],
    rmsError: info.levelRmsError[level], maxError: info.levelMaxError[level],
  };
  return geometry;
}

export function boxOf(info) {
  return info.hasBoxes ? new Box3(new Vector3(...info.box.low), new Vector3(...info.box.high)) : null;
}

// Those of the file, which hold for all levels; else those of the vertices.
function setBounds(geometry, info) {
  geometry.boundingBox = boxOf(info);
  if (!geometry.boundingBox) {
    geometry.computeBoundingBox();
    geometry.computeBoundingSphere();
  } else {
    geometry.boundingSphere = geometry.boundingBox.getBoundingSphere(new Sphere());
  }
}

export function bytesOfGeometry(geometry) {
  const arrays = [geometry.index, ...Object.values(geometry.attributes)];
  return arrays.reduce((sum, attribute) => sum + (attribute ? attribute.array.byteLength : 0), 0);
}
