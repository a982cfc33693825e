// A GLB with a scene, to be encoded by the program: a ball of two materials, a ball that two nodes show, a tetrahedron that is
// too small to become a .gim, and an animation.
import { deflateSync } from "node:zlib";
import { crc32 } from "./checksums.mjs";

// A ball with waves. Returns {positions, normals, texcoords, triangles}.
function wavyBall(rings, sides, seed) {
  const positions = [], normals = [], texcoords = [], triangles = [];
  const radius = (a, b) => 1 + 0.12 * Math.sin((2 + (seed % 3)) * a + seed) * Math.sin(b) ** 2 + 0.08 * Math.cos((3 + (seed % 4)) * b + 0.7 * seed);
  for (let i = 0; i <= rings; ++i) {
    for (let j = 0; j <= sides; ++j) {
      const a = (2 * Math.PI * (j % sides)) / sides, b = (Math.PI * i) / rings, r = radius(a, b);
      const n = i === 0 ? [0, 1, 0] : i === rings ? [0, -1, 0] : [Math.sin(b) * Math.cos(a), Math.cos(b), -Math.sin(b) * Math.sin(a)];
      positions.push(...n.map((x) => r * x));
      normals.push(...n);
      texcoords.push(j / sides, i / rings);
    }
  }
  const at = (i, j) => i * (sides + 1) + j;
  for (let i = 0; i < rings; ++i) {
    for (let j = 0; j < sides; ++j) {
      if (i > 0) triangles.push(at(i, j), at(i + 1, j), at(i, j + 1));
      if (i < rings - 1) triangles.push(at(i, j + 1), at(i + 1, j), at(i + 1, j + 1));
    }
  }
  return { positions, normals, texcoords, triangles };
}

// A PNG of side x side pixels. colour(x, y) returns [red, green, blue].
function png(side, colour) {
  const rows = Buffer.alloc(side * (3 * side + 1));
  for (let y = 0; y < side; ++y) for (let x = 0; x < side; ++x) rows.set(colour(x, y), y * (3 * side + 1) + 1 + 3 * x);
  const chunk = (type, data) => {
    const body = Buffer.concat([Buffer.from(type, "latin1"), data]), ends = Buffer.alloc(8);
    ends.writeUInt32BE(data.length, 0);
    ends.writeUInt32BE(crc32(body), 4);
    return Buffer.concat([ends.subarray(0, 4), body, ends.subarray(4)]);
  };
  const head = Buffer.alloc(13);
  head.writeUInt32BE(side, 0);
  head.writeUInt32BE(side, 4);
  head.set([8, 2], 8);
  return Buffer.concat([Buffer.from("\x89PNG\r\n\x1a\n", "latin1"), chunk("IHDR", head), chunk("IDAT", deflateSync(rows)), chunk("IEND", Buffer.alloc(0))]);
}

export function glbOf(json, body) {
  const padded = (bytes, fill) => Buffer.concat([bytes, Buffer.alloc((4 - (bytes.length % 4)) % 4, fill)]);
  const chunk = (type, bytes) => Buffer.concat([Buffer.from(Uint32Array.of(bytes.length).buffer), Buffer.from(type, "latin1"), bytes]);
  const chunks = Buffer.concat([chunk("JSON", padded(Buffer.from(JSON.stringify(json)), " ")), chunk("BIN\0", padded(body, 0))]);
  return Buffer.concat([Buffer.from("glTF"), Buffer.from(Uint32Array.of(2, 12 + chunks.length).buffer), chunks]);
}

