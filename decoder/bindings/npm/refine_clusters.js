// Clusters of a domain, as arrays: gim/clusters.h.
import { whole } from "./refine_heap.js";

const mostDepths = 32; // GIM_MAX_CLUSTER_DEPTHS

// Numbers of each cluster, in the order of gim_js_split_clusters.
const widths = { spheres: 4, cones: 8, errors: 2, links: 4, ranges: 4 };

function depthsOf(row, count) {
  return Array.from({ length: count }, (_, depth) => {
    const [firstCluster, clusterCount, firstVertex, vertexCount, firstTriangle, triangleCount, error] = row.slice(7 * depth, 7 * depth + 7);
    return { firstCluster, clusterCount, firstVertex, vertexCount, firstTriangle, triangleCount, error };
  });
}

// domain: a GimDomain.
export function decodeClusters(domain, { side = 8, maxMemory = 0x40000000 } = {}) {
  const heap = domain.alive(), { wasm } = heap;
  whole(side, "side", 8);
  return heap.with((take) => {
    const rowAt = take(64 * 8), depthsAt = take(7 * 8 * mostDepths);
    heap.check(wasm.gim_js_cluster_sizes(domain.at, side, rowAt));
    const [clusterRoom, vertexRoom, triangleRoom, scratchSize, recordSize] = heap.row(rowAt, 5);
    const records = take(clusterRoom * recordSize), vertices = take(vertexRoom * 4), triangles = take(triangleRoom * 3);
    const scratch = take(scratchSize);
    const arrays = Object.entries(widths).map(([name, width]) => [name, take(clusterRoom * width * 4), width]);
    heap.check(wasm.gim_js_clusters(domain.at, side, records, vertices, triangles, scratch, scratchSize, rowAt, depthsAt));
    const [clusterCount, vertexCount, triangleCount, depthCount, meshDepthCount] = heap.row(rowAt, 5);
    wasm.gim_js_split_clusters(records, clusterCount, ...arrays.map(([, at]) => at));
    const made = { clusterCount, depthCount, meshDepthCount, depths: depthsOf(heap.row(depthsAt, 7 * depthCount), depthCount) };
    for (const [name, at, width] of arrays) {
      const view = name === "links" || name === "ranges" ? heap.numbers(at, clusterCount * width) : heap.floats(at, clusterCount * width);
      made[name] = view.slice();
    }
    made.vertices = heap.numbers(vertices, vertexCount).slice();
    made.triangles = heap.bytes(triangles, 3 * triangleCount).slice();
    return made;
  }, maxMemory);
}

// The triangles of clusters that follow each other, as an index buffer.
export function clusterIndices({ ranges, vertices, triangles }, first, count) {
  const begin = ranges[4 * first + 2], last = first + count - 1;
  const indices = new Uint32Array(count > 0 ? 3 * (ranges[4 * last + 2] + ranges[4 * last + 3] - begin) : 0);
  for (let cluster = first, to = 0; cluster < first + count; ++cluster) {
    const [firstVertex, , firstTriangle, triangleCount] = ranges.subarray(4 * cluster, 4 * cluster + 4);
    for (let i = 3 * firstTriangle; i < 3 * (firstTriangle + triangleCount); ++i) indices[to++] = vertices[firstVertex + triangles[i]];
  }
  return indices;
}
