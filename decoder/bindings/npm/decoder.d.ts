/**
 * Decodes `.gim` files: geometry images, as meshes at any of several resolutions.
 *
 *     import { GimDecoder } from "gim/decoder";
 *     await GimDecoder.ready;
 *     const { positions, normals, triangles } = GimDecoder.decodeMesh(bytes, { level: 1 });
 *
 * Every call takes the bytes of a file, or of its first part: a level needs only `prefixSize` bytes. Nobody writes to
 * your bytes, keeps them, or takes their buffer away. What a call returns is yours.
 * Bytes may come from anybody: what no encoder writes is refused with a {@link GimError}, before memory is taken for it.
 * Files, levels and layouts are described in the format's specification.
 */

/** The bytes of a file, or of its first part. */
export type GimBytes = ArrayBufferLike | ArrayBufferView;

export type GimStatusName =
  | "NEED_MORE_INPUT"
  | "NOT_GIM"
  | "UNSUPPORTED_VERSION"
  | "MALFORMED"
  | "LIMIT_EXCEEDED"
  | "BAD_ARGUMENT"
  | "SCRATCH_TOO_SMALL"
  | "CHECKSUM"
  | "NO_SUCH_LEVEL"
  | "NO_SUCH_PLANE";

/** Thrown by every call, and what the promise of `decodeAsync` is rejected with. */
export class GimError extends Error {
  constructor(status: number, message: string);
  readonly name: "GimError";
  /** -1: give more bytes and call again. Positive: final. The numbers are those of `gim/decoder.h`. */
  readonly status: number;
  readonly statusName: GimStatusName;
}

/** What is refused with LIMIT_EXCEEDED. */
export interface GimLimits {
  /** Samples of all images together. Default 2^26. */
  maxSamples?: number;
  /** Default 65536. */
  maxImages?: number;
  /** Samples along a row or a column. Default 16385. */
  maxSide?: number;
  /** Bytes of memory that a call may take for the file, its results and its work together. Default 2^30. */
  maxMemory?: number;
}

export interface GimLevelOptions extends GimLimits {
  /** Which image of the file. Default 0. */
  image?: number;
  /** 0, the default, is full resolution; each further level has half as many samples along a side. */
  level?: number;
}

export type GimPlaneName = "normals" | "colors" | "displacements";

export interface GimPlaneOptions extends GimLevelOptions {
  plane: GimPlaneName;
  /** Of the plane: 0, the default, is its full resolution. */
  level?: number;
}

export interface GimSurfaceOptions extends GimLevelOptions {
  /** False: leave them out. It saves their time and memory. */
  normals?: boolean;
  texcoords?: boolean;
  triangles?: boolean;
}

/** Header and index of a file. */
export interface GimInfo {
  version: number;
  /** gim: one square per component. mcgim: charts in a rectangle. tiles: squares that are glued along their sides. */
  layout: "gim" | "mcgim" | "tiles";
  coding: "lossless" | "lossy";
  /** Bits per coordinate of the bounding box, 8 .. 20. */
  bits: number;
  imageCount: number;
  /** Levels stored; an image has the levels 0 .. `coarsestLevel`. */
  levelCount: number;
  /** Of all images at level 0. */
  sampleCount: number;
  /** Bytes of the whole file. */
  fileSize: number;
  /** Decoded positions are relative to `origin`, because binary32 could not hold their sum. */
  isRelative: boolean;
  /** Object units per quantization step. */
  step: number;
  /** Lossy: the quantizer's step across the surface, in quantization steps. Lossless: 0. */
  quantizer: number;
  /** Bytes of header and index: `info` needs no more of the file. */
  indexSize: number;
  /** Where coordinates of 0 units lie, in object units. */
  origin: [number, number, number];
  /**
   * Of each level, finest first: distance in object units between its surface and the encoder's input, root of the mean
   * square, the larger of both ways, as the encoder measured it. 0: the file does not say.
   */
  levelRmsError: number[];
  /** The same, the largest distance. */
  levelMaxError: number[];
  /** Whether the file tells the boxes of all its images. False: boxes are without end. */
  hasBoxes: boolean;
  /** Holds the boxes of all images. */
  box: GimBox;
}

