// A mesh of a glTF file that shows the level of its .gim which its place on the screen needs.
import { Group, Mesh, Sphere, Vector3 } from "three";
import { bytesOfGeometry, geometrySize, survey } from "./three_geometry.js";
import { decodeImages, joined, makeGeometries } from "./three_gltf_arrays.js";
import { none, withLevels } from "./three_levels.js";

// A group with one mesh for each primitive. Pictures come after the coarsest level. Clones share the file, and what `shape` says:
//   source                        a GimSource
//   primitives                    of shapeOf()
//   ofLabels                      a promise of the bytes that hold the labels
//   placeholders                  for each primitive: what it wears at first
//   materials()                   returns a promise of its material for each primitive
//   finishMaterial(mesh)          makes the material fit the geometry
//   meshes                        a set of all that are not disposed of
export class GIMGLTFMesh extends withLevels(Group) {
  constructor(shape, options) {
    super();
    this.type = "GIMGLTFMesh";
    this.shape = shape;
    this.options = options;
    this.hasMaterials = false;
    this.setOptions(options);
    this.parts = shape.primitives.map((primitive, i) => this.makePart(primitive, i));
    this.add(...this.parts);
    shape.meshes.add(this);
    this.first = this.begin(); // resolves when the coarsest level is shown
    this.first.catch((error) => this.error || this.fail(error));
  }
  makePart(primitive, i) {
    const part = new Mesh(joined([], primitive), this.shape.placeholders[i]);
    part.onBeforeRender = (renderer, scene, camera) => this.budget || this.update(camera, renderer);
    return part;
  }
  async begin() {
    const { shape } = this;
    await this.open(shape.source, {});
    this.ofLabels = await shape.ofLabels;
    if (this.isDisposed) return;
    this.want(this.source.levelCount - 1);
    await this.working;
    if (this.error) throw this.error;
    const worn = shape.materials().map(async (material, i) => this.wear(i, await material));
    this.dressed = Promise.all(worn).then(() => this.noteMaterials());
    this.dressed.catch((error) => this.fail(error));
    this.wantFirst();
  }
  wear(i, material) {
    const part = this.parts[i];
    part.material = material;
    this.shape.finishMaterial(part);
  }
  noteMaterials() {
    this.hasMaterials = true;
    if (this.isDisposed) return;
    this.dispatchEvent({ type: "textures" });
    if (this.wanted !== none) this.want(this.wanted);
  }

  get triangleCount() {
    return this.parts.reduce((sum, { geometry }) => sum + geometry.index.count / 3, 0);
  }
  get geometryBytes() {
    return this.parts.reduce((sum, { geometry }) => sum + bytesOfGeometry(geometry), 0);
  }
  // Of labels that came before what lies in front of them.
  get otherBytes() {
    return this.ofLabels && this.ofLabels.buffer !== this.source?.bytes.buffer ? this.ofLabels.length : 0;
  }
  sizeOf(level) {
    const hasTangents = this.shape.primitives.some((primitive) => primitive.hasTangents);
    return geometrySize(this.images, level) * (hasTangents ? 1.5 : 1);
  }
  place(box) {
    const { isRelative, origin } = this.source.info;
    return box && isRelative ? box.translate(new Vector3(...origin)) : box;
  }
  shownBox() {
    const boxes = this.parts.map(({ geometry }) => geometry.boundingBox).filter((box) => box && !box.isEmpty());
    return boxes.length > 0 ? boxes.reduce((all, box) => all.union(box), boxes[0].clone()) : null;
  }

  survey() {
    const isTextured = this.shape.primitives.some((primitive) => primitive.isTextured);
    return survey(this.source.bytes, this.source.info, isTextured ? "grid" : "hardMesh", this.limits);
  }
  async make(bytes, images, level, how) {
    const { primitives } = this.shape;
    return makeGeometries(await decodeImages(bytes, this.ofLabels, images, level, primitives, how), primitives, this.source.info);
  }
  show(geometries) {
    this.parts.forEach((part, i) => {
      const old = part.geometry;
      part.geometry = geometries ? geometries[i] : joined([], this.shape.primitives[i]);
      this.setBounds(part.geometry);
      old.dispose();
    });
  }
  // The file's box holds all levels. Else each level has its own.
  setBounds(geometry) {
    if (this.box) {
      geometry.boundingBox = this.box.clone();
      geometry.boundingSphere = this.box.getBoundingSphere(new Sphere());
    } else {
      geometry.computeBoundingBox();
      geometry.boundingSphere = geometry.boundingBox.getBoundingSphere(new Sphere());
    }
  }
  // Textures come by themselves: levels do not wait for them.
  complete() {
    return this.hasMaterials;
  }

  // Another one, with a level of its own.
  clone() {
    const made = new GIMGLTFMesh(this.shape, this.options).copy(this, false);
    this.parts.forEach((part, i) => {
      const { geometry } = made.parts[i];
      made.parts[i].copy(part, false).geometry = geometry;
    });
    for (const child of this.children) if (!this.parts.includes(child)) made.add(child.clone());
    return made;
  }
  release() {
    this.shape.meshes.delete(this);
    for (const { geometry } of this.parts) geometry.dispose();
  }
}
