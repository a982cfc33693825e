// Patches to triangles. One workgroup takes one patch. A triangle is its three samples (row << 16 | column) and its
// instance. The command in binding 6 then draws all of them: glDrawArraysIndirect with surface.vert.
#version 450
layout(local_size_x = 64) in;
#include "gim.glsl"

layout(std430, binding = 5) writeonly buffer Triangles { uvec4 triangles[]; };
layout(std430, binding = 6) buffer Draw {
    uint vertex_count;  // begins with 0
    uint instance_count, first_vertex, first_instance;  // 1, 0, 0
    uint needed;  // triangles, also those without room; begins with 0
};

shared uint next;  // the place of the next triangle

// Every cell has two triangles. Cells with finer borders have a fan: four, and one more for each finer border.
uint triangle_count(uint cells, uint finer) {
    uint borders = bitCount(finer);
    uint next_border = (finer >> 1 | finer << 3) & 15u;
    uint fans = cells == 1 ? min(borders, 1u) : borders * cells - bitCount(finer & next_border);
    return 2 * cells * cells + 2 * fans + borders * cells;
}

void write_triangle(uint place, uvec2 a, uvec2 b, uvec2 c, uint instance) {
    if (place >= capacity) return;
    triangles[place] = uvec4(a.y << 16 | a.x, b.y << 16 | b.x, c.y << 16 | c.x, instance);
}

// Whether a cell is split from its first corner, as gim_decode_mesh does it: a cell at a corner of a tile through that
// corner, others along the shorter diagonal.
bool is_split_from_first(uvec2 corner[4], Domain domain) {
    uvec2 low = corner[0] % domain.slot, high = corner[2] - corner[0] + low;
    bvec2 is_low = equal(low, uvec2(0)), is_high = equal(high, uvec2(domain.slot - 1));
    if ((is_low.x || is_high.x) && (is_low.y || is_high.y)) return is_low.x == is_low.y;
    vec3 main = position_at(domain, corner[0]) - position_at(domain, corner[2]);
    vec3 anti = position_at(domain, corner[1]) - position_at(domain, corner[3]);
    return dot(main, main) <= dot(anti, anti);
}

// Two triangles. Corners run counter-clockwise seen from outside.
void write_quad(uvec2 corner[4], Domain domain, uint instance) {
    uint shift = is_split_from_first(corner, domain) ? 0 : 1;
    uint place = atomicAdd(next, 2);
    write_triangle(place, corner[shift], corner[shift + 1], corner[shift + 2], instance);
    write_triangle(place + 1, corner[shift], corner[shift + 2], corner[(shift + 3) & 3], instance);
}

// Triangles around the sample in the centre, two at a finer border.
void write_fan(uvec2 corner[4], uint finer, uint instance) {
    uint place = atomicAdd(next, 4 + bitCount(finer));
    uvec2 centre = (corner[0] + corner[2]) / 2;
    for (uint border = 0; border < 4; ++border) {
        uvec2 from = corner[border], to = corner[(border + 1) & 3];
        if ((finer >> border & 1) != 0) {
            uvec2 middle = (from + to) / 2;
            write_triangle(place++, from, middle, centre, instance);
            from = middle;
        }
        write_triangle(place++, from, to, centre, instance);
    }
}

void main() {
    uint number = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (number >= patch_count) return;
    Patch p = patch_at(number);
    uint cells = 1u << p.inside;
    uint interval = 1u << (p.side - p.inside);
    if (gl_LocalInvocationIndex == 0) {
        uint count = triangle_count(cells, p.finer);
        next = atomicAdd(needed, count);
        atomicMax(vertex_count, 3 * min(next + count, capacity));
    }
    barrier();
    Domain domain = domains[instances[p.instance].domain];
    for (uint cell = gl_LocalInvocationIndex; cell < cells * cells; cell += gl_WorkGroupSize.x) {
        uvec2 at = uvec2(cell & (cells - 1), cell >> p.inside);
        uint is_at = uint(at.y == 0) | uint(at.x == cells - 1) << 1 | uint(at.y == cells - 1) << 2 | uint(at.x == 0) << 3;
        uvec2 low = p.corner + at * interval, high = low + interval;
        uvec2 corner[4] = uvec2[4](low, uvec2(high.x, low.y), high, uvec2(low.x, high.y));
        if ((p.finer & is_at) != 0)
            write_fan(corner, p.finer & is_at, p.instance);
        else
            write_quad(corner, domain, p.instance);
    }
}