/** A box along the axes, in the coordinates of decoded positions. */
export interface GimBox {
  low: [number, number, number];
  high: [number, number, number];
}

/** A part of the file. Chunks lie one after the other behind the index. */
export interface GimChunk {
  /** Seams, a level, text, a plane (normals, colours, displacements), or labels. */
  name: "SEAM" | "LEVL" | "META" | "NRML" | "COLR" | "DISP" | "LABL" | "????";
  /** Of LEVL; else -1. */
  level: number;
  /** Its first byte in the file. */
  offset: number;
  size: number;
}

/** How a camera sees a surface. */
export interface GimView {
  /** From the eye to the nearest point of the surface, or of its box; object units. */
  distance: number;
  /** Radians; that of the viewport's height. */
  verticalFov: number;
  /** Pixels. */
  viewportHeight: number;
  /** How large `levelMaxError` may be on the screen, pixels. */
  pixelError: number;
  /** The level shown before; left out if there is none. */
  shown?: number;
}

/** One level of one image. */
export interface GimLevelInfo {
  /** Layout gim: samples along a side. Else 0. */
  side: number;
  /** Samples of the grid. */
  width: number;
  height: number;
  coarsestLevel: number;
  /** Of `decodeMesh`. */
  vertexCount: number;
  /** Of all kinds of meshes. */
  triangleCount: number;
  /** Bytes of the file, from its start, that this level needs. */
  prefixSize: number;
  /** Bytes of memory that decoding needs besides its results. */
  scratchSize: number;
}

/** One level of a plane. */
export interface GimPlaneInfo {
  width: number;
  height: number;
  /** Of the plane. */
  coarsestLevel: number;
  quantizer: number;
  /** Bytes of this image's plane in the file. */
  streamSize: number;
  /** Bytes of the file, from its start, that the plane needs. */
  prefixSize: number;
  scratchSize: number;
}

/** n samples, row by row. Undefined samples are NaN. */
export interface GimPositions {
  width: number;
  height: number;
  /** x y z of each sample, in object units; relative to `origin` if `isRelative`. */
  positions: Float32Array;
}

/** A mesh of n vertices. */
export interface GimMesh {
  /** x y z of each vertex, in object units; relative to `origin` if `isRelative`. */
  positions: Float32Array;
  /** Of unit length; 0 0 0 where the surface has none. Left out if `normals` was false. */
  normals?: Float32Array;
  /** u v of each vertex, in the grid of level 0, at every level; v = 0 is the first row. */
  texcoords?: Float32Array;
  /** Three vertices each, counter-clockwise seen from outside. */
  triangles?: Uint32Array;
}

/** A mesh whose vertices are the samples, row by row. Undefined samples are NaN and in no triangle. */
export interface GimGrid extends GimMesh {
  width: number;
  height: number;
}

/** Three numbers of each sample, row by row: a unit normal, or red green blue in 0 .. 1 as sRGB, or a displacement. */
export interface GimPlane {
  width: number;
  height: number;
  values: Float32Array;
}

/** How many labels a level has, and how many bytes of the file, from its start, they need. */
export interface GimLabelsInfo {
  cellCount: number;
  prefixSize: number;
  scratchSize: number;
}

export interface GimSeams {
  /** Layout gim: 4 (side - 1) numbers, one per sample of the rim; samples of one surface point have equal ones. Else null. */
  classOf: Uint32Array | null;
  /** Paths of the cut, of the charts' borders, or sides of tiles. */
  pathCount: number;
}

export interface GimAsync {
  /** Rejects the promise at once when it is aborted, with its reason: a DOMException named AbortError by default. */
  signal?: AbortSignal;
}

