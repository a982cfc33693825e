// An opened image: gim_domain of gim/refine.h.
import { GimDecoder } from "gim/decoder";
import { decodeClusters } from "./refine_clusters.js";
import { BAD_ARGUMENT, Handle, fail, whole } from "./refine_heap.js";
import { GimRefinedMesh } from "./refine_mesh.js";

const infoAt = 512; // of gim_info in a session (decoder/bindings/wasm/calls.cpp)
const charts = 1; // GIM_LAYOUT_MCGIM
const nothing = 0xffffffff;
const fields = ["tileCount", "intervals", "vertexCount", "mostTriangles", "domainSize", "scratchSize", "width", "height"];

const viewOf = (bytes) => (ArrayBuffer.isView(bytes) ? new Uint8Array(bytes.buffer, bytes.byteOffset, bytes.byteLength) : new Uint8Array(bytes));

// Positions of gim_decode_mesh: the caller's, or decoded here.
function positionsOf(bytes, { positions, ...how }) {
  const { vertexCount } = GimDecoder.levelInfo(bytes, how);
  if (positions === undefined) return GimDecoder.decodeMesh(bytes, { ...how, normals: false, texcoords: false, triangles: false }).positions;
  if (!(positions instanceof Float32Array) || positions.length !== 3 * vertexCount)
    fail(BAD_ARGUMENT, `positions is no Float32Array of ${3 * vertexCount} numbers, as decodeMesh gives`);
  if (!positions.every(Number.isFinite)) fail(BAD_ARGUMENT, "positions are not all numbers");
  return positions;
}

export class GimDomain extends Handle {
  // owner: GimRefine. options: of GimRefine.open.
  constructor(heap, owner, bytes, options) {
    super(heap, owner);
    try {
      this.open(bytes, options);
    } catch (error) {
      this.dispose();
      throw error;
    }
  }
  open(bytes, { image, level, positions, details, planeLevel, ...limits }) {
    const { maxMemory = 0x40000000, maxSamples = 0x4000000, maxImages = 65536, maxSide = 16385 } = limits;
    const { heap } = this, { wasm } = heap;
    if (details && level) fail(BAD_ARGUMENT, "a domain with details has level 0");
    const samples = positionsOf(bytes, { ...limits, image, level, positions });
    const moved = details ? GimDecoder.decodePlane(bytes, { ...limits, plane: "displacements", image, level: planeLevel }).values : null;
    const file = viewOf(bytes);
    heap.with((take, count) => {
      const session = take(wasm.gim_js_session_size()), fileAt = take(file.length);
      heap.bytes(fileAt, file.length).set(file);
      heap.check(wasm.gim_js_info(session, fileAt, file.length, maxSamples, maxImages, maxSide));
      if (heap.row(session, 2)[1] === charts) fail(BAD_ARGUMENT, "images of the layout mcgim have no tiles to refine");
      const place = [session + infoAt, fileAt, file.length, whole(image, "image", 0), whole(details ? planeLevel : level, "level", 0)];
      heap.check((details ? wasm.gim_js_detailed_domain : wasm.gim_js_domain)(...place, session));
      heap.row(session, fields.length).forEach((number, i) => (this[fields[i]] = number));
      const put = (array) => {
        const at = take(array.length * 4);
        heap.floats(at, array.length).set(array);
        return at;
      };
      const given = details ? [put(samples), put(moved), take(this.vertexCount * 12)] : [put(samples)];
      const scratch = take(this.scratchSize);
      count(this.domainSize);
      const memory = this.hold(this.domainSize);
      const open = details ? wasm.gim_open_detailed_domain : wasm.gim_open_domain;
      heap.check(open(...place, ...given, memory, this.domainSize, scratch, this.scratchSize, session));
      this.at = heap.numbers(session, 1)[0];
      this.positions = details ? heap.floats(given[2], this.vertexCount * 3).slice() : samples;
    }, maxMemory);
  }

  refined({ mostTriangles } = {}) {
    return new GimRefinedMesh(this, mostTriangles);
  }
  clusters(options) {
    return decodeClusters(this, options);
  }

  sampleVertices() {
    const heap = this.alive(), count = this.width * this.height;
    return heap.with((take) => {
      const at = take(count * 4);
      heap.wasm.gim_read_sample_vertices(this.at, at);
      return heap.numbers(at, count).slice();
    });
  }
  layOutSamples(ofVertices, components) {
    const heap = this.alive(), count = this.width * this.height * whole(components, "components", 3, 64);
    if (!(ofVertices instanceof Float32Array) || ofVertices.length !== this.vertexCount * components)
      fail(BAD_ARGUMENT, `these are not ${components} numbers for each of ${this.vertexCount} vertices`);
    return heap.with((take) => {
      const from = take(ofVertices.length * 4), to = take(count * 4);
      heap.floats(from, ofVertices.length).set(ofVertices);
      heap.wasm.gim_lay_out_samples(this.at, from, components, to);
      return heap.floats(to, count).slice();
    });
  }
  vertexWorth(vertex) {
    const heap = this.alive();
    if (whole(vertex, "the vertex", nothing) >= this.vertexCount) fail(BAD_ARGUMENT, "there is no such vertex");
    return heap.with((take) => {
      const at = take(8);
      heap.wasm.gim_vertex_worth(this.at, vertex, at, at + 4);
      const [error, radius] = heap.floats(at, 2);
      return { error, radius };
    });
  }
}
