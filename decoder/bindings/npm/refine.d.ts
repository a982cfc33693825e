/// <reference lib="esnext.disposable" />
/**
 * Meshes that are as fine as each place needs, without cracks, and clusters for renderers that cull on the GPU.
 *
 *     import { GimDecoder } from "gim/decoder";
 *     import { GimRefine } from "gim/refine";
 *     await GimRefine.ready;
 *     const { positions, normals } = GimDecoder.decodeMesh(bytes);   // the vertex buffer of all that follows
 *     const domain = GimRefine.open(bytes, { positions });           // once for each image
 *     const mesh = domain.refined({ mostTriangles: 50000 });         // once for each instance
 *     mesh.refine({ eye: [0, 0, 3], verticalFov: 0.8, viewportHeight: 1080, pixelError: 1 });
 *     draw(positions, normals, mesh.triangles);
 *
 * Images of the layouts gim and tiles can be refined. Vertices are those of `decodeMesh` at the level that the domain was
 * opened with, and keep its numbers, so one vertex buffer serves all meshes and all clusters of a domain.
 * Domains and refined meshes lie in memory of the module: call `dispose()` when you need one no more. All else that a call
 * returns is yours. What you pass stays yours: nobody writes to it, keeps it, or takes its buffer away, unless a call says so.
 * Calls throw the GimError of `gim/decoder`. Results have the same bits as those of the native library.
 */
import type { GimBytes, GimLevelOptions } from "gim/decoder";

/** Lengths and places are in object units, as decoded positions are. */
type Triple = ArrayLike<number>;

/**
 * Which vertices a mesh should have. What is left out has no part. A vertex is needed as much as the most demanding part
 * says, and not at all where it lies outside of the regions. BAD_ARGUMENT for numbers that are none.
 */
export interface GimRule {
  /** Screen, with the next three: how many pixels the surface may be off. */
  pixelError?: number;
  /** Where the camera is. */
  eye?: Triple;
  /** Radians; that of the viewport's height. Goes with `viewportHeight`. */
  verticalFov?: number;
  /** Pixels. */
  viewportHeight?: number;
  /** Object space: how far the surface may be off, everywhere. */
  objectError?: number;
  /**
   * Vertex by vertex: above 1, the vertex is added; below `keep`, it is removed. x y z is its place; error and radius are
   * those of `vertexWorth`. What it throws is thrown by `refine`, and the mesh stays sound. It must not call the domain or
   * its meshes.
   */
  need?: (vertex: number, x: number, y: number, z: number, error: number, radius: number) => number;
  /** Only what lies in it. */
  box?: { low: Triple; high: Triple };
  /** Only what lies in it. */
  sphere?: { center: Triple; radius: number };
  /** Only what is on the inner side of all: a b c d each, inside is a x + b y + c z + d >= 0; a b c has length 1. */
  planes?: ArrayLike<number>;
  /** Vertices stay until their need falls below this: 0 .. 1, default 0.75. So what is near the limit does not flicker. */
  keep?: number;
  /** Not more triangles than this, the most needed vertices first. Default: as many as the mesh may have. */
  mostTriangles?: number;
}

/** What differs between a mesh at the last call of `takeChanges` and now. The first call tells the whole mesh. */
export interface GimChanges {
  /** Vertices that the mesh has and did not have, and the other way round. */
  added: Uint32Array;
  removed: Uint32Array;
  /** Numbers of triangles that are new or differ, in no order. */
  triangles: Uint32Array;
  /** Three vertices for each of these. */
  vertices: Uint32Array;
  trianglesBefore: number;
  /** If there are fewer than before, those from here on are gone. */
  triangleCount: number;
}

/** Half-edges 3f, 3f+1, 3f+2 belong to triangle f. The first one is the one that a split of f halves. */
export interface GimHalfEdge {
  /** On the other side of the edge; null on a boundary. */
  mate: number | null;
  /** Where it starts. */
  vertex: number;
  tile: number;
  /** Row and column in the tile, 0 .. `intervals`. */
  start: [number, number];
  end: [number, number];
  /** Of the vertex: the number of splits that led to it, one after the other; 0 in the base. */
  level: number;
}

/**
 * A mesh of a domain. It begins with the base: two triangles for each tile. Neighbours differ by one split at most, and every
 * mesh on the way is as watertight as the surface.
 */
export interface GimRefinedMesh {
  readonly mostTriangles: number;
  readonly triangleCount: number;
  /** A copy: three vertices each, counter-clockwise seen from outside. */
  readonly triangles: Uint32Array;
  readonly isDisposed: boolean;
  /**
   * Splits and welds until the mesh is as the rule wants it, or until `mostOperations` were done (0, the default: no limit).
   * Returns whether nothing is left to do. Where only the eye has moved a little, most triangles are not looked at again.
   */
  refine(rule: GimRule, options?: { mostOperations?: number }): boolean;
  takeChanges(): GimChanges;
  /**
   * Takes the changes, and writes them to an index buffer that was kept up to date this way. `start` and `count` tell which
   * numbers of the index to upload. SCRATCH_TOO_SMALL if it has no room; then begin with all of `triangles`.
   */
  updateIndex(index: Uint32Array): { triangleCount: number; start: number; count: number };
  /**
   * The mesh as squares of the image, for a GPU that makes the triangles: 8 bytes each, as in `gim/refine.h`: column and row
   * of the first sample (16 bits each), the exponents of its side and of its cells, which borders are finer, 0.
   * LIMIT_EXCEEDED if the image has more than 65,536 rows or columns.
   */
  patches(): Uint8Array;
  /** BAD_ARGUMENT if there is none of that number. */
  halfEdge(number: number): GimHalfEdge;
  /**
   * Splits a triangle and the one beyond its first half-edge; coarser ones there are split before. BAD_ARGUMENT if there is no
   * such triangle or its edges are one sample long, SCRATCH_TOO_SMALL if there is no room for more triangles.
   */
  split(triangle: number): void;
  /** Removes a vertex that a split added. BAD_ARGUMENT if the triangles around it are not those that the split made. */
  weld(vertex: number): void;
  /** Gives the memory back. So does `using`, where the engine has it. */
  dispose(): void;
  [Symbol.dispose](): void;
}