export interface GimDecoderType {
  /** Whether there is WebAssembly with SIMD. */
  readonly supported: boolean;
  /** Resolves when calls may be made. Rejects if a policy of the page forbids WebAssembly. */
  readonly ready: Promise<void>;

  /** Reads header and index. Needs `indexSize` bytes, which are hardly ever more than a hundred. */
  info(bytes: GimBytes, options?: GimLimits): GimInfo;
  /** A box that holds an image at each of its levels. Needs header and index only. */
  box(bytes: GimBytes, options?: GimLimits & { image?: number }): GimBox;
  /** What the file consists of, in its order. Needs header and index only. */
  chunks(bytes: GimBytes, options?: GimLimits): GimChunk[];
  /**
   * The coarsest level whose largest error is at most `pixelError` on the screen; 0 if there is none. A coarser one
   * replaces `shown` only if its error is at most 3/4 of that, so a surface near the limit does not change back and forth.
   * The level is the file's: do not show an image beyond its `coarsestLevel`. Needs header and index only.
   */
  chooseLevel(bytes: GimBytes, view: GimView & GimLimits): number;
  /** Needs the chunk of seams, which is near the start of the file. NO_SUCH_LEVEL beyond `coarsestLevel`. */
  levelInfo(bytes: GimBytes, options?: GimLevelOptions): GimLevelInfo;
  /** NO_SUCH_PLANE if the file has none of that kind. */
  planeInfo(bytes: GimBytes, options: GimPlaneOptions): GimPlaneInfo;

  /** The samples of the image. */
  decodePositions(bytes: GimBytes, options?: GimLevelOptions): GimPositions;
  /** A mesh without gaps: samples of one surface point are one vertex. */
  decodeMesh(bytes: GimBytes, options?: GimSurfaceOptions): GimMesh;
  /** The same with vertices split at sharp edges, for shading. Equal to `decodeMesh` if the file names no sharp edges. */
  decodeHardMesh(bytes: GimBytes, options?: GimSurfaceOptions): GimMesh;
  /** Every sample is a vertex, with a texture coordinate of its own: for texturing. */
  decodeGrid(bytes: GimBytes, options?: GimSurfaceOptions): GimGrid;
  /** Normals, colours or displacements, on a grid of their own resolution. */
  decodePlane(bytes: GimBytes, options: GimPlaneOptions): GimPlane;
  /** NO_SUCH_PLANE if the file has no labels: then all cells are alike. */
  labelsInfo(bytes: GimBytes, options?: GimLevelOptions): GimLabelsInfo;
  /** Which part of the surface, for example which material, each cell belongs to: label i is that of triangles 2i and 2i+1. */
  decodeLabels(bytes: GimBytes, options?: GimLevelOptions): Uint8Array;
  /** How the rim of an image is glued, for tools. */
  readSeams(bytes: GimBytes, options?: GimLevelOptions): GimSeams;
  /** What the file says about itself; "" if nothing. Text that was compressed is refused with UNSUPPORTED_VERSION. */
  readText(bytes: GimBytes, options?: GimLimits): string;

  /**
   * Lets `decodeAsync` use so many workers; 0, the default, ends them. They start when there is work. Where a policy of the
   * page forbids them, `decodeAsync` decodes on the thread that calls it, file after file.
   */
  useWorkers(count: number): void;
  /** Decodes in a worker, or later on this thread. Do not change the bytes before the promise is settled. */
  decodeAsync(what: "positions", bytes: GimBytes, options?: GimLevelOptions & GimAsync): Promise<GimPositions>;
  decodeAsync(what: "mesh" | "hardMesh", bytes: GimBytes, options?: GimSurfaceOptions & GimAsync): Promise<GimMesh>;
  decodeAsync(what: "grid", bytes: GimBytes, options?: GimSurfaceOptions & GimAsync): Promise<GimGrid>;
  decodeAsync(what: "plane", bytes: GimBytes, options: GimPlaneOptions & GimAsync): Promise<GimPlane>;
}

export const GimDecoder: GimDecoderType;
