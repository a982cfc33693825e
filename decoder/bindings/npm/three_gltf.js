// EXT_gim_geometry for GLTFLoader: meshes whose geometry is a .gim file in a buffer view.
import { DoubleSide, Group, LoaderUtils, Mesh, MeshStandardMaterial } from "three";
import { GimDecoder } from "gim/decoder";
import { GimGlb, GimSource } from "gim/source";
import { survey } from "./three_geometry.js";
import { decodeImages, extensionName, makeGeometries, shapeOf } from "./three_gltf_arrays.js";
import { GIMGLTFMesh } from "./three_gltf_mesh.js";

const isGim = (primitive) => primitive.extensions?.[extensionName] !== undefined;
const viewOf = (primitive) => primitive.extensions[extensionName].bufferView;

export class GIMGLTFExtension {
  // parser: of GLTFLoader. options: {level, limits}, or with source, a GimGlb: those of GIMGLTFMesh.
  constructor(parser, { source = null, ...options } = {}) {
    this.parser = parser;
    this.name = extensionName;
    this.glb = source;
    this.options = options;
    this.sources = new Map(); // promises of GimSources, by buffer view
    this.meshes = new Set(); // that refine
    this.materials = []; // promises
  }

  // ---- hooks of GLTFLoader ------------------------------------------------------------------------------------------

  beforeRoot() {
    if (!this.glb) return;
    const { parser, glb } = this;
    // Who wants the whole BIN chunk gets it from here.
    parser.extensions.KHR_binary_glTF ??= { get body() { return glb.read(0, glb.binSize).then(bufferOf); } };
    for (const { primitives } of parser.json.meshes ?? [])
      for (const primitive of primitives.filter(isGim)) this.sourceOf(viewOf(primitive)).catch(() => {}); // all in one turn
  }
  loadBufferView(index) {
    const view = this.parser.json.bufferViews[index];
    return this.isInGlb(view) ? this.glb.read(view.byteOffset ?? 0, view.byteLength).then(bufferOf) : null;
  }
  // Null: a mesh without the extension, which GLTFLoader loads.
  loadMesh(index) {
    const mesh = this.parser.json.meshes[index];
    return mesh.primitives.some(isGim) ? this.makeMesh(index, mesh) : null;
  }
  async afterRoot(result) {
    if (!this.glb) return;
    // Nodes that share a mesh have clones of it, and it itself is in no scene.
    const rootOf = (object) => (object.parent ? rootOf(object.parent) : object);
    for (const mesh of [...this.meshes]) if (!result.scenes.includes(rootOf(mesh))) mesh.dispose();
    await Promise.all([...this.meshes].map((mesh) => mesh.first));
    result.gim = new GIMScene(this);
  }

  // ---- meshes -------------------------------------------------------------------------------------------------------

  async makeMesh(index, definition) {
    const { parser } = this, { primitives } = definition;
    await GimDecoder.ready;
    const title = parser.createUniqueName(definition.name || `mesh_${index}`);
    const note = (part, i) => {
      part.name = title;
      Object.assign(part.userData, definition.extras);
      parser.associations.set(part, { meshes: index, primitives: i });
    };
    const views = [...new Set(primitives.filter(isGim).map(viewOf))];
    const ofView = (view) => primitives.filter((primitive) => isGim(primitive) && viewOf(primitive) === view);
    const made = await Promise.all([
      ...views.map((view) => (this.glb ? this.makeRefined(view, ofView(view)) : this.makeWhole(view, ofView(view)))),
      ...primitives.filter((primitive) => !isGim(primitive)).map((primitive) => this.makePlain(primitive)),
    ]);
    const parts = made.flatMap((one) => one.parts).map(({ part, primitive }) => ({ part, i: primitives.indexOf(primitive) }));
    for (const { part, i } of parts.sort((a, b) => a.i - b.i)) note(part, i);
    const objects = this.glb ? made.flatMap((one) => one.objects) : parts.map(({ part }) => part);
    if (objects.length === 1 && objects[0].isMesh) return objects[0];
    const group = objects.length === 1 ? objects[0] : new Group().add(...objects);
    group.name = title;
    Object.assign(group.userData, definition.extras);
    parser.associations.set(group, { meshes: index });
    return group;
  }
  // All of these give {objects, parts: [{part, primitive}]}: what is put into the scene, and the mesh of each primitive.
  async makePlain(primitive) {
    const material = await this.materialOf(primitive);
    const part = new Mesh((await this.parser.loadGeometries([primitive]))[0], material);
    this.parser.assignFinalMaterial(part);
    return { objects: [part], parts: [{ part, primitive }] };
  }
  async makeWhole(view, primitives) {
    const bytes = new Uint8Array(await this.parser.getDependency("bufferView", view)), { level = 0, limits } = this.options;
    const shapes = primitives.map(shapeOf), info = GimDecoder.info(bytes, limits);
    const images = survey(bytes, info, "grid", limits);
    const geometries = makeGeometries(await decodeImages(bytes, bytes, images, level, shapes, { ...limits }), shapes, info);
    const materials = await Promise.all(primitives.map((primitive) => this.materialOf(primitive)));
    const parts = primitives.map((primitive, i) => ({ part: new Mesh(geometries[i], materials[i]), primitive }));
    for (const { part } of parts) this.parser.assignFinalMaterial(part);
    return { objects: parts.map(({ part }) => part), parts };
  }
  async makeRefined(view, primitives) {
    const source = await this.sourceOf(view), ofLabels = this.labelsOf(view, source, primitives);
    ofLabels.catch(() => {}); // the mesh hears of it
    const mesh = new GIMGLTFMesh({
      source, ofLabels, primitives: primitives.map(shapeOf), meshes: this.meshes,
      placeholders: primitives.map((primitive) => this.placeholderOf(primitive)),
      materials: () => primitives.map((primitive) => this.materialOf(primitive)),
      finishMaterial: (part) => this.parser.assignFinalMaterial(part),
    }, this.options);
    await mesh.first;
    this.materials.push(mesh.dressed);
    if (!primitives.some((primitive) => this.hasPictures(primitive))) await mesh.dressed;
    return { objects: [mesh], parts: primitives.map((primitive, i) => ({ part: mesh.parts[i], primitive })) };
  }

