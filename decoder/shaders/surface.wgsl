// Draws the triangles that expand.wgsl wrote, lit by a normal map; surface.vert and surface.frag in one. Bindings and
// structs as in expand.wgsl.

struct View {
    world_to_clip: mat4x4f,
    eye: vec4f,
    light: vec4f,  // unit vector towards the light; w: ambient part
    front: vec4f,  // colours of the two faces
    back: vec4f,
    patch_count: u32,
    capacity: u32,
}
struct Domain {
    first_sample: u32,
    width: u32,
    slot: u32,
    unused: u32,
    map_origin: vec2f,    // of sample (0, 0) in the normal map, in texture coordinates
    map_slot: vec2f,      // from one tile to the next
    map_interval: vec2f,  // from one sample to the next inside a tile
    unused2: vec2f,
}
struct Instance {
    transform: mat4x4f,  // from object to world: rotation, uniform scale, translation
    ball: vec4f,
    domain: u32,
    extra: u32,
    error: f32,
    unused: u32,
}

@group(0) @binding(0) var<uniform> view: View;
@group(0) @binding(3) var<storage> instances: array<Instance>;
@group(0) @binding(4) var<storage> domains: array<Domain>;
@group(0) @binding(5) var<storage> positions: array<f32>;
@group(0) @binding(6) var<storage> triangles: array<vec4u>;
@group(0) @binding(8) var normal_map: texture_2d<f32>;
@group(0) @binding(9) var linear: sampler;

struct Corner {
    @builtin(position) clip: vec4f,
    @location(0) map_at: vec2f,
    @location(1) @interpolate(flat) instance: u32,
}

@vertex
fn place(@builtin(vertex_index) number: u32) -> Corner {
    var triangle = triangles[number / 3];
    let at = vec2u(triangle[number % 3] & 0xffff, triangle[number % 3] >> 16);
    let d = domains[instances[triangle.w].domain];
    let i = 3 * (d.first_sample + at.y * d.width + at.x);
    let position = vec4f(positions[i], positions[i + 1], positions[i + 2], 1);
    var corner: Corner;
    corner.clip = view.world_to_clip * (instances[triangle.w].transform * position);
    corner.map_at = d.map_origin + vec2f(at / d.slot) * d.map_slot + vec2f(at % d.slot) * d.map_interval;
    corner.instance = triangle.w;
    return corner;
}

@fragment
fn shade(corner: Corner, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    let mapped = vec4f(textureSample(normal_map, linear, corner.map_at).xyz, 0);
    let turned = (instances[corner.instance].transform * mapped).xyz;
    let normal = turned * inverseSqrt(max(dot(turned, turned), 1e-12));
    let shade = view.light.w + (1 - view.light.w) * max(dot(normal, view.light.xyz), 0);
    if (!is_front) { return view.back; }
    return vec4f(view.front.rgb * shade, 1);
}
