// A loader in the manner of three's own.
import { Loader } from "three";
import { GimDecoder } from "gim/decoder";
import { GimSource } from "gim/source";
import { decodeParts, makeGeometry, survey } from "./three_geometry.js";
import { decodeTextures, planesOf } from "./three_texture.js";

export class GIMLoader extends Loader {
  constructor(manager) {
    super(manager);
    this.level = 0;
    this.limits = {};
    this.hasTextures = true;
    this.workerLimit = 0;
    this.controller = new AbortController();
  }

  setLevel(level) {
    this.level = level;
    return this;
  }
  setLimits(limits) {
    this.limits = { ...limits };
    return this;
  }
  setTextures(hasTextures) {
    this.hasTextures = hasTextures;
    return this;
  }
  setWorkerLimit(workerLimit) {
    this.workerLimit = workerLimit;
    GimDecoder.useWorkers(workerLimit);
    return this;
  }
  // The decoder compiles itself when it is imported.
  preload() {
    return this;
  }

  load(url, onLoad, onProgress, onError) {
    const address = this.manager.resolveURL(this.path + url);
    this.manager.itemStart(address);
    this.read(address, this.controller.signal, {
      headers: this.requestHeader,
      credentials: this.withCredentials ? "include" : undefined,
      onProgress: ({ loaded, total }) => onProgress?.({ type: "progress", lengthComputable: total !== undefined, loaded, total }),
    }).then(
      (geometry) => {
        this.manager.itemEnd(address);
        onLoad?.(geometry);
      },
      (error) => {
        if (onError) onError(error);
        else console.error(error);
        this.manager.itemError(address);
        this.manager.itemEnd(address);
      },
    );
  }
  parse(bytes, onLoad, onError = () => {}) {
    this.parseAsync(bytes).then(onLoad).catch(onError);
  }
  parseAsync(bytes) {
    return this.read(bytes, this.controller.signal, {});
  }
  abort() {
    this.controller.abort();
    this.controller = new AbortController();
    return this;
  }
  dispose() {
    this.abort();
    if (this.workerLimit > 0) GimDecoder.useWorkers(0);
    return this;
  }

  async read(input, signal, options) {
    const source = await GimSource.open(input, { ...options, signal, limits: this.limits });
    try {
      return await this.build(source, signal);
    } finally {
      source.close();
    }
  }
  async build(source, signal) {
    const how = { ...this.limits, signal };
    const planes = this.hasTextures ? planesOf(source.chunks) : [];
    const level = Math.min(this.level, source.levelCount - 1);
    const ends = [source.level(level, { signal }), ...planes.map((plane) => source.plane(plane, { signal }))];
    let bytes = (await Promise.all(ends))[0];
    const kind = planes.length > 0 ? "grid" : "hardMesh";
    const images = survey(source.bytes, source.info, kind, this.limits);
    const finest = Math.min(level, ...images.map(({ coarsest }) => coarsest)); // some images have no level so coarse
    await source.level(finest, { signal });
    bytes = source.bytes;
    const geometry = makeGeometry(await decodeParts(bytes, images, level, kind, how), source.info, level);
    if (planes.length > 0) geometry.userData.textures = await decodeTextures(bytes, source.info, source.chunks, how);
    return geometry;
  }
}
