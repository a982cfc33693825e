// Files that are fetched as far as they are wanted. source.d.ts describes it.
export { GimGlb } from "./source_glb.js";
export { GimSource } from "./source_levels.js";
export { GimSourceError } from "./source_error.js";
