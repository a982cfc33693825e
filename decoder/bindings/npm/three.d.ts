/**
 * Meshes of `.gim` files in three.js.
 *
 *     import { GIMMesh } from "gim/three";
 *     const mesh = new GIMMesh("bunny.gim");      // a THREE.Mesh: coarse at once, then as fine as the screen needs
 *     scene.add(mesh);
 *
 *     import { GIMLoader } from "gim/three";
 *     const geometry = await new GIMLoader().loadAsync("bunny.gim");    // one level, as a BufferGeometry
 *
 * A geometry has index, position, normal and uv. Several images of a file become one geometry with a group for each, whose
 * materialIndex is the image. Its bounding box and sphere are those of the file's index, which hold at all levels.
 * Positions of files whose origin is far away are relative to `userData.origin`, which no 32-bit number could hold.
 */
import type {
  BufferGeometry, Camera, DataTexture, Group, Loader, LoadingManager, Material, Mesh, Object3DEventMap, WebGLRenderer,
} from "three";
import type { GimBytes, GimLimits, GimPlaneName, GimPlaneOptions } from "gim/decoder";
import type { GimGlb, GimSource, GimSourceInput, GimSourceOptions } from "gim/source";

/** `geometry.userData` */
export interface GIMGeometryData {
  /** Of the file; 0 is the finest. */
  level: number;
  isRelative: boolean;
  /** What to add to positions, in doubles; 0 0 0 if they contain it. */
  origin: [number, number, number];
  /** Distances to the encoder's input, in object units; 0: the file does not tell. */
  rmsError: number;
  maxError: number;
  /** Where each image lies in the arrays. */
  images: { image: number; level: number; vertexStart: number; vertexCount: number; indexStart: number; indexCount: number }[];
  /** By GIMLoader, for each image, if the file has colours or normals. They are yours to dispose of. */
  textures?: GIMTextures[];
}

/** For `map`, and for `normalMap` with `normalMapType = ObjectSpaceNormalMap`. */
export interface GIMTextures {
  colors?: DataTexture;
  normals?: DataTexture;
}

/** Loads one level of a file. In the manner of three's own loaders: `load`, `loadAsync`, `setPath`, `setRequestHeader`, ... */
export class GIMLoader extends Loader<BufferGeometry> {
  constructor(manager?: LoadingManager);
  /** Default 0, the finest. Beyond the coarsest one: the coarsest. Only its bytes are fetched. */
  setLevel(level: number): this;
  /** What to refuse. */
  setLimits(limits: GimLimits): this;
  /** False: leave colours and normal map out, and their bytes unfetched. Default true. */
  setTextures(hasTextures: boolean): this;
  /** Decodes in so many workers, which all of the page share: `GimDecoder.useWorkers`. Default 0. */
  setWorkerLimit(workerLimit: number): this;
  /** Does nothing: importing this compiles the decoder. */
  preload(): this;
  load(
    url: string, onLoad?: (geometry: BufferGeometry) => void, onProgress?: (event: ProgressEvent) => void,
    onError?: (error: unknown) => void,
  ): void;
  /** Bytes stay the caller's. */
  parse(bytes: GimBytes, onLoad: (geometry: BufferGeometry) => void, onError?: (error: unknown) => void): void;
  parseAsync(bytes: GimBytes): Promise<BufferGeometry>;
  /** Ends what is being loaded. */
  abort(): this;
  /** The same; ends the workers if `setWorkerLimit` started them. */
  dispose(): this;
}

export interface GIMMeshOptions extends Omit<GimSourceOptions, "signal"> {
  /** Pixels by which the surface may be off on the screen. Default 1. */
  pixelError?: number;
  /** Shows this level always. Default: the camera chooses. */
  level?: number;
  /** Memory that it shares with other meshes. Then `budget.update()` chooses levels, once a frame. */
  budget?: GIMBudget;
  /** False: without the file's colours and normal map. Default true. */
  textures?: boolean;
}

export interface GIMMeshEventMap extends Object3DEventMap {
  /** Another level is shown. -1: none. */
  levelchange: { level: number; previous: number; triangles: number };
  /** The level that the camera needs is shown, with its textures, and nothing is being loaded. */
  finished: { level: number; triangles: number };
  /** The material is a copy with the file's textures. */
  textures: {};
  /** Loading or decoding failed. What is shown stays. Nothing is thrown elsewhere. */
  error: { error: unknown };
}

/**
 * A mesh that shows the coarsest level when the first bytes are here, and then the level that its place on the screen needs.
 * Each time it is drawn it chooses by `GimDecoder.chooseLevel` from the distance of its box, the camera's field of view and
 * the picture's height. It keeps the file's bytes and the level that it shows; other levels are let go, on the GPU too.
 * Levels of one mesh have no cracks. It cannot be cloned: make another one from its `source`, which costs no bytes.
 */
export class GIMMesh extends Mesh<BufferGeometry, Material | Material[], GIMMeshEventMap> {
  /** material: default MeshStandardMaterial. It stays the caller's. */
  constructor(input: GimSourceInput | GimSource, material?: Material | Material[], options?: GIMMeshOptions);
  /** Null until the index is here. A source that was given is not closed by `dispose()`. */
  readonly source: GimSource | null;
  /** The level shown; -1: none. */
  readonly level: number;
  /** 0 until the index is here. */
  readonly levelCount: number;
  readonly triangleCount: number;
  /** Bytes of memory: of the file, the geometry and the textures. Buffers and textures on the GPU are copies of these. */
  readonly byteCount: number;
  readonly error: unknown;
  pixelError: number;
  /** Chooses a level. Drawing does so too, unless there is a budget. viewport: the renderer, or the picture's height in pixels. */
  update(camera: Camera, viewport: WebGLRenderer | number): void;
  /** Shows this level from now on. Null: the camera chooses again. */
  setLevel(level: number | null): this;
  /** Lets go of everything, and ends requests. */
  dispose(): void;
}