  // ---- materials ----------------------------------------------------------------------------------------------------

  async materialOf({ material }) {
    return material === undefined ? new MeshStandardMaterial() : this.parser.getDependency("material", material);
  }
  definitionOf({ material }) {
    return this.parser.json.materials?.[material] ?? {};
  }
  hasPictures(primitive) {
    return /"index":/.test(JSON.stringify(this.definitionOf(primitive)));
  }
  // The material without its textures.
  placeholderOf(primitive) {
    const { pbrMetallicRoughness = {}, doubleSided } = this.definitionOf(primitive);
    const { baseColorFactor = [1, 1, 1, 1], metallicFactor = 1, roughnessFactor = 1 } = pbrMetallicRoughness;
    const material = new MeshStandardMaterial({ metalness: metallicFactor, roughness: roughnessFactor });
    material.color.setRGB(...baseColorFactor.slice(0, 3));
    if (doubleSided) material.side = DoubleSide;
    return material;
  }

  // ---- bytes --------------------------------------------------------------------------------------------------------

  isInGlb({ buffer }) {
    return this.glb !== null && buffer === 0 && this.parser.json.buffers[0].uri === undefined;
  }
  sourceOf(view) {
    if (!this.sources.has(view)) this.sources.set(view, this.openSource(view));
    return this.sources.get(view);
  }
  async openSource(index) {
    const view = this.parser.json.bufferViews[index], { limits } = this.options;
    if (this.isInGlb(view)) return this.glb.source(view.byteOffset ?? 0, view.byteLength, { limits });
    return GimSource.open(await this.parser.getDependency("bufferView", index), { limits });
  }
  // Labels lie behind all levels, and are wanted with the first. Returns bytes that have header, index, seams and labels.
  async labelsOf(index, source, primitives) {
    const chunk = source.chunks.find(({ name }) => name === "LABL"), isWanted = primitives.some((primitive) => shapeOf(primitive).label !== undefined);
    await source.level(source.levelCount - 1);
    const end = chunk ? chunk.offset + chunk.size : 0;
    if (!isWanted || source.bytes.length >= end) return source.bytes;
    const bytes = new Uint8Array(end), { byteOffset = 0 } = this.parser.json.bufferViews[index];
    const labels = await this.glb.read(byteOffset + chunk.offset, chunk.size);
    bytes.set(source.bytes.subarray(0, end));
    bytes.set(labels, chunk.offset);
    return bytes;
  }
}

// As an ArrayBuffer of its own.
function bufferOf(bytes) {
  return bytes.length === bytes.buffer.byteLength ? bytes.buffer : bytes.slice().buffer;
}

// What refines in a scene: `gim` of what GLTFLoader gives.
class GIMScene {
  constructor({ glb, meshes, materials }) {
    this.source = glb;
    this.meshSet = meshes;
    this.materials = Promise.all(materials).then(() => {});
    this.materials.catch(() => {}); // who awaits it hears of it
  }
  get meshes() {
    return [...this.meshSet];
  }
  dispose() {
    for (const mesh of this.meshes) mesh.dispose();
    this.source.close();
  }
}

// Loads a GLB by ranges. loader: a GLTFLoader.
export async function loadGIMScene(input, loader, options = {}) {
  const isAddress = typeof input === "string", address = isAddress ? loader.manager.resolveURL(loader.path + input) : input;
  const { level, limits, pixelError, budget, ...ofSource } = options;
  const own = { headers: loader.requestHeader, credentials: loader.withCredentials ? "include" : undefined };
  if (isAddress) loader.manager.itemStart(address);
  let glb = null;
  try {
    glb = await GimGlb.open(address, { ...own, limits, ...ofSource });
    const folder = loader.resourcePath || (isAddress ? LoaderUtils.extractUrlBase(address) : "");
    return await parse(glb, loader, folder, { level, limits, pixelError, budget, source: glb });
  } catch (error) {
    glb?.close();
    if (isAddress) loader.manager.itemError(address);
    throw error;
  } finally {
    if (isAddress) loader.manager.itemEnd(address);
  }
}
function parse(glb, loader, folder, options) {
  const register = (parser) => new GIMGLTFExtension(parser, options);
  loader.register(register);
  try {
    return loader.parseAsync(glb.json, folder);
  } finally {
    loader.unregister(register); // parsers are made at once
  }
}
