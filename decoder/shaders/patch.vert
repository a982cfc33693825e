// Patches have no vertices: patch.tesc reads the records by their numbers.
#version 450
flat out uint patch_number;
void main() { patch_number = uint(gl_VertexID); }
