// Pulls the samples of triangles that expand.comp wrote.
#version 450
#include "gim.glsl"

layout(std430, binding = 5) readonly buffer Triangles { uvec4 triangles[]; };

out vec2 map_at;
flat out uint instance_number;

void main() {
    uvec4 triangle = triangles[gl_VertexID / 3];
    uint row_and_column = triangle[gl_VertexID % 3];
    uvec2 at = uvec2(row_and_column & 0xffffu, row_and_column >> 16);
    Instance instance = instances[triangle.w];
    Domain domain = domains[instance.domain];
    map_at = map_place(domain, at);
    instance_number = triangle.w;
    gl_Position = world_to_clip * (instance.transform * vec4(position_at(domain, at), 1));
}