class Builder {
  constructor() {
    this.json = { asset: { version: "2.0" }, accessors: [], bufferViews: [], meshes: [], materials: [], buffers: [] };
    this.parts = [];
    this.size = 0;
  }
  view(bytes) {
    const padding = Buffer.alloc((4 - (this.size % 4)) % 4);
    this.parts.push(padding, bytes);
    this.json.bufferViews.push({ buffer: 0, byteOffset: this.size + padding.length, byteLength: bytes.length });
    this.size += padding.length + bytes.length;
    return this.json.bufferViews.length - 1;
  }
  accessor(values, type, width, more = {}) {
    const array = type === "SCALAR" && !more.isFloat ? Uint32Array.from(values) : Float32Array.from(values);
    const { isFloat, ...rest } = more;
    this.json.accessors.push({
      bufferView: this.view(Buffer.from(array.buffer)), componentType: array instanceof Uint32Array ? 5125 : 5126, type,
      count: values.length / width, ...rest,
    });
    return this.json.accessors.length - 1;
  }
  bounds(positions) {
    const of = (f) => [0, 1, 2].map((k) => positions.filter((_, i) => i % 3 === k).map(Math.fround).reduce((a, b) => f(a, b)));
    return { min: of(Math.min), max: of(Math.max) };
  }
  // parts: [{triangles, material}].
  mesh(name, { positions, normals, texcoords }, parts) {
    const attributes = { POSITION: this.accessor(positions, "VEC3", 3, this.bounds(positions)), NORMAL: this.accessor(normals, "VEC3", 3) };
    if (texcoords) attributes.TEXCOORD_0 = this.accessor(texcoords, "VEC2", 2);
    this.json.meshes.push({ name, primitives: parts.map(({ triangles, material }) => ({ attributes, indices: this.accessor(triangles, "SCALAR", 1), material })) });
  }
  bytes() {
    const body = Buffer.concat(this.parts);
    this.json.buffers.push({ byteLength: body.length });
    return glbOf(this.json, body);
  }
}

// isTextured: the second ball has a picture.
export function sceneGlb(isTextured) {
  const built = new Builder(), { json } = built;
  json.materials.push(
    { name: "red", pbrMetallicRoughness: { baseColorFactor: [0.8, 0.1, 0.1, 1], metallicFactor: 0 } },
    { name: "blue", pbrMetallicRoughness: { baseColorFactor: [0.1, 0.2, 0.8, 1], metallicFactor: 0 } },
    { name: "checks", pbrMetallicRoughness: { metallicFactor: 0, roughnessFactor: 0.7 } },
  );
  if (isTextured) {
    const checks = png(256, (x, y) => ((x >> 4) + (y >> 4)) % 2 ? [230, 210, 90] : [(x * 3) & 255, 60, (y * 5) & 255]);
    json.images = [{ bufferView: built.view(checks), mimeType: "image/png" }];
    json.textures = [{ source: 0 }];
    json.materials[2].pbrMetallicRoughness.baseColorTexture = { index: 0 };
  }
  const first = wavyBall(24, 48, 1), half = first.triangles.length / 2;
  built.mesh("two materials", { ...first, texcoords: null }, [
    { triangles: first.triangles.slice(0, half), material: 0 }, { triangles: first.triangles.slice(half), material: 1 },
  ]);
  const second = wavyBall(24, 48, 2);
  built.mesh("shared", { ...second, texcoords: isTextured ? second.texcoords : null }, [{ triangles: second.triangles, material: 2 }]);
  const corners = [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1];
  built.mesh("small", { positions: corners, normals: corners.map((_, i) => (i % 3 === 0 ? 1 : 0)) }, [{ triangles: [0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3], material: 1 }]);
  json.nodes = [
    { name: "left", mesh: 0, translation: [-2.6, 0, 0] }, { name: "middle", mesh: 1 },
    { name: "right", mesh: 1, translation: [2.2, 0, 0], scale: [0.5, 0.5, 0.5] }, { name: "corner", mesh: 2, translation: [0, -2, 0] },
  ];
  json.scenes = [{ nodes: [0, 1, 2, 3] }];
  json.scene = 0;
  const times = built.accessor([0, 1], "SCALAR", 1, { isFloat: true, min: [0], max: [1] });
  const turns = built.accessor([0, 0, 0, 1, 0, 1, 0, 0], "VEC4", 4);
  json.animations = [{ name: "turn", samplers: [{ input: times, output: turns }], channels: [{ sampler: 0, target: { node: 0, path: "rotation" } }] }];
  return built.bytes();
}
