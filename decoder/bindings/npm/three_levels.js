// What shows the level of a .gim file that its place on the screen needs: a part of GIMMesh and of GIMGLTFMesh.
import { GimDecoder } from "gim/decoder";
import { GimSource } from "gim/source";
import { boxOf, geometrySize, levelOf } from "./three_geometry.js";
import { viewOf } from "./three_view.js";

export const none = -1; // no level

// Base: a class of objects of three.js. What derives from this has
//   survey()           what three_geometry.js says of the images; called when the coarsest level is here
//   make(bytes, images, level, how)   returns a promise of what show() takes, of those images whose bytes are here
//   show(made, level)  shows it in place of what was shown; made null: shows nothing
//   complete()         adds what comes after the wanted level. Returns whether it is there, or a promise of that
//   shownBox()         of what is shown, or null
//   release()          lets go of what is shown and of all else
//   geometryBytes, otherBytes         bytes of memory that it holds: what is shown, all else but the file
//   triangleCount
export const withLevels = (Base) => class extends Base {
  constructor(...all) {
    super(...all);
    this.source = null;
    this.images = null; // what survey() says of them
    this.level = none; // shown
    this.wanted = none;
    this.chosen = none; // by the last update
    this.isPartial = false; // images are missing whose bytes have not come
    this.isBusy = false;
    this.isFinished = false;
    this.isDisposed = false;
    this.error = null;
    this.reserved = 0; // bytes of the geometry that is being decoded
    this.controller = new AbortController();
  }
  // options: pixelError, level, budget, limits.
  setOptions({ pixelError = 1, level = null, budget = null, limits }) {
    this.pixelError = pixelError;
    this.fixedLevel = level;
    this.limits = { ...limits };
    this.budget = budget;
    budget?.add(this);
  }

  get levelCount() {
    return this.images ? this.source.levelCount : 0;
  }
  get byteCount() {
    return (this.source?.bytes.length ?? 0) + this.geometryBytes + this.otherBytes + this.reserved;
  }
  // Bytes of a level, at most.
  sizeOf(level) {
    return geometrySize(this.images, level);
  }

  // Resolves when it is known what the file holds, and the bytes of its coarsest level are here.
  async open(input, options) {
    const { signal } = this.controller;
    this.ownsSource = !(input instanceof GimSource);
    const source = this.ownsSource ? await GimSource.open(input, { ...options, signal }) : input;
    if (this.isDisposed) return this.ownsSource && source.close();
    this.source = source;
    await source.level(source.levelCount - 1, { signal });
    this.prepare();
  }
  // The level to begin with, where no camera has been seen.
  wantFirst() {
    if (!this.budget && !this.isDisposed) this.want(Math.min(this.fixedLevel ?? Infinity, this.source.levelCount - 1));
  }
  prepare() {
    const { source } = this, { bytes, info } = source;
    this.images = this.survey();
    this.generation = source.generation;
    this.box = this.place(boxOf(info));
    this.index = bytes.slice(0, info.indexSize);
    this.chosen = none;
  }

  // From the file's coordinates to those of the object.
  place(box) {
    return box;
  }

  // ---- which level --------------------------------------------------------------------------------------------------

  // Chooses a level for a camera. viewport: a renderer, or the height of its picture in pixels.
  update(camera, viewport) {
    if (!this.images || this.error || this.isDisposed) return;
    this.guard(() => this.want(this.choose(camera, viewport)));
  }
  // Returns the level that the camera needs.
  choose(camera, viewport) {
    const last = this.source.levelCount - 1;
    if (this.fixedLevel !== null) return Math.min(this.fixedLevel, last);
    const box = this.box ?? this.shownBox();
    if (!box) return last;
    this.updateWorldMatrix(true, false);
    camera.updateWorldMatrix(true, false);
    this.view = viewOf(this, box, camera, viewport);
    const shown = this.chosen === none ? undefined : this.chosen;
    this.chosen = GimDecoder.chooseLevel(this.index, { ...this.view, pixelError: this.pixelError, shown });
    return this.chosen;
  }
  // Fixes the level; null: the camera chooses it again.
  setLevel(level) {
    this.fixedLevel = level;
    if (level !== null && this.images && !this.budget) this.want(Math.min(level, this.source.levelCount - 1));
    return this;
  }
  // level: -1 shows nothing.
  want(level) {
    if (level !== this.wanted) this.isFinished = false;
    this.wanted = level;
    if (!this.isBusy && !this.error && !this.isDone()) this.working = this.advance().catch((error) => this.fail(error));
  }
  isDone() {
    return this.level === this.wanted && !this.isPartial && this.isFinished;
  }

  // ---- how it comes -------------------------------------------------------------------------------------------------

  // Shows levels until the wanted one is shown: what is here first, each finer one as its bytes come.
  async advance() {
    this.isBusy = true;
    try {
      while (!this.isDisposed && !this.isDone()) {
        this.checkGeneration();
        // False: the budget has no room yet. Its next update asks again.
        if (!(await this.step())) return;
      }
    } finally {
      this.isBusy = false;
    }
  }
  async step() {
    if (this.level === this.wanted && !this.isPartial) return this.finish();
    if (this.wanted === none) return this.letGo();
    const next = this.nextLevel();
    return next === null ? this.waitFor() : this.decode(next);
  }
  // The level to decode next: the wanted one, or the finest on the way to it whose bytes are here. Null: none.
  nextLevel() {
    if (this.isComplete(this.wanted)) return this.wanted;
    const shown = this.level === none ? this.source.levelCount : this.level;
    for (let level = this.wanted + 1; level < shown; ++level) if (this.isComplete(level)) return level;
    const coarsest = this.source.levelCount - 1;
    return this.level === none && this.source.has(coarsest) ? coarsest : null;
  }
  endOf(level) {
    return Math.max(...this.images.map((image) => image.levels[levelOf(image, level)].end));
  }
  isComplete(level) {
    return this.source.bytes.length >= this.endOf(level);
  }
  // Asks for all levels up to the wanted one, and waits for the first of them.
  async waitFor() {
    const missing = this.endOf(this.wanted) - this.source.bytes.length;
    if (this.budget && !this.budget.hasRoom(this, missing, this.level)) return false;
    const { signal } = this.controller;
    const finest = (level) => Math.min(...this.images.map((image) => levelOf(image, level)));
    const waits = [];
    const from = this.level === none ? this.source.levelCount - 1 : this.level;
    for (let level = Math.max(from, this.wanted); level >= this.wanted; --level)
      if (!this.isComplete(level)) waits.push(this.source.level(finest(level), { signal }));
    waits.forEach((wait) => wait.catch(() => {}));
    await waits[0];
    return true;
  }
  async decode(level) {
    const { source } = this, { signal } = this.controller;
    const size = this.sizeOf(level);
    if (this.budget && !this.budget.hasRoom(this, size, level)) return false;
    this.reserved = size;
    try {
      const bytes = source.bytes;
      const here = this.images.filter((image) => image.levels[levelOf(image, level)].end <= bytes.length);
      const how = { ...this.limits, signal, atOnce: this.level === none };
      const made = await this.make(bytes, here, level, how);
      if (this.isDisposed) return false;
      this.isPartial = here.length < this.images.length;
      this.change(made, level);
    } finally {
      this.reserved = 0;
    }
    return true;
  }
  change(made, level) {
    const previous = this.level;
    this.level = level;
    this.show(made, level);
    this.dispatchEvent({ type: "levelchange", level, previous, triangles: this.triangleCount });
  }
  async finish() {
    if (this.wanted !== none && !(await this.complete())) return false;
    if (this.isDisposed || this.level !== this.wanted) return true;
    this.isFinished = true;
    this.dispatchEvent({ type: "finished", level: this.level, triangles: this.triangleCount });
    return true;
  }
  // The file was read again from its start, because it changed: nothing that is known of it holds.
  checkGeneration() {
    if (this.generation === this.source.generation) return;
    this.prepare();
    this.wanted = Math.min(this.wanted, this.source.levelCount - 1);
    this.letGo();
  }
  // Shows nothing.
  letGo() {
    this.change(null, none);
    this.isPartial = false;
    return true;
  }

  // ---- its end ------------------------------------------------------------------------------------------------------

  guard(run) {
    try {
      run();
    } catch (error) {
      this.fail(error);
    }
  }
  // Nothing is thrown to a render loop. What is shown stays.
  fail(error) {
    if (this.isDisposed) return;
    this.error = error;
    this.dispatchEvent({ type: "error", error });
  }
  dispose() {
    if (this.isDisposed) return;
    this.isDisposed = true;
    this.controller.abort();
    this.budget?.remove(this);
    this.release();
    if (this.ownsSource) this.source?.close();
  }
};
