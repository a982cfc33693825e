// Everything that a file has, decoded: for comparisons with the vectors and with the native decoder. Works in Node and in
// a browser.

const planes = ["normals", "colors", "displacements"];
export const smallLimits = { maxSamples: 65536, maxImages: 16, maxSide: 2049 }; // as in write_damaged.cpp

// Calls visit(result) or visit of a GimError for every call, in the order of write_damaged.cpp.
function walk(decoder, bytes, limits, visit) {
  const tried = (what, options) => {
    try {
      const made = decoder[what](bytes, { ...limits, ...options });
      visit(what, made);
      return made;
    } catch (error) {
      if (typeof error.status !== "number") throw error;
      visit(what, error);
      return null;
    }
  };
  const info = tried("info");
  if (!info) return;
  const levels = (describe, options, decode) => {
    for (let level = 0, coarsest = 0; level <= coarsest; ++level) {
      const found = tried(describe, { ...options, level });
      if (!found) return;
      coarsest = found.coarsestLevel;
      for (const what of decode) tried(what, { ...options, level });
    }
  };
  for (let image = 0; image < info.imageCount; ++image)
    levels("levelInfo", { image }, ["decodeGrid", "decodeMesh", "decodeHardMesh"]);
  for (const plane of planes)
    for (let image = 0; image < info.imageCount; ++image) levels("planeInfo", { image, plane }, ["decodePlane"]);
}

// The same for labels, which write_damaged.cpp leaves out.
function walkLabels(decoder, bytes, visit) {
  for (let image = 0; image < decoder.info(bytes).imageCount; ++image) {
    const { coarsestLevel } = decoder.levelInfo(bytes, { image });
    for (let level = 0; level <= coarsestLevel; ++level) {
      try {
        visit(decoder.decodeLabels(bytes, { image, level }));
      } catch (error) {
        if (typeof error.status !== "number") throw error;
        return visit(error);
      }
    }
  }
}

const isNaNWord = (word) => (word & 0x7fffffff) > 0x7f800000;

// The hash of write_damaged.cpp.
export function hashOf(decoder, bytes) {
  let hash = 2166136261;
  const add = (word) => (hash = Math.imul(hash ^ word, 16777619));
  const addArray = (array) => {
    const words = new Uint32Array(array.buffer, array.byteOffset, array.length);
    const isFloat = array instanceof Float32Array;
    for (const word of words) add(isFloat && isNaNWord(word) ? 0x7fc00000 : word);
  };
  walk(decoder, bytes, smallLimits, (what, made) => {
    if (made instanceof Error) return add(made.status);
    add(0);
    if (what === "levelInfo")
      [made.width, made.height, made.vertexCount, made.triangleCount].forEach(add);
    for (const name of ["positions", "normals", "texcoords", "triangles", "values"])
      if (made[name]) addArray(made[name]);
  });
  return hash >>> 0;
}

// What spec/vectors/README.md says of a file: { status, f32, tri, vtx, pln, lbl }, arrays of typed arrays.
export function vectorsOf(decoder, bytes) {
  const found = { status: "OK", f32: [], tri: [], vtx: [], pln: [], lbl: [] };
  walk(decoder, bytes, {}, (what, made) => {
    if (found.status !== "OK") return;
    if (made instanceof Error) {
      if (made.statusName !== "NO_SUCH_PLANE") found.status = made.statusName;
    } else if (what === "decodeGrid") {
      found.f32.push(made.positions);
    } else if (what === "decodeMesh") {
      found.tri.push(made.triangles);
      found.vtx.push(made.normals, made.texcoords);
    } else if (what === "decodePlane") {
      found.pln.push(made.values);
    }
  });
  if (found.status !== "OK") return found;
  walkLabels(decoder, bytes, (made) => {
    if (!(made instanceof Error)) found.lbl.push(made);
    else if (made.statusName !== "NO_SUCH_PLANE") found.status = made.statusName;
  });
  return found;
}

// Compares arrays with the bytes of a vector, an ArrayBuffer. Returns what differs, or "".
export function differsFrom(arrays, expected) {
  const isBytes = arrays[0] instanceof Uint8Array;
  const wanted = isBytes ? new Uint8Array(expected) : new Uint32Array(expected);
  const length = arrays.reduce((sum, array) => sum + array.length, 0);
  if (length !== wanted.length) return `${length} numbers instead of ${wanted.length}`;
  let at = 0;
  for (const array of arrays) {
    const words = isBytes ? array : new Uint32Array(array.buffer, array.byteOffset, array.length);
    for (const word of words) {
      const other = wanted[at++];
      if (word !== other && !(array instanceof Float32Array && isNaNWord(word) && isNaNWord(other)))
        return `number ${at - 1} is ${word.toString(16)} instead of ${other.toString(16)}`;
    }
  }
  return "";
}

// Runs all vectors and all damaged files. read(path) returns an ArrayBuffer; names: { valid: [...], invalid: [...] } of
// spec/vectors without extensions, valid ones with the extensions that are there. Returns complaints, and how many there
// were to check.
export async function checkAll(decoder, names, read) {
  const complaints = [];
  let checked = 0;
  for (const { name, extensions } of names.valid) {
    const found = vectorsOf(decoder, await read(`vectors/valid/${name}.gim`));
    if (found.status !== "OK") complaints.push(`${name}: ${found.status}`);
    for (const extension of extensions) {
      const difference = differsFrom(found[extension], await read(`vectors/valid/${name}.${extension}`));
      if (difference) complaints.push(`${name}.${extension}: ${difference}`);
      ++checked;
    }
  }
  for (const name of names.invalid) {
    const { status } = vectorsOf(decoder, await read(`vectors/invalid/${name}.gim`));
    const wanted = name.split(".")[0].replace(/-/g, "_").toUpperCase();
    if (status !== wanted) complaints.push(`${name}: ${status}`);
    ++checked;
  }
  const damaged = await read("damaged/damaged.bin");
  const lines = new TextDecoder().decode(await read("damaged/damaged.txt")).trim().split("\n");
  let at = 0;
  lines.forEach((line, i) => {
    const [name, size, hash] = line.split(" ");
    const bytes = new Uint8Array(damaged, at, Number(size));
    at += Number(size);
    const found = hashOf(decoder, bytes);
    if (found !== Number(hash)) complaints.push(`${name}, copy ${i % 60}: the hash is ${found} instead of ${hash}`);
    ++checked;
  });
  return { complaints: complaints.slice(0, 20), checked };
}
