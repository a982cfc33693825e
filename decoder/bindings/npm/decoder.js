// The decoder of .gim files: gim/decoder.h for JavaScript. decoder.d.ts describes it.
import { makeCore } from "./core.js";
import { GimError, fail } from "./error.js";
import { Instance } from "./instance.js";
import { Pool } from "./pool.js";
import { makeBytes } from "gim-wasm"; // tools/npm.sh writes it

export { GimError };

const BAD_ARGUMENT = 5;

function bytesOf(input) {
  if (ArrayBuffer.isView(input)) return new Uint8Array(input.buffer, input.byteOffset, input.byteLength);
  if (input instanceof ArrayBuffer) return new Uint8Array(input);
  if (typeof SharedArrayBuffer === "function" && input instanceof SharedArrayBuffer) return new Uint8Array(input);
  return fail(BAD_ARGUMENT, "the file is neither an ArrayBuffer nor a view of one");
}

const instance = new Instance(makeCore, makeBytes);
const pool = new Pool(instance, (bytes, request) => instance.run(bytes, request));
const call = (what) => (bytes, options) => instance.run(bytesOf(bytes), Object.assign({}, options, { what }));

export const GimDecoder = {
  supported: instance.supported,
  ready: instance.ready,
  info: call("info"),
  box: call("box"),
  chunks: call("chunks"),
  chooseLevel: call("chooseLevel"),
  levelInfo: call("levelInfo"),
  planeInfo: call("planeInfo"),
  decodePositions: call("positions"),
  decodeMesh: call("mesh"),
  decodeHardMesh: call("hardMesh"),
  decodeGrid: call("grid"),
  decodePlane: call("plane"),
  labelsInfo: call("labelsInfo"),
  decodeLabels: call("labels"),
  readSeams: call("seams"),
  readText: call("text"),
  useWorkers(count) {
    if (!(count >= 0 && count % 1 === 0)) fail(BAD_ARGUMENT, "the number of workers is no whole number");
    pool.resize(instance.supported ? count : 0);
  },
  decodeAsync(what, bytes, options) {
    const { signal, ...rest } = options || {};
    return new Promise((resolve) => {
      if (!["positions", "mesh", "hardMesh", "grid", "plane"].includes(what)) fail(BAD_ARGUMENT, `cannot decode: ${what}`);
      resolve(pool.submit(bytesOf(bytes), { ...rest, what }, signal));
    });
  },
};
