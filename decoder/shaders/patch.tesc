// Patches to tessellation levels: Maximo, Velho, Siqueira 2013, section 4.4. glDrawArrays(GL_PATCHES, 0, patch_count) with
// one vertex a patch. No border has more than 64 edges (README.md).
#version 450
layout(vertices = 1) out;
#include "gim.glsl"

flat in uint patch_number[];
patch out uvec4 square;  // column, row, side, instance

float edges(Patch p, uint border) { return float(1u << (p.inside + (p.finer >> border & 1))); }

void main() {
    Patch p = patch_at(patch_number[0]);
    square = uvec4(p.corner, p.side, p.instance);
    gl_TessLevelInner[0] = gl_TessLevelInner[1] = float(1u << p.inside);
    gl_TessLevelOuter[0] = edges(p, 3);  // u = 0: first column
    gl_TessLevelOuter[1] = edges(p, 0);  // v = 0: first row
    gl_TessLevelOuter[2] = edges(p, 1);
    gl_TessLevelOuter[3] = edges(p, 2);
}
