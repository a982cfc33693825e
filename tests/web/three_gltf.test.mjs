// EXT_gim_geometry by three's GLTFLoader.
import assert from "node:assert/strict";
import { test } from "node:test";
import { existsSync, symlinkSync } from "node:fs";
import { join } from "node:path";
import { here, importEntry, packageFolder, vector } from "./setup.mjs";

const modules = join(packageFolder, "node_modules");
if (!existsSync(modules)) symlinkSync(join(here, "node_modules"), modules);

const { GLTFLoader } = await import("three/examples/jsm/loaders/GLTFLoader.js");
const { GimDecoder } = await importEntry("decoder");
const { GIMGLTFExtension } = await importEntry("three");
await GimDecoder.ready;

// A GLB with one node and one mesh, whose primitives have these members.
function glb(file, primitives) {
  const body = Buffer.concat([file, Buffer.alloc((4 - (file.length % 4)) % 4)]);
  const accessor = (type, componentType) => ({ type, componentType, count: 3 });
  const json = {
    asset: { version: "2.0" }, scene: 0, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0, name: "node", translation: [1, 2, 3] }],
    meshes: [{ name: "shape", primitives: primitives.map((more) => ({ indices: 3, ...more })) }],
    materials: [{ name: "red", pbrMetallicRoughness: { baseColorFactor: [1, 0, 0, 1] } }],
    accessors: [accessor("VEC3", 5126), accessor("VEC3", 5126), accessor("VEC2", 5126), accessor("SCALAR", 5125), accessor("VEC4", 5126)],
    bufferViews: [{ buffer: 0, byteOffset: 0, byteLength: file.length }], buffers: [{ byteLength: body.length }],
    extensionsUsed: ["EXT_gim_geometry"], extensionsRequired: ["EXT_gim_geometry"],
  };
  let text = JSON.stringify(json);
  text += " ".repeat((4 - (text.length % 4)) % 4);
  const head = (size, type) => Buffer.concat([Buffer.from(Uint32Array.of(size).buffer), Buffer.from(type, "latin1")]);
  const chunks = Buffer.concat([head(text.length, "JSON"), Buffer.from(text), head(body.length, "BIN\0"), body]);
  const bytes = Buffer.concat([Buffer.from("glTF"), Buffer.from(Uint32Array.of(2, 12 + chunks.length).buffer), chunks]);
  return Uint8Array.from(bytes).buffer;
}
async function load(file, primitives, options) {
  const loader = new GLTFLoader().register((parser) => new GIMGLTFExtension(parser, options));
  return (await loader.parseAsync(glb(file, primitives), "")).scene;
}
const plain = { attributes: { POSITION: 0, NORMAL: 1 }, extensions: { EXT_gim_geometry: { bufferView: 0 } } };
const textured = { attributes: { POSITION: 0, NORMAL: 1, TEXCOORD_0: 2, TANGENT: 4 }, material: 0 };

test("a primitive without textures is the mesh for shading", async () => {
  const file = vector("bounds.gim");
  for (const level of [0, 1, 9]) {
    const scene = await load(file, [plain], { level }), mesh = scene.getObjectByName("node");
    const wanted = GimDecoder.decodeHardMesh(file, { level: Math.min(level, 2) });
    assert.deepEqual(mesh.geometry.attributes.position.array, wanted.positions);
    assert.deepEqual(Array.from(mesh.geometry.index.array), Array.from(wanted.triangles));
    assert.deepEqual(mesh.position.toArray(), [1, 2, 3]);
    assert.equal(mesh.geometry.attributes.uv, undefined);
  }
});

test("a textured primitive is the grid, moved to its place, with tangents", async () => {
  const file = vector("bounds-two-images.gim"), places = [0.5, 0, 0.25, 0, 0.5, 0.5];
  const primitive = { ...textured, extensions: { EXT_gim_geometry: { bufferView: 0, places } } };
  const mesh = (await load(file, [primitive])).getObjectByName("node"), { uv, position, normal, tangent } = mesh.geometry.attributes;
  const grids = [0, 1].map((image) => GimDecoder.decodeGrid(file, { image }));
  const first = grids[0].positions.length / 3;
  assert.equal(position.count, first + grids[1].positions.length / 3);
  assert.deepEqual(position.array.subarray(0, 3 * first), grids[0].positions);
  assert.equal(uv.getX(1), Math.fround(0.5 + 0.25 * grids[0].texcoords[2]));
  assert.equal(uv.getY(first), Math.fround(0.5 + 0.5 * grids[1].texcoords[1]));
  assert.equal(mesh.geometry.index.count, grids[0].triangles.length + grids[1].triangles.length);
  for (let v = 0; v < position.count; ++v) {
    const [n, t] = [normal, tangent].map((attribute) => [attribute.getX(v), attribute.getY(v), attribute.getZ(v)]);
    const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    assert.ok(Math.abs(dot(n, n) - 1) < 1e-5 && Math.abs(dot(t, t) - 1) < 1e-5 && Math.abs(dot(n, t)) < 1e-5);
    assert.equal(tangent.getW(v), -1);
  }
  assert.equal(mesh.material.name, "red");
});

test("positions far from 0 contain the origin", async () => {
  const file = vector("bounds-wide-origin.gim"), mesh = (await load(file, [plain])).getObjectByName("node");
  const { origin } = GimDecoder.info(file), wanted = GimDecoder.decodeHardMesh(file);
  assert.equal(mesh.geometry.attributes.position.getY(5), Math.fround(wanted.positions[16] + origin[1]));
});

test("several primitives are a group", async () => {
  const scene = await load(vector("bounds.gim"), [plain, { ...plain, material: 0 }]), node = scene.getObjectByName("node");
  assert.equal(node.children.length, 2);
  assert.equal(node.children[1].material.name, "red");
});

test("a damaged file is an error", async () => {
  const file = Uint8Array.from(vector("bounds.gim"));
  file[file.length - 3] ^= 1;
  await assert.rejects(load(file, [plain]), { name: "GimError", statusName: "CHECKSUM" });
});
