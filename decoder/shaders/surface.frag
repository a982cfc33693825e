// Lights the surface by its normal map. Backs have a colour of their own, so that holes and folds show.
#version 450
#include "gim.glsl"

layout(binding = 0) uniform sampler2D normal_map;

in vec2 map_at;
flat in uint instance_number;
out vec4 colour;

void main() {
    vec3 normal = mat3(instances[instance_number].transform) * texture(normal_map, map_at).xyz;
    normal *= inversesqrt(max(dot(normal, normal), 1e-12));
    float shade = light.w + (1 - light.w) * max(dot(normal, light.xyz), 0);
    colour = gl_FrontFacing ? vec4(front.rgb * shade, 1) : back;
}
