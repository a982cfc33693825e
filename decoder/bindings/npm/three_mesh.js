// A mesh that shows the level of a .gim file that its place on the screen needs.
import { BufferGeometry, Mesh, MeshStandardMaterial } from "three";
import { bytesOfGeometry, decodeParts, makeGeometry, survey } from "./three_geometry.js";
import { withLevels } from "./three_levels.js";
import { bytesOfTextures, decodeTextures, disposeTextures, planesOf, texturedMaterial } from "./three_texture.js";

export class GIMMesh extends withLevels(Mesh) {
  constructor(input, material = new MeshStandardMaterial(), options = {}) {
    super(new BufferGeometry(), material);
    const { pixelError, level, budget, textures = true, ...ofSource } = options;
    this.type = "GIMMesh";
    this.hasTextures = textures;
    this.textures = null;
    this.setOptions(options);
    this.open(input, ofSource).then(() => this.wantFirst()).catch((error) => this.fail(error));
  }

  get triangleCount() {
    return (this.geometry.index?.count ?? 0) / 3;
  }
  get geometryBytes() {
    return bytesOfGeometry(this.geometry);
  }
  get otherBytes() {
    return bytesOfTextures(this.textures);
  }
  onBeforeRender(renderer, scene, camera) {
    if (!this.budget) this.update(camera, renderer);
  }
  shownBox() {
    return this.geometry.boundingBox;
  }

  survey() {
    const { bytes, info, chunks } = this.source;
    this.kind = this.hasTextures && planesOf(chunks).length > 0 ? "grid" : "hardMesh";
    return survey(bytes, info, this.kind, this.limits);
  }
  async make(bytes, images, level, how) {
    return makeGeometry(await decodeParts(bytes, images, level, this.kind, how), this.source.info, level);
  }
  show(geometry) {
    const old = this.geometry;
    this.geometry = geometry ?? new BufferGeometry();
    old.dispose();
  }

  complete() {
    return this.kind !== "grid" || this.textures !== null || this.addTextures();
  }
  async addTextures() {
    const { source } = this, { signal } = this.controller;
    if (this.budget && !this.budget.hasRoom(this, this.sizeOfTextures(), this.level)) return false;
    await Promise.all(planesOf(source.chunks).map((plane) => source.plane(plane, { signal })));
    const textures = await decodeTextures(source.bytes, source.info, source.chunks, { ...this.limits, signal });
    if (this.isDisposed) {
      disposeTextures(textures);
      return true;
    }
    this.textures = textures;
    this.plainMaterial = this.material;
    this.material = texturedMaterial(textures, this.plainMaterial);
    this.dispatchEvent({ type: "textures" });
    return true;
  }
  // Bytes of the planes' chunks and of eight per sample of the finest level; planes are rarely larger than that.
  sizeOfTextures() {
    const samples = this.images.reduce((sum, { levels }) => sum + levels[0].vertices, 0);
    return this.source.info.fileSize - this.source.bytes.length + 8 * samples;
  }

  release() {
    this.geometry.dispose();
    disposeTextures(this.textures);
    if (this.textures) [].concat(this.material).forEach((material) => material.dispose());
  }
}
