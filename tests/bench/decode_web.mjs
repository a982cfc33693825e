// Decoding in Node: the npm package against Draco's, in turn, at about the same PSNR.
// node tests/bench/decode_web.mjs GIM_PROGRAM MESH.ply FILE.gim... The PSNR of each file is that of `gim compare`. The rival is
// the mesh after meshoptimizer's simplification with Draco, at the fewest triangles that reach it, and Draco on the whole
// mesh. Wants `npm install draco3d meshoptimizer` in the folder that it is called from, and tools/npm.sh done.
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";

const require = createRequire(join(process.cwd(), "x.js"));
const draco3d = require("draco3d");
const { MeshoptSimplifier } = require("meshoptimizer");
const { GimDecoder } = await import(new URL("../../build/npm/package/decoder.mjs", import.meta.url));
const [gim, original, ...files] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), "gim-bench-"));
const [encoderModule, decoderModule] = await Promise.all([draco3d.createEncoderModule({}), draco3d.createDecoderModule({}), GimDecoder.ready, MeshoptSimplifier.ready]);

// An OBJ or a PLY as positions and triangles, through the program, so that every format is read.
function readMesh(path) {
  const obj = join(folder, "mesh.obj");
  const text = path.endsWith(".obj") ? readFileSync(path, "utf8") : plyAsObj(readFileSync(path), obj);
  const positions = [], triangles = [];
  for (const line of text.split("\n")) {
    const words = line.split(" ");
    if (words[0] === "v") positions.push(...words.slice(1, 4).map(Number));
    if (words[0] === "f") triangles.push(...words.slice(1, 4).map((w) => parseInt(w) - 1));
  }
  return { positions: new Float32Array(positions), triangles: new Uint32Array(triangles) };
}
// Binary little-endian or ASCII PLY of float x, y, z first and triangles.
function plyAsObj(bytes) {
  const end = bytes.indexOf("end_header\n") + 11, header = bytes.subarray(0, end).toString();
  const [, vertices] = /element vertex (\d+)/.exec(header), [, faces] = /element face (\d+)/.exec(header);
  const properties = header.split("element face")[0].match(/property (\w+) \w+/g).map((p) => p.split(" ")[1]);
  const sizes = { float: 4, float32: 4, double: 8, int: 4, uint: 4, uchar: 1, char: 1, uint8: 1, short: 2, ushort: 2 };
  const lines = [];
  if (header.includes("format ascii")) {
    const rows = bytes.subarray(end).toString().split("\n");
    for (let i = 0; i < vertices; ++i) lines.push("v " + rows[i].trim().split(/\s+/).slice(0, 3).join(" "));
    for (let i = 0; i < faces; ++i) lines.push("f " + rows[Number(vertices) + i].trim().split(/\s+/).slice(1, 4).map((n) => Number(n) + 1).join(" "));
  } else {
    const stride = properties.reduce((sum, type) => sum + sizes[type], 0);
    for (let i = 0, at = end; i < vertices; ++i, at += stride) lines.push(`v ${[0, 4, 8].map((o) => bytes.readFloatLE(at + o)).join(" ")}`);
    for (let i = 0, at = end + vertices * stride; i < faces; ++i, at += 13) lines.push(`f ${[1, 5, 9].map((o) => bytes.readInt32LE(at + o) + 1).join(" ")}`);
  }
  return lines.join("\n");
}
function psnr(path) {
  return Number(/PSNR\D*([\d.]+)/.exec(execFileSync(gim, ["compare", original, path], { encoding: "utf8" }))[1]);
}
function writeObj({ positions, triangles }) {
  const path = join(folder, "decoded.obj"), lines = [];
  for (let i = 0; i < positions.length; i += 3) lines.push(`v ${positions[i]} ${positions[i + 1]} ${positions[i + 2]}`);
  for (let i = 0; i < triangles.length; i += 3) lines.push(`f ${triangles[i] + 1} ${triangles[i + 1] + 1} ${triangles[i + 2] + 1}`);
  writeFileSync(path, lines.join("\n"));
  return path;
}

