// The calls of gim/decoder.h on the memory of one WebAssembly instance. A worker gets this function as text, so it uses
// nothing from outside and no syntax that a compiler for old browsers would replace by helpers.

// wasm: the exports of an instance. fail(status, text) throws. Returns run(bytes, request) and memorySize().
export function makeCore(wasm, fail) {
  const MALFORMED = 3, LIMIT_EXCEEDED = 4, BAD_ARGUMENT = 5, UNSUPPORTED = 2;
  const infoAt = 512; // of gim_info in a session (decoder/bindings/wasm/calls.cpp)
  const layouts = ["gim", "mcgim", "tiles"];
  const kinds = ["normals", "colors", "displacements"];
  const base = (wasm.__heap_base.value + 63) & ~63;
  let end, most; // of the memory that a call has taken so far; what it may take

  // Takes memory that is the call's until it ends.
  function take(size) {
    const at = end;
    end += Math.ceil(size / 64) * 64;
    const missing = end - wasm.memory.buffer.byteLength;
    if (end - base > most) fail(LIMIT_EXCEEDED, "decoding needs more than maxMemory");
    if (missing > 0) {
      try {
        wasm.memory.grow(Math.ceil(missing / 65536));
      } catch (error) {
        fail(LIMIT_EXCEEDED, "the browser has no memory of that size");
      }
    }
    return at;
  }
  function check(status) {
    if (status === 0) return;
    const text = new Uint8Array(wasm.memory.buffer, wasm.gim_status_text(status));
    let message = "";
    for (let i = 0; text[i]; ++i) message += String.fromCharCode(text[i]);
    fail(status, message);
  }
  const whole = (value, name, otherwise, largest) => {
    if (value === undefined) return otherwise;
    if (!(value >= 0 && value <= largest && value % 1 === 0)) fail(BAD_ARGUMENT, name + " is no whole number in range");
    return value;
  };

  // What all requests begin with: the file's bytes and its header.
  function open(bytes, request) {
    const limit = (name, otherwise, largest) => whole(request[name], name, otherwise, largest);
    end = base;
    most = limit("maxMemory", 0x40000000, 0xffff0000);
    const session = take(wasm.gim_js_session_size());
    const file = { session, at: take(bytes.length), size: bytes.length };
    new Uint8Array(wasm.memory.buffer, file.at, file.size).set(bytes);
    file.image = limit("image", 0, 0xffffffff);
    file.level = limit("level", 0, 0xffffffff);
    check(
      wasm.gim_js_info(session, file.at, file.size, limit("maxSamples", 0x4000000, Number.MAX_SAFE_INTEGER),
        limit("maxImages", 65536, 0xffffffff), limit("maxSide", 16385, 0xffffffff)),
    );
    return file;
  }
  // The first numbers of the session, by the names of their fields.
  function record(file, names) {
    const numbers = new Float64Array(wasm.memory.buffer, file.session, names.length), fields = {};
    names.forEach((name, i) => (fields[name] = numbers[i]));
    return fields;
  }

  function info(file) {
    const numbers = new Float64Array(wasm.memory.buffer, file.session, 64);
    const fields = record(file, ["version", "layout", "coding", "bits", "imageCount", "levelCount", "sampleCount",
      "fileSize", "isRelative", "step", "quantizer", "indexSize"]);
    fields.layout = layouts[fields.layout];
    fields.coding = fields.coding ? "lossy" : "lossless";
    fields.isRelative = fields.isRelative === 1;
    fields.origin = Array.from(numbers.slice(12, 15));
    const errors = (at) => Array.from(numbers.slice(at, at + fields.levelCount));
    fields.levelRmsError = errors(15);
    fields.levelMaxError = errors(29);
    fields.hasBoxes = numbers[43] === 1;
    fields.box = boxAt(numbers, 44);
    return fields;
  }
  const boxAt = (numbers, at) => ({
    low: Array.from(numbers.slice(at, at + 3)),
    high: Array.from(numbers.slice(at + 3, at + 6)),
  });
  function box(file) {
    check(wasm.gim_js_box(file.session, file.at, file.size, file.image));
    return boxAt(new Float64Array(wasm.memory.buffer, file.session, 64), 0);
  }
  function chunks(file) {
    const numbers = new Float64Array(wasm.memory.buffer, file.session, 64);
    const count = numbers[50], indexSize = numbers[11], found = [];
    for (let i = 0; i < count; ++i) {
      check(wasm.gim_js_chunk(file.session, file.at, indexSize, i));
      const chunk = record(file, ["name", "level", "offset", "size"]);
      chunk.name = ["SEAM", "LEVL", "META", "NRML", "COLR", "DISP", "LABL"][chunk.name] || "????";
      found.push(chunk);
    }
    return found;
  }
  function chooseLevel(file, request) {
    const { distance, verticalFov, viewportHeight, pixelError, shown } = request;
    const last = 0x7fffffff; // GIM_NO_LEVEL
    return wasm.gim_js_choose(file.session, distance, verticalFov, viewportHeight, pixelError,
      whole(shown, "shown", last, last));
  }
  function levelInfo(file) {
    check(wasm.gim_js_level(file.session, file.at, file.size, file.image, file.level));
    return record(file, ["side", "width", "height", "coarsestLevel", "vertexCount", "triangleCount", "prefixSize",
      "scratchSize"]);
  }
  function planeInfo(file, request) {
    file.kind = kinds.indexOf(request.plane);
    if (file.kind < 0) fail(BAD_ARGUMENT, "plane is none of: " + kinds.join(", "));
    check(wasm.gim_js_plane(file.session, file.at, file.size, file.image, file.kind, file.level));
    return record(file, ["width", "height", "coarsestLevel", "quantizer", "streamSize", "prefixSize", "scratchSize"]);
  }

  // Arrays that the decoder fills: add() takes memory for one and returns where, copy() makes an array of the caller's.
  const floats = (at, count) => new Float32Array(wasm.memory.buffer, at, count).slice();
  const numbers = (at, count) => new Uint32Array(wasm.memory.buffer, at, count).slice();

  // What to decode: "mesh", "hardMesh" or "grid". Normals, texcoords and triangles unless a request says no.
  function surface(file, request, what) {
    const level = levelInfo(file), isMesh = what === "mesh";
    const samples = level.width * level.height;
    const room = isMesh ? level.vertexCount : samples;
    const wants = (name) => request[name] !== false;
    const positions = take(room * 12);
    const normals = wants("normals") ? take(room * 12) : 0;
    const texcoords = wants("texcoords") ? take(room * 8) : 0;
    const triangles = wants("triangles") ? take(level.triangleCount * 12) : 0;
    const counted = take(4), scratch = take(level.scratchSize);
    const begin = [file.session + infoAt, file.at, file.size, file.image, file.level];
    const rest = [positions, normals, texcoords, triangles, scratch, level.scratchSize];
    const decode = { mesh: wasm.gim_decode_mesh, hardMesh: wasm.gim_decode_hard_mesh, grid: wasm.gim_decode_grid }[what];
    check(decode.apply(null, begin.concat(what === "hardMesh" ? [counted] : [], rest)));
    const count = what === "hardMesh" ? numbers(counted, 1)[0] : room;
    const made = { positions: floats(positions, count * 3) };
    if (what === "grid") {
      made.width = level.width;
      made.height = level.height;
    }
    if (normals) made.normals = floats(normals, count * 3);
    if (texcoords) made.texcoords = floats(texcoords, count * 2);
    if (triangles) made.triangles = numbers(triangles, level.triangleCount * 3);
    return made;
  }
  function plane(file, request) {
    const level = planeInfo(file, request);
    const values = take(level.width * level.height * 12), scratch = take(level.scratchSize);
    check(
      wasm.gim_decode_plane(file.session + infoAt, file.at, file.size, file.image, file.kind, file.level, values,
        scratch, level.scratchSize),
    );
    return { width: level.width, height: level.height, values: floats(values, level.width * level.height * 3) };
  }
  function labelsInfo(file) {
    check(wasm.gim_js_labels(file.session, file.at, file.size, file.image, file.level));
    return record(file, ["cellCount", "prefixSize", "scratchSize"]);
  }
  function labels(file) {
    const { cellCount, scratchSize } = labelsInfo(file), values = take(cellCount), scratch = take(scratchSize);
    check(
      wasm.gim_decode_labels(file.session + infoAt, file.at, file.size, file.image, file.level, values, scratch,
        scratchSize),
    );
    return new Uint8Array(wasm.memory.buffer, values, cellCount).slice();
  }
  function seams(file) {
    const { side } = levelInfo(file);
    const ring = side ? 4 * (side - 1) : 0, classOf = ring ? take(ring * 4) : 0, paths = take(4);
    check(wasm.gim_read_seams(file.session + infoAt, file.at, file.size, file.image, file.level, classOf, paths));
    return { classOf: ring ? numbers(classOf, ring) : null, pathCount: numbers(paths, 1)[0] };
  }
  function text(file) {
    const read = (to, room) =>
      wasm.gim_read_text(file.session + infoAt, file.at, file.size, to, room, file.session, 0, 0);
    check(read(0, 0));
    const size = numbers(file.session, 2);
    if (size[1]) fail(MALFORMED, "no text is that long");
    const to = take(size[0] + 1);
    const status = read(to, size[0]);
    if (status === UNSUPPORTED) fail(status, "the text is compressed, and this build has no zstd");
    check(status);
    return new TextDecoder().decode(new Uint8Array(wasm.memory.buffer, to, size[0]).slice());
  }

  const requests = {
    info, box, chunks, chooseLevel, levelInfo, planeInfo, plane, labelsInfo, labels, seams, text,
    mesh: (file, request) => surface(file, request, "mesh"),
    hardMesh: (file, request) => surface(file, request, "hardMesh"),
    grid: (file, request) => surface(file, request, "grid"),
    positions: (file) => surface(file, { normals: false, texcoords: false, triangles: false }, "grid"),
  };
  return {
    run: (bytes, request) => requests[request.what](open(bytes, request), request),
    memorySize: () => wasm.memory.buffer.byteLength,
  };
}
