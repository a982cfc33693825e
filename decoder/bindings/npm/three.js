// Meshes of .gim files in three.js. three.d.ts describes it.
export { GIMBudget } from "./three_budget.js";
export { GIMGLTFExtension, loadGIMScene } from "./three_gltf.js";
export { GIMGLTFMesh } from "./three_gltf_mesh.js";
export { GIMLoader } from "./three_loader.js";
export { GIMMesh } from "./three_mesh.js";
export { planeTexture, texturedMaterial } from "./three_texture.js";