/**
 * Memory that meshes share: `byteCount` stays at most `maxBytes`. Near meshes get what they need first; those for which there
 * is no room are coarser, or not shown.
 */
export class GIMBudget {
  /** Default 2^28. */
  constructor(maxBytes?: number);
  maxBytes: number;
  readonly meshes: Set<GIMMesh | GIMGLTFMesh>;
  /** What the meshes hold together. */
  readonly byteCount: number;
  /** Call it once a frame, before drawing. Cost O(meshes log meshes); no level is decoded here. */
  update(camera: Camera, viewport: WebGLRenderer | number): void;
}

/** A plane of an image as a texture for the uv of the loader's geometries. Displacements are in object units. */
export function planeTexture(bytes: GimBytes, options: GimPlaneOptions): DataTexture;
/** Copies of a material with textures of `userData.textures`; an array if there are several images. */
export function texturedMaterial(textures: GIMTextures[], material: Material): Material | Material[];

export interface GIMSceneOptions {
  /** Pixels by which surfaces may be off on the screen. Default 1. */
  pixelError?: number;
  /** Shows this level of all meshes always. Default: the camera chooses. */
  level?: number;
  /** Memory that the meshes share with others. Then `budget.update()` chooses levels, once a frame. */
  budget?: GIMBudget;
  /** What to refuse. */
  limits?: GimLimits;
}

/**
 * Loads a GLB whose meshes are .gim files (`EXT_gim_geometry`) by ranges. Resolves to what GLTFLoader gives, with `gim`, when
 * the coarsest level of each mesh is here. Pictures come next. Each time a mesh is drawn, it chooses the level that its place on
 * the screen needs, and fetches what that level lacks. All else, such as animations, is as GLTFLoader makes it.
 *
 *     const gltf = await loadGIMScene("scene.glb", new GLTFLoader());
 *     scene.add(gltf.scene);
 *
 * loader: a GLTFLoader. Its manager, paths, headers, credentials and plugins count.
 * Rejected with GimSourceError, GimError, or what GLTFLoader says. Later failures are events of the meshes.
 * Of the options, `firstBytes` is for the JSON: default 16384.
 */
export function loadGIMScene(
  input: GimSourceInput, loader: GLTFLoaderLike, options?: GIMSceneOptions & GimSourceOptions,
): Promise<GIMGLTF>;

/** What is used of three's GLTFLoader. */
export interface GLTFLoaderLike {
  manager: LoadingManager;
  path: string;
  resourcePath: string;
  register(callback: (parser: any) => any): any;
  unregister(callback: (parser: any) => any): any;
  parseAsync(data: any, path: string): Promise<any>;
}

/** What GLTFLoader gives, and what refines in it. */
export interface GIMGLTF {
  scene: Group;
  scenes: Group[];
  gim: GIMScene;
  /** animations, cameras, asset, parser, userData: as GLTFLoader gives them. */
  [more: string]: any;
}

export interface GIMScene {
  /** One for each node with such a mesh. */
  readonly meshes: GIMGLTFMesh[];
  /** Tells how many bytes and requests it took. */
  readonly source: GimGlb;
  /** Resolves when all meshes have their textures. */
  readonly materials: Promise<void>;
  /** Disposes of all meshes and ends requests. Materials and textures are yours to dispose of, as with GLTFLoader. */
  dispose(): void;
}

/**
 * A mesh of a glTF file: a group of one Mesh for each primitive, all at one level, so that borders between materials do not
 * crack. It chooses its level as GIMMesh does, and keeps to one level of memory as that does. A clone shows a level of its own,
 * and shares the file's bytes.
 */
export class GIMGLTFMesh extends Group<GIMMeshEventMap> {
  private constructor();
  /** Of the primitives, in the order of the file. Their geometries change with the level. */
  readonly parts: Mesh[];
  readonly source: GimSource | null;
  /** The level shown; -1: none. */
  readonly level: number;
  readonly levelCount: number;
  readonly triangleCount: number;
  /** Bytes of memory: of the .gim and the geometry. Textures are not counted. */
  readonly byteCount: number;
  readonly error: unknown;
  pixelError: number;
  /** Resolves when the coarsest level is shown. */
  readonly first: Promise<void>;
  /** Chooses a level. Drawing does so too, unless there is a budget. */
  update(camera: Camera, viewport: WebGLRenderer | number): void;
  /** Shows this level from now on. Null: the camera chooses again. */
  setLevel(level: number | null): this;
  clone(): this;
  dispose(): void;
}

/**
 * `EXT_gim_geometry` for GLTFLoader: `loader.register((parser) => new GIMGLTFExtension(parser))`. It makes the meshes of the
 * level that is asked for, by default the finest; geometries have the arrays that the extension's text describes.
 * With `source`, meshes refine as they do with `loadGIMScene`, and all buffer views come from there: then give GLTFLoader's
 * `parse` the source's `json`.
 */
export class GIMGLTFExtension {
  /** parser: GLTFParser. level: beyond the coarsest of an image, that one. */
  constructor(parser: unknown, options?: { level?: number; limits?: GimLimits } | (GIMSceneOptions & { source: GimGlb }));
  readonly name: "EXT_gim_geometry";
}
