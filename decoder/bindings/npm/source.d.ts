/**
 * Fetches a `.gim` file as far as it is wanted. The first request takes 16,384 bytes, which is all of most files; each
 * later one goes to the end of the level that is asked for.
 *
 *     import { GimSource } from "gim/source";
 *     import { GimDecoder } from "gim/decoder";
 *     const source = await GimSource.open("bunny.gim");
 *     const coarse = GimDecoder.decodeMesh(await source.level(source.levelCount - 1), { level: source.levelCount - 1 });
 *     const fine = GimDecoder.decodeMesh(await source.level(0));
 *
 * What servers do is taken as it comes: 200 in place of 206 (the body is read to its end, and nothing is asked again), 416
 * (asked again with the length that the server tells), encoded bodies and wrong ranges (the whole file is fetched), answers
 * that break off (the rest is asked for), no network and status 429, 500, 502, 503, 504 (one more try after `retryDelay`).
 * A file whose strong ETag, Last-Modified or length changes is read again from its start, once.
 * From another origin the server must allow it (CORS); `Range` and the headers that are read need no permission beyond that,
 * but without `Access-Control-Expose-Headers: ETag` a change is noticed later, by a checksum.
 */
import type { GimChunk, GimInfo, GimLimits, GimPlaneName } from "gim/decoder";

export type GimSourceInput = string | URL | Blob | ArrayBufferLike | ArrayBufferView;

/** Why a file could not be fetched. */
export class GimSourceError extends Error {
  readonly name: "GimSourceError";
  /**
   * NETWORK: no answer, twice. HTTP: a status that is no success. CHANGED: the file changed twice. TRUNCATED: the file or
   * the answer is shorter than its index says. BUDGET: `maxBytes`. CLOSED: `close()` was called. FORMAT: no GLB.
   */
  readonly code: "NETWORK" | "HTTP" | "CHANGED" | "TRUNCATED" | "BUDGET" | "CLOSED" | "FORMAT";
  /** Of HTTP. */
  readonly httpStatus?: number;
}

export interface GimSourceOptions {
  /** Ends the opening. Later calls take signals of their own. */
  signal?: AbortSignal;
  /** In place of the global `fetch`. */
  fetch?: typeof fetch;
  /** Sent with each request. */
  headers?: Record<string, string>;
  credentials?: RequestCredentials;
  /** Of the first request. Default 16384. */
  firstBytes?: number;
  /** What all requests together may load. Default 2^28. */
  maxBytes?: number;
  /** Milliseconds before a second try. Default 300. */
  retryDelay?: number;
  /** What to refuse, as the decoder's calls do. */
  limits?: GimLimits;
  /** Called when bytes have come. `total` is the file's size once its index is here. */
  onProgress?: (progress: { loaded: number; total: number | undefined }) => void;
}

export interface GimWait {
  /** Rejects the promise at once. A request that nobody waits for any more is ended. */
  signal?: AbortSignal;
}

export class GimSource {
  /**
   * Resolves when header and index are here. Rejected with GimSourceError, GimError or the signal's reason. The bytes in an
   * ArrayBuffer are not copied.
   */
  static open(input: GimSourceInput, options?: GimSourceOptions): Promise<GimSource>;

  readonly info: GimInfo;
  readonly levelCount: number;
  readonly chunks: GimChunk[];
  /** What is here: the first bytes of the file. Do not write to it. It stays valid, and does not grow. */
  readonly bytes: Uint8Array;
  /** Bytes that came, those of failed tries and of older versions included. */
  readonly bytesLoaded: number;
  /** How many were sent. */
  readonly requests: number;
  /** How often the file was found changed, and read from its start: 0 or 1. `info` and `chunks` are then those of the new file. */
  readonly generation: number;

  /** Bytes of the file, from its start, that a level needs. RangeError if there is no such level. */
  levelSize(level: number): number;
  /** Whether they are here. */
  has(level: number): boolean;
  /**
   * Resolves to the first bytes of the file, at least as many as the level needs. Calls of one turn become one request. So
   * do levels that end less than 4,096 bytes behind.
   */
  level(level: number, options?: GimWait): Promise<Uint8Array>;
  /** The same for a plane. Planes lie behind all levels. */
  plane(name: GimPlaneName, options?: GimWait): Promise<Uint8Array>;
  /** The whole file. */
  whole(options?: GimWait): Promise<Uint8Array>;
  /** Ends requests, whose promises are rejected with CLOSED, and lets go of the bytes. */
  close(): void;
}

export interface GimPartOptions {
  /** Of the first request for the part. Default 4096. */
  firstBytes?: number;
  limits?: GimLimits;
  signal?: AbortSignal;
}

/**
 * A GLB file of which only parts are fetched: the JSON first, with what comes in the first 16,384 bytes, then what is asked
 * for. What is asked for in one turn of the page and lies less than 4,096 bytes apart comes by one request. `loadGIMScene` of
 * `gim/three` is made of it.
 *
 *     const glb = await GimGlb.open("scene.glb");
 *     const view = glb.json.bufferViews[5];
 *     const source = await glb.source(view.byteOffset ?? 0, view.byteLength);    // of a view with a .gim
 *
 * Servers are taken as GimSource takes them; one without ranges gives the whole file at once. A file that changes after its
 * JSON came is an error, CHANGED: where its parts lie is not known any more.
 */
export class GimGlb {
  /** Resolves when the JSON is here. Rejected with GimSourceError or the signal's reason. */
  static open(input: GimSourceInput, options?: GimSourceOptions): Promise<GimGlb>;
  /** As in the file. */
  readonly json: any;
  /** Bytes of the BIN chunk. */
  readonly binSize: number;
  readonly bytesLoaded: number;
  readonly requests: number;
  /** Bytes of the BIN chunk. RangeError if they are not in it. */
  read(offset: number, size: number, options?: GimWait): Promise<Uint8Array>;
  /** Opens a .gim that lies in the BIN chunk. Its `bytesLoaded` and `requests` are those of this part. */
  source(offset: number, size: number, options?: GimPartOptions): Promise<GimSource>;
  /** Ends requests and what waits for them, with CLOSED. */
  close(): void;
}
