// Patches to triangles, for WebGPU; expand.comp and gim.glsl in one. One workgroup takes one patch. A triangle is its three
// samples (row << 16 | column) and its instance. drawIndirect with surface.wgsl then draws all of them.
struct View {
    world_to_clip: mat4x4f,  // depth 0..1
    eye: vec4f,              // in the world; w: pixels that a unit has at distance 1, over the pixels that an error may have
    light: vec4f,
    front: vec4f,
    back: vec4f,
    patch_count: u32,
    capacity: u32,           // triangles that there is room for
}
struct Domain {
    first_sample: u32,  // in positions
    width: u32,         // samples in a row of the image
    slot: u32,          // samples from one tile to the next in a row or column
    unused: u32,
    map_origin: vec2f,
    map_slot: vec2f,
    map_interval: vec2f,
    unused2: vec2f,
}
struct Instance {
    transform: mat4x4f,
    ball: vec4f,        // around the instance, in the world: centre and radius
    domain: u32,
    extra: u32,         // every cell is halved so often, as far as there are samples
    error: f32,         // of the patches, in the world; 0: the screen has no say
    unused: u32,
}
struct Draw {
    vertex_count: atomic<u32>,  // begins with 0
    instance_count: u32,        // 1
    first_vertex: u32,          // 0
    first_instance: u32,        // 0
    needed: atomic<u32>,        // triangles, also those without room; begins with 0
}

@group(0) @binding(0) var<uniform> view: View;
@group(0) @binding(1) var<storage> patches: array<vec2u>;  // gim_patch, little-endian
@group(0) @binding(2) var<storage> patch_instances: array<u32>;
@group(0) @binding(3) var<storage> instances: array<Instance>;
@group(0) @binding(4) var<storage> domains: array<Domain>;
@group(0) @binding(5) var<storage> positions: array<f32>;
@group(0) @binding(6) var<storage, read_write> triangles: array<vec4u>;
@group(0) @binding(7) var<storage, read_write> draw: Draw;

var<workgroup> next: atomic<u32>;  // the place of the next triangle

const most_from_screen = 2u;

fn position_at(d: u32, at: vec2u) -> vec3f {
    let i = 3 * (domains[d].first_sample + at.y * domains[d].width + at.x);
    return vec3f(positions[i], positions[i + 1], positions[i + 2]);
}

// Each halving leaves about a quarter of the error of a smooth surface. All patches of an instance get the same answer.
fn extra_of(i: u32) -> u32 {
    let extra = instances[i].extra;
    if (instances[i].error <= 0) { return extra; }
    let ball = instances[i].ball;
    let too_large = instances[i].error * view.eye.w / max(distance(view.eye.xyz, ball.xyz) - ball.w, 1e-6);
    if (too_large <= 1) { return extra; }
    return extra + min(u32(ceil(0.5 * log2(too_large))), most_from_screen);
}

// Every cell has two triangles. Cells with finer borders have a fan: four, and one more for each finer border.
fn triangle_count(cells: u32, finer: u32) -> u32 {
    let borders = countOneBits(finer);
    let next_border = ((finer >> 1) | (finer << 3)) & 15u;
    let fans = select(borders * cells - countOneBits(finer & next_border), min(borders, 1u), cells == 1);
    return 2 * cells * cells + 2 * fans + borders * cells;
}

fn write_triangle(place: u32, a: vec2u, b: vec2u, c: vec2u, instance: u32) {
    if (place >= view.capacity) { return; }
    triangles[place] = vec4u((vec3u(a.y, b.y, c.y) << vec3u(16)) | vec3u(a.x, b.x, c.x), instance);
}

// Whether a cell is split from its first corner, as gim_decode_mesh does it: a cell at a corner of a tile through that
// corner, others along the shorter diagonal.
fn is_split_from_first(corner: array<vec2u, 4>, d: u32) -> bool {
    let low = corner[0] % domains[d].slot;
    let is_low = low == vec2u(0);
    let is_high = corner[2] - corner[0] + low == vec2u(domains[d].slot - 1);
    if ((is_low.x || is_high.x) && (is_low.y || is_high.y)) { return is_low.x == is_low.y; }
    let main = position_at(d, corner[0]) - position_at(d, corner[2]);
    let anti = position_at(d, corner[1]) - position_at(d, corner[3]);
    return dot(main, main) <= dot(anti, anti);
}

// Two triangles. Corners run counter-clockwise seen from outside.
fn write_quad(corners: array<vec2u, 4>, instance: u32) {
    var corner = corners;
    let shift = select(1u, 0u, is_split_from_first(corner, instances[instance].domain));
    let place = atomicAdd(&next, 2u);
    write_triangle(place, corner[shift], corner[shift + 1], corner[shift + 2], instance);
    write_triangle(place + 1, corner[shift], corner[shift + 2], corner[(shift + 3) & 3], instance);
}

// Triangles around the sample in the centre, two at a finer border.
fn write_fan(corners: array<vec2u, 4>, finer: u32, instance: u32) {
    var corner = corners;
    var place = atomicAdd(&next, 4 + countOneBits(finer));
    let centre = (corner[0] + corner[2]) / 2;
    for (var border = 0u; border < 4; border++) {
        var start = corner[border];
        let end = corner[(border + 1) & 3];
        if (extractBits(finer, border, 1) != 0) {
            let middle = (start + end) / 2;
            write_triangle(place, start, middle, centre, instance);
            start = middle;
            place++;
        }
        write_triangle(place, start, end, centre, instance);
        place++;
    }
}

@compute @workgroup_size(64)
fn expand(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u,
          @builtin(local_invocation_index) lane: u32) {
    let number = group.y * groups.x + group.x;
    if (number >= view.patch_count) { return; }
    let words = patches[number];
    let first = vec2u(words.x & 0xffff, words.x >> 16);
    let side = words.y & 0xff;
    let instance = patch_instances[number];
    let coarse = extractBits(words.y, 8, 8);
    let inside = coarse + min(extra_of(instance), side - coarse);
    // Cells of one interval have no vertex to spare within a border. Their neighbours have no finer cells either.
    let finer = select(extractBits(words.y, 16, 8), 0u, inside == side);
    let cells = 1u << inside;
    let interval = 1u << (side - inside);
    if (lane == 0) {
        let count = triangle_count(cells, finer);
        let place = atomicAdd(&draw.needed, count);
        atomicStore(&next, place);
        atomicMax(&draw.vertex_count, 3 * min(place + count, view.capacity));
    }
    workgroupBarrier();
    for (var cell = lane; cell < cells * cells; cell += 64) {
        let at = vec2u(cell & (cells - 1), cell >> inside);
        let is_at = select(0u, 1u, at.y == 0) | select(0u, 2u, at.x == cells - 1) | select(0u, 4u, at.y == cells - 1) |
                    select(0u, 8u, at.x == 0);
        let low = first + at * interval;
        let high = low + interval;
        let corner = array(low, vec2u(high.x, low.y), high, vec2u(low.x, high.y));
        if ((finer & is_at) != 0) { write_fan(corner, finer & is_at, instance); } else { write_quad(corner, instance); }
    }
}
