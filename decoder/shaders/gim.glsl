// What the GLSL shaders share: the buffers, a sample's place, how fine a patch is drawn. README.md describes the buffers.
// It stands in for the line `#include "gim.glsl"` of the others.

struct Domain {
    uint first_sample;  // in positions
    uint width;         // samples in a row of the image
    uint slot;          // samples from one tile to the next in a row or column; all samples of a row if the image is one square
    uint unused;
    vec2 map_origin;    // of sample (0, 0) in the normal map, in texture coordinates
    vec2 map_slot;      // from one tile to the next
    vec2 map_interval;  // from one sample to the next inside a tile
    vec2 unused2;
};

struct Instance {
    mat4 transform;  // from object to world: rotation, uniform scale, translation
    vec4 ball;       // around the instance, in the world: centre and radius
    uint domain;
    uint extra;      // every cell is halved so often, as far as there are samples
    float error;     // of the patches, in the world; 0: the screen has no say
    uint unused;
};

struct Patch {
    uvec2 corner;   // column and row of its first sample
    uint side;      // 2^side intervals along a side
    uint inside;    // 2^inside cells along a side
    uint finer;     // borders with twice as many edges: 1 first row, 2 last column, 4 last row, 8 first column
    uint instance;
};

layout(std140, binding = 0) uniform View {
    mat4 world_to_clip;  // depth 0..1
    vec4 eye;            // in the world; w: pixels that a unit has at distance 1, over the pixels that an error may have
    vec4 light;          // unit vector towards the light; w: ambient part
    vec4 front;          // colours of the two faces
    vec4 back;
    uint patch_count;
    uint capacity;       // triangles that there is room for
};
layout(std430, binding = 0) readonly buffer Patches { uvec2 patch_words[]; };  // gim_patch, little-endian
layout(std430, binding = 1) readonly buffer PatchInstances { uint patch_instances[]; };
layout(std430, binding = 2) readonly buffer Instances { Instance instances[]; };
layout(std430, binding = 3) readonly buffer Domains { Domain domains[]; };
layout(std430, binding = 4) readonly buffer Positions { float positions[]; };

const uint kMostFromScreen = 2;

vec3 position_at(Domain domain, uvec2 at) {
    uint i = 3 * (domain.first_sample + at.y * domain.width + at.x);
    return vec3(positions[i], positions[i + 1], positions[i + 2]);
}

vec2 map_place(Domain domain, uvec2 at) {
    return domain.map_origin + vec2(at / domain.slot) * domain.map_slot + vec2(at % domain.slot) * domain.map_interval;
}

// Each halving leaves about a quarter of the error of a smooth surface. All patches of an instance get the same answer,
// so neighbours agree.
uint extra_of(Instance instance) {
    if (instance.error <= 0) return instance.extra;
    float distance_left = max(distance(eye.xyz, instance.ball.xyz) - instance.ball.w, 1e-6);
    float too_large = instance.error * eye.w / distance_left;
    uint wanted = too_large > 1 ? uint(ceil(0.5 * log2(too_large))) : 0;
    return instance.extra + min(wanted, kMostFromScreen);
}

// A patch as it is drawn: finer by what its instance wants, as far as there are samples.
Patch patch_at(uint number) {
    uint first = patch_words[number].x, second = patch_words[number].y;
    Patch p = Patch(uvec2(first & 0xffffu, first >> 16), second & 0xffu, second >> 8 & 0xffu, second >> 16 & 0xffu,
                    patch_instances[number]);
    p.inside += min(extra_of(instances[p.instance]), p.side - p.inside);
    // Cells of one interval have no vertex to spare within a border. Their neighbours have no finer cells either.
    if (p.inside == p.side) p.finer = 0;
    return p;
}
