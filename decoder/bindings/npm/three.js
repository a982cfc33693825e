// Meshes of .gim files in three.js. three.d.ts describes it.
export { GIMBudget } from "./three_budget.js";
export { GIMGLTFExtension } from "./three_gltf.js";
export { GIMLoader } from "./three_loader.js";
export { GIMMesh } from "./three_mesh.js";
export { planeTexture, texturedMaterial } from "./three_texture.js";