export interface GimClusterOptions {
  /** Cells along a side of a cluster: 8, the default (up to 130 vertices, 128 triangles), or 4 (34 and 32). */
  side?: 8 | 4;
  /** Bytes of memory that the call may take. Default 2^30. */
  maxMemory?: number;
}

/** The clusters of one depth follow each other, as do their vertices and triangles. */
export interface GimClusterDepth {
  firstCluster: number;
  clusterCount: number;
  firstVertex: number;
  vertexCount: number;
  firstTriangle: number;
  triangleCount: number;
  /** The largest of its clusters. */
  error: number;
}

/**
 * The nodes of a tree. Those of depth 0 are blocks of cells of the image; a cluster of depth d has cells of 2^d x 2^d samples.
 * Each depth that has triangles is the whole surface, with the vertices of the domain. Depths from `meshDepthCount` on have
 * none; they hold the coarsest clusters together, up to one root: the last cluster.
 * Triangles of different depths do not meet, so side by side they leave cracks as wide as their errors.
 * Arrays have so many numbers for each cluster that a GPU can read them as vectors of four, or two.
 */
export interface GimClusters {
  clusterCount: number;
  depthCount: number;
  meshDepthCount: number;
  /** `depthCount` of them, the finest first. */
  depths: GimClusterDepth[];
  /** 4: centre and radius of a ball that holds the cluster, all below it, and the balls of its children. */
  spheres: Float32Array;
  /**
   * 8: apex x y z, cutoff, axis x y z, 0. The cluster and all below it look away from an eye if
   * dot(normalize(apex - eye), axis) >= cutoff, as with meshoptimizer's. Axis 0 and cutoff 1: never.
   */
  cones: Float32Array;
  /**
   * 2: how far its triangles are from the surface of depth 0, at most, and the same of its parent. 0 in depth 0; without
   * triangles, and of the root's parent, the largest float.
   */
  errors: Float32Array;
  /** 4: parent, first child, number of children (0 .. 4), depth. 0xffffffff: there is none. Children follow each other. */
  links: Uint32Array;
  /** 4: first of `vertices`, their number, first triangle, their number. */
  ranges: Uint32Array;
  /** For each cluster the vertices of the domain that it has. */
  vertices: Uint32Array;
  /** Three bytes for each triangle: places in the vertices of its cluster. */
  triangles: Uint8Array;
}

export interface GimDomainOptions extends GimLevelOptions {
  /** As `GimDecoder.decodeMesh` gives for that image and level; kept, not copied. Left out: they are decoded. */
  positions?: Float32Array;
  /**
   * True: with the file's displacements, which are finer than its samples. NO_SUCH_PLANE if it has none. `level` is 0, and
   * `positions` are those of level 0.
   */
  details?: boolean;
  /** Of the displacements. Default 0, the finest. */
  planeLevel?: number;
}

/** An image, opened for refining. Any number of meshes share it. */
export interface GimDomain {
  /** The vertex buffer: x y z of each vertex. With details it is one of its own. */
  readonly positions: Float32Array;
  readonly vertexCount: number;
  readonly tileCount: number;
  /** Along a side of a tile, 2^k. */
  readonly intervals: number;
  /** Of the finest mesh. */
  readonly mostTriangles: number;
  /** Of its image, in samples. */
  readonly width: number;
  readonly height: number;
  readonly isDisposed: boolean;
  /** A mesh of at most so many triangles; default: of the finest mesh. BAD_ARGUMENT if that is fewer than two a tile. */
  refined(options?: { mostTriangles?: number }): GimRefinedMesh;
  /** Cost: O(triangles * depths). */
  clusters(options?: GimClusterOptions): GimClusters;
  /**
   * What a vertex is worth: `error` bounds how far the mesh errs at its sample, and at all samples that can only come after
   * it, while it is missing. A ball of `radius` around it holds them all. Base vertices have 0.
   */
  vertexWorth(vertex: number): { error: number; radius: number };
  /** The number of the vertex at each sample of the image, row by row; 0xffffffff where no tile has one. */
  sampleVertices(): Uint32Array;
  /** Lays out values of vertices as the samples of the image, for a texture to draw patches from. NaN where no tile has one. */
  layOutSamples(ofVertices: Float32Array, components: number): Float32Array;
  /** Gives the memory back, and that of its meshes. */
  dispose(): void;
  [Symbol.dispose](): void;
}

export interface GimRefineType {
  /** Whether there is WebAssembly with SIMD. */
  readonly supported: boolean;
  /** Resolves when calls may be made. Rejects if a policy of the page forbids WebAssembly. */
  readonly ready: Promise<void>;
  /**
   * Opens an image. Needs the bytes of the level; keeps none of them. BAD_ARGUMENT for files of the layout mcgim, which have
   * no tiles to refine. Cost: O(samples).
   */
  open(bytes: GimBytes, options?: GimDomainOptions): GimDomain;
  /** The triangles of clusters that follow each other, such as those of one depth, as an index buffer. */
  clusterIndices(clusters: GimClusters, first: number, count: number): Uint32Array;
}

export const GimRefine: GimRefineType;