function dracoEncode({ positions, triangles }, bits) {
  const encoder = new encoderModule.Encoder(), builder = new encoderModule.MeshBuilder(), mesh = new encoderModule.Mesh();
  builder.AddFacesToMesh(mesh, triangles.length / 3, triangles);
  builder.AddFloatAttributeToMesh(mesh, encoderModule.POSITION, positions.length / 3, 3, positions);
  encoder.SetSpeedOptions(0, 0);
  encoder.SetAttributeQuantization(encoderModule.POSITION, bits);
  const array = new encoderModule.DracoInt8Array(), size = encoder.EncodeMeshToDracoBuffer(mesh, array);
  const bytes = Int8Array.from({ length: size }, (_, i) => array.GetValue(i));
  for (const object of [array, mesh, builder, encoder]) encoderModule.destroy(object);
  return bytes;
}
function dracoDecode(bytes) {
  const m = decoderModule, decoder = new m.Decoder(), mesh = new m.Mesh();
  decoder.DecodeArrayToMesh(bytes, bytes.length, mesh);
  const heap = (size, type, call) => {
    const at = m._malloc(size);
    call(at);
    const made = new type(m.HEAPU8.buffer, at, size / 4).slice();
    m._free(at);
    return made;
  };
  const attribute = decoder.GetAttributeByUniqueId(mesh, 0);
  const triangles = heap(mesh.num_faces() * 12, Uint32Array, (at) => decoder.GetTrianglesUInt32Array(mesh, mesh.num_faces() * 12, at));
  const positions = heap(mesh.num_points() * 12, Float32Array, (at) => decoder.GetAttributeDataArrayForAllPoints(mesh, attribute, m.DT_FLOAT32, mesh.num_points() * 12, at));
  m.destroy(mesh);
  m.destroy(decoder);
  return { positions, triangles };
}

// The smallest simplified mesh that reaches a PSNR.
function simplify(mesh, wanted, bits) {
  let best = mesh;
  for (let low = 0, high = mesh.triangles.length / 3, i = 0; i < 9; ++i) {
    const count = Math.round(Math.sqrt(Math.max(low, 200) * high));
    const [triangles] = MeshoptSimplifier.simplify(mesh.triangles, mesh.positions, 3, 3 * count, 1);
    const made = compact({ positions: mesh.positions, triangles });
    if (psnr(writeObj(dracoDecode(dracoEncode(made, bits)))) >= wanted) [best, high] = [made, count];
    else low = count;
  }
  return best;
}
function compact({ positions, triangles }) {
  const number = new Map(), kept = [];
  const numbered = triangles.map((v) => {
    if (!number.has(v)) number.set(v, kept.push(v) - 1);
    return number.get(v);
  });
  return { positions: Float32Array.from(kept.flatMap((v) => [...positions.subarray(3 * v, 3 * v + 3)])), triangles: numbered };
}

// Medians in milliseconds of calls in turn.
function times(calls, rounds = 40) {
  const all = calls.map(() => []);
  for (let i = 0; i < rounds + 10; ++i)
    calls.forEach((call, k) => {
      const begin = performance.now();
      call();
      if (i >= 10) all[k].push(performance.now() - begin);
    });
  return all.map((t) => t.sort((a, b) => a - b)[rounds >> 1].toFixed(2));
}

const mesh = readMesh(original);
for (const file of files) {
  const bytes = readFileSync(file), wanted = psnr(file), options = { normals: false, texcoords: false };
  const simplified = simplify(mesh, wanted, 12), small = dracoEncode(simplified, 12), whole = dracoEncode(mesh, 11);
  const [ours, theirs, full] = times([() => GimDecoder.decodeMesh(bytes, options), () => dracoDecode(small), () => dracoDecode(whole)]);
  const count = GimDecoder.levelInfo(bytes).triangleCount;
  console.log(`${file}: ${wanted} dB, ${bytes.length} bytes, ${count} triangles, ${ours} ms`);
  console.log(`  simplified, Draco: ${small.length} bytes, ${simplified.triangles.length / 3} triangles, ${theirs} ms`);
  console.log(`  Draco, whole mesh: ${whole.length} bytes, ${mesh.triangles.length / 3} triangles, ${full} ms`);
}
rmSync(folder, { recursive: true });
