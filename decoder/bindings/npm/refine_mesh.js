// A refined mesh: gim_refined of gim/refine.h.
import { BAD_ARGUMENT, Handle, SCRATCH_TOO_SMALL, fail, whole } from "./refine_heap.js";

const nothing = 0xffffffff; // GIM_NOTHING
const orNull = (number) => (number === nothing ? null : number);

// A number of a rule, as `name`; none is 0.
function numberOf(value, name) {
  if (value === undefined) return 0;
  if (!Number.isFinite(value)) fail(BAD_ARGUMENT, `${name} is no number`);
  return value;
}
// `count` of them, from an array or what can be taken for one.
function numbersOf(values, count, name) {
  if (values === undefined) return new Array(count).fill(0);
  if (values === null || values.length !== count) fail(BAD_ARGUMENT, `${name} does not have ${count} numbers`);
  return Array.from(values, (value) => numberOf(value, name));
}
function pixelsPerUnit({ verticalFov, viewportHeight }) {
  if (verticalFov === undefined && viewportHeight === undefined) return 0;
  if (!(verticalFov > 0 && verticalFov < Math.PI)) fail(BAD_ARGUMENT, "verticalFov is not between 0 and pi");
  if (!(viewportHeight > 0)) fail(BAD_ARGUMENT, "viewportHeight is not above 0");
  return numberOf(viewportHeight, "viewportHeight") / (2 * Math.tan(verticalFov / 2));
}
// In the order of gim_js_refine.
function rowOf(rule) {
  return [
    numberOf(rule.pixelError, "pixelError"), ...numbersOf(rule.eye, 3, "eye"), pixelsPerUnit(rule),
    numberOf(rule.objectError, "objectError"),
    ...numbersOf(rule.box && rule.box.low, 3, "box.low"), ...numbersOf(rule.box && rule.box.high, 3, "box.high"),
    ...numbersOf(rule.sphere && rule.sphere.center, 3, "sphere.center"), numberOf(rule.sphere && rule.sphere.radius, "sphere.radius"),
    numberOf(rule.keep, "keep"), whole(rule.mostTriangles, "mostTriangles", 0),
  ];
}

export class GimRefinedMesh extends Handle {
  // domain: a GimDomain.
  constructor(domain, mostTriangles) {
    super(domain.alive(), domain);
    try {
      this.begin(domain, whole(mostTriangles, "mostTriangles", domain.mostTriangles));
    } catch (error) {
      this.dispose();
      throw error;
    }
  }
  begin(domain, mostTriangles) {
    const { heap } = this, size = heap.wasm.gim_js_refined_size(domain.at, mostTriangles);
    if (size === 0) fail(BAD_ARGUMENT, `a mesh of at most ${mostTriangles} triangles is smaller than the base`);
    this.mostTriangles = mostTriangles;
    const memory = this.hold(size);
    this.row = this.hold(64 * 8);
    heap.check(heap.wasm.gim_begin_refined(domain.at, mostTriangles, memory, size, this.row));
    this.at = heap.numbers(this.row, 1)[0];
  }

  get triangleCount() {
    this.view();
    return this.count;
  }
  // The triangles as they lie in the module's memory.
  view() {
    const heap = this.alive(), at = heap.wasm.gim_refined_triangles(this.at, this.row);
    this.count = heap.numbers(this.row, 1)[0];
    return heap.numbers(at, 3 * this.count);
  }
  get triangles() {
    return this.view().slice();
  }

  refine(rule, { mostOperations } = {}) {
    const heap = this.alive(), { wasm } = heap, most = whole(mostOperations, "mostOperations", 0);
    const row = rowOf(rule), planes = rule.planes ?? [];
    if (planes.length % 4 !== 0) fail(BAD_ARGUMENT, "planes does not have four numbers for each plane");
    const ofPlanes = numbersOf(planes, planes.length, "planes");
    if (rule.need !== undefined && typeof rule.need !== "function") fail(BAD_ARGUMENT, "need is no function");
    return heap.with((take) => {
      const planesAt = take(planes.length * 4);
      heap.floats(planesAt, planes.length).set(ofPlanes);
      new Float64Array(wasm.memory.buffer, this.row, row.length).set(row);
      const doneAt = this.row + 63 * 8;
      const run = () =>
        heap.check(wasm.gim_js_refine(this.at, this.row, planesAt, planes.length / 4, rule.need ? 1 : 0, most, doneAt));
      if (rule.need) heap.withNeed(rule.need, run);
      else run();
      return heap.numbers(doneAt, 1)[0] === 1;
    });
  }

  takeChanges() {
    const heap = this.alive();
    heap.wasm.gim_js_changes(this.at, this.row);
    const [added, addedCount, removed, removedCount, changed, changedCount, trianglesBefore, triangleCount] = heap.row(this.row, 8);
    const triangles = heap.numbers(changed, changedCount).slice(), all = this.view(), vertices = new Uint32Array(3 * triangles.length);
    triangles.forEach((triangle, i) => {
      for (let k = 0; k < 3; ++k) vertices[3 * i + k] = all[3 * triangle + k];
    });
    return {
      added: heap.numbers(added, addedCount).slice(), removed: heap.numbers(removed, removedCount).slice(),
      triangles, vertices, trianglesBefore, triangleCount,
    };
  }
  updateIndex(index) {
    const { triangles, vertices, triangleCount } = this.takeChanges();
    if (!(index.length >= 3 * triangleCount)) fail(SCRATCH_TOO_SMALL, `the index has no room for ${triangleCount} triangles`);
    let first = Infinity, end = 0;
    triangles.forEach((triangle, i) => {
      for (let k = 0; k < 3; ++k) index[3 * triangle + k] = vertices[3 * i + k];
      first = Math.min(first, triangle);
      end = Math.max(end, triangle + 1);
    });
    return end > 0 ? { triangleCount, start: 3 * first, count: 3 * (end - first) } : { triangleCount, start: 0, count: 0 };
  }

  halfEdge(number) {
    const heap = this.alive();
    heap.check(heap.wasm.gim_js_half_edge(this.at, whole(number, "the half-edge", nothing), this.row));
    const [mate, vertex, tile, startRow, startColumn, endRow, endColumn, level] = heap.row(this.row, 8);
    return { mate: orNull(mate), vertex, tile, start: [startRow, startColumn], end: [endRow, endColumn], level };
  }
  split(triangle) {
    const heap = this.alive();
    heap.check(heap.wasm.gim_split(this.at, whole(triangle, "the triangle", nothing)));
  }
  weld(vertex) {
    const heap = this.alive(), number = whole(vertex, "the vertex", nothing);
    if (number >= this.owner.vertexCount) fail(BAD_ARGUMENT, "there is no such vertex");
    heap.check(heap.wasm.gim_weld(this.at, number));
  }
  patches() {
    const heap = this.alive(), room = 2 * this.triangleCount;
    return heap.with((take) => {
      const at = take(8 * room);
      heap.check(heap.wasm.gim_read_patches(this.at, at, room, this.row));
      return heap.bytes(at, 8 * heap.numbers(this.row, 1)[0]).slice();
    });
  }
}
