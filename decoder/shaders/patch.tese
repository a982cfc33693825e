// Places of the tessellator to samples. They are rounded to the grid, so that neighbours take the same sample.
#version 450
layout(quads, equal_spacing, ccw) in;
#include "gim.glsl"

patch in uvec4 square;  // column, row, side, instance

out vec2 map_at;
flat out uint instance_number;

void main() {
    uvec2 at = square.xy + uvec2(gl_TessCoord.xy * float(1u << square.z) + 0.5);
    Instance instance = instances[square.w];
    Domain domain = domains[instance.domain];
    map_at = map_place(domain, at);
    instance_number = square.w;
    gl_Position = world_to_clip * (instance.transform * vec4(position_at(domain, at), 1));
}
