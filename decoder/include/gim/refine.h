/* gim/refine.h: a mesh that is as fine as each place needs, over a decoded image. C99 and C++.
 * Maximo, Velho, Siqueira. Adaptive Multi-chart and Multiresolution Mesh Representation. 2013.
 *
 * Nothing here allocates, prints, throws or keeps state of its own. The caller brings the memory.
 *
 *   gim_level_info level;      // of the finest level to refine to; positions: from gim_decode_mesh at that level
 *   gim_domain_info shape;
 *   gim_read_domain_info(&info, bytes, size, 0, 0, &shape);
 *   const gim_domain* domain;  // once per image; any number of instances share it
 *   gim_open_domain(&info, bytes, size, 0, 0, positions, malloc(shape.domain_size), shape.domain_size, scratch,
 *                   shape.scratch_size, &domain);
 *   gim_refined* mesh;         // once per instance
 *   size_t mesh_size = gim_refined_size(domain, 20000);
 *   gim_begin_refined(domain, 20000, malloc(mesh_size), mesh_size, &mesh);
 *   for (each frame) {
 *       gim_refine(mesh, &rule, 1000);
 *       gim_changes changes;
 *       gim_take_changes(mesh, &changes);  // update the index buffer
 *   }
 *
 * Vertices are those of gim_decode_mesh at the level that the domain was opened with, and keep its numbers. So one vertex
 * buffer serves all resolutions, and a refined mesh is an index buffer. It begins with two triangles for each tile. A split
 * halves the two triangles at an edge; a weld undoes it. Neighbours differ by one split at most, and every mesh on the way
 * is as watertight as the surface.
 * GIM_LAYOUT_TILES: the tiles are those of the file. GIM_LAYOUT_GIM: the tiles are the cells of the image's coarsest
 * level. Images of GIM_LAYOUT_MCGIM have none: GIM_BAD_ARGUMENT. */
#ifndef GIM_REFINE_H
#define GIM_REFINE_H

#include "gim/decoder.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct gim_domain gim_domain;
typedef struct gim_refined gim_refined;

#define GIM_NOTHING UINT32_MAX /* in place of the number of a vertex or a half-edge */

typedef struct gim_domain_info {
    uint32_t tile_count;
    uint32_t intervals;    /* along a side of a tile, 2^k. A base triangle can be split 2k times, one after the other */
    uint32_t vertex_count; /* of gim_decode_mesh at the same level */
    uint64_t most_triangles; /* of the finest mesh: 2 * tile_count * intervals^2 */
    uint64_t domain_size;    /* bytes of memory for gim_open_domain */
    uint64_t scratch_size;   /* bytes of scratch for gim_open_domain */
    uint32_t width, height;  /* of the domain's image, in samples */
} gim_domain_info;

/* level: the finest one to refine to. Reads the chunk of seams. Cost as gim_read_level_info. */
GIM_API gim_status gim_read_domain_info(const gim_info* info, const void* bytes, size_t size, uint32_t image,
                                        uint32_t level, gim_domain_info* shape);

/* Reads how the tiles are glued, and computes what each sample is worth. Cost: O(samples).
 * positions  as gim_decode_mesh wrote them for that level; they are copied
 * memory     domain_size bytes, aligned to 16 bytes; the caller's until no mesh uses the domain. Do not move it
 * scratch    scratch_size bytes, aligned to 16 bytes; only for the call
 * Threads may share a domain. */
GIM_API gim_status gim_open_domain(const gim_info* info, const void* bytes, size_t size, uint32_t image, uint32_t level,
                                   const float* positions, void* memory, size_t memory_size, void* scratch,
                                   size_t scratch_size, const gim_domain** domain);

/* ---- details ----
 * A file may hold displacements (GIM_PLANE_DISPLACEMENTS) that are finer than its samples: fine details of a part of the
 * surface. A detailed domain has the samples of that plane: those of level 0, others between them, and all of them
 * displaced. Its mesh has the fine triangles where a rule wants them, near the details, and no cracks at their rim.
 * plane_level  of the plane; its image is as fine as level 0 at least, else GIM_NO_SUCH_LEVEL
 * GIM_NO_SUCH_PLANE if the file has no displacements. Vertices are numbered as those of gim_decode_mesh would be at that
 * fineness. */
GIM_API gim_status gim_read_detailed_domain_info(const gim_info* info, const void* bytes, size_t size, uint32_t image,
                                                 uint32_t plane_level, gim_domain_info* shape);

/* As gim_open_domain.
 * positions      as gim_decode_mesh wrote them for level 0
 * displacements  as gim_decode_plane wrote them for that level of the plane
 * detailed       receives 3 floats for each of the vertex_count vertices: the vertex buffer of the domain */
GIM_API gim_status gim_open_detailed_domain(const gim_info* info, const void* bytes, size_t size, uint32_t image,
                                            uint32_t plane_level, const float* positions, const float* displacements,
                                            float* detailed, void* memory, size_t memory_size, void* scratch,
                                            size_t scratch_size, const gim_domain** domain);

/* Lays out values of vertices as the samples of the domain's image, as gim_decode_positions does: for a texture, to draw
 * patches from. components: floats a vertex. samples: domain_info's width * height * components floats; samples that no
 * tile has are NaN. Cost: O(samples). */
GIM_API void gim_lay_out_samples(const gim_domain* domain, const float* of_vertices, uint32_t components,
                                 float* samples);

/* The number of the vertex at each sample of the domain's image, row by row; GIM_NOTHING where no tile has one.
 * vertices: width * height numbers. Cost: O(samples). */
GIM_API void gim_read_sample_vertices(const gim_domain* domain, uint32_t* vertices);

/* What a vertex is worth, in object units: `error` bounds how far the mesh errs at its sample and at all samples that can
 * only come after it, along the edges that they would split, while it is missing. `radius`: a ball around its position
 * holds them all, and the edge. Base vertices have 0. vertex: below vertex_count. */
GIM_API void gim_vertex_worth(const gim_domain* domain, uint32_t vertex, float* error, float* radius);

/* Bytes of memory for a mesh of at most so many triangles; 0 if the domain has more in its base. */
GIM_API uint64_t gim_refined_size(const gim_domain* domain, uint32_t most_triangles);
/* Begins with the base. memory: gim_refined_size bytes, aligned to 16 bytes; the caller's while the mesh is used. Do not
 * move it. Cost: O(vertices of the domain). */
GIM_API gim_status gim_begin_refined(const gim_domain* domain, uint32_t most_triangles, void* memory,
                                     size_t memory_size, gim_refined** mesh);

/* The current triangles, three vertices each, counter-clockwise seen from outside. Valid until the mesh changes. */
GIM_API const uint32_t* gim_refined_triangles(const gim_refined* mesh, uint32_t* triangle_count);

/* Half-edges 3f, 3f+1, 3f+2 belong to triangle f. The first one is the one that a split of f halves. */
typedef struct gim_half_edge {
    uint32_t mate;             /* on the other side of the edge, or GIM_NOTHING on a boundary */
    uint32_t vertex;           /* where it starts */
    uint32_t tile;             /* the tile in which it lies */
    uint16_t start[2], end[2]; /* row and column in the tile, 0 .. intervals */
    uint32_t level; /* of the vertex: the number of splits that led to it, one after the other; 0 in the base */
} gim_half_edge;
/* Returns GIM_BAD_ARGUMENT if there is no such half-edge. */
GIM_API gim_status gim_read_half_edge(const gim_refined* mesh, uint32_t half_edge, gim_half_edge* read);

/* Splits a triangle and the one beyond its first half-edge. If that one is coarser, it is split before, and so on.
 * GIM_BAD_ARGUMENT if there is no such triangle or its edges are one sample long, GIM_SCRATCH_TOO_SMALL if the mesh would
 * get more triangles than it may have; then it stays as it was. Cost: O(1) for each split. */
GIM_API gim_status gim_split(gim_refined* mesh, uint32_t triangle);
/* Removes a vertex that a split added. GIM_BAD_ARGUMENT, and the mesh stays as it was, if the triangles around it are not
 * those that the split made. Cost: O(1). */
GIM_API gim_status gim_weld(gim_refined* mesh, uint32_t vertex);

/* What differs between the mesh at the last call and now. The arrays are valid until the mesh changes. */
typedef struct gim_changes {
    const uint32_t *added, *removed; /* vertices */
    uint32_t added_count, removed_count;
    const uint32_t*
        triangles; /* numbers of triangles, in no order: those below triangle_count that are new or differ */
    uint32_t changed_count;
    uint32_t triangles_before, triangle_count; /* if there are fewer now, those from triangle_count on are gone */
} gim_changes;
/* The first call after gim_begin_refined tells the whole base. Cost: O(changes). */
GIM_API void gim_take_changes(gim_refined* mesh, gim_changes* changes);

/* Returns how much a vertex is needed: above 1, it is added; below `keep` of the rule, it is removed. A vertex whose
 * neighbours in the finer mesh need it stays. error, radius: gim_vertex_worth. */
typedef float (*gim_need)(void* user, uint32_t vertex, const float* position, float error, float radius);

/* Which vertices are needed. What is 0 or NULL has no part. A vertex is needed as much as the most demanding part says, and
 * not at all where it lies outside of the regions. */
typedef struct gim_rule {
    /* Screen: the need is the error in pixels, at the nearest point of the vertex's ball, over pixel_error. */
    float pixel_error;
    float eye[3];
    float pixels_per_unit; /* of an edge of length 1 at distance 1: viewport height / (2 tan(field of view / 2)) */
    /* Object space: the need is the error over this, everywhere. */
    float object_error;
    /* Vertex by vertex. */
    gim_need need;
    void* user;
    /* Regions: balls that touch all that are set have their need; others have none. */
    float box[6];        /* lower corner, upper corner; all 0: no box */
    float sphere[4];     /* centre, radius; radius 0: no sphere */
    const float* planes; /* of a frustum: plane_count times a, b, c, d; inside is a x + b y + c z + d >= 0, and a, b, c
                               have length 1 */
    uint32_t plane_count;
    /* Hysteresis: vertices stay until their need falls below this; 0 means 0.75. At most 1. */
    float keep;
    /* Not more triangles than this, the most needed vertices first; 0: as many as the mesh may have. */
    uint32_t most_triangles;
} gim_rule;

/* Splits and welds until the mesh is as the rule wants it, or until `most_operations` were done (0: no limit). Returns
 * GIM_OK, or GIM_BAD_ARGUMENT for a rule that cannot be. done: receives whether nothing is left to do; may be NULL.
 * Cost: O(triangles), a few nanoseconds each, and O(1) for each operation. */
GIM_API gim_status gim_refine(gim_refined* mesh, const gim_rule* rule, uint32_t most_operations, uint32_t* done);

/* ---- patches, for a GPU ----
 * The mesh as squares of the image, for tessellation or for a compute shader: 8 bytes for many triangles. A patch is a
 * square of a tile whose inside is as fine everywhere, and whose borders are as fine all along. Samples are those of
 * gim_decode_positions at the level of the domain, in one texture. Neighbours put the same vertices on a border that they
 * share, so there are no cracks, however each of them draws its inside.
 * As (u, v, s, c) of Maximo et al. 2013, section 4.4. */
typedef struct gim_patch {
    uint16_t column, row; /* of its first sample, the one of the lowest column and row */
    uint8_t side;         /* 2^side intervals along each side of the patch */
    uint8_t inside;       /* 2^inside cells along each side, at most 2^side; 0: one cell, two triangles */
    uint8_t finer; /* borders with twice as many edges as cells: 1 first row, 2 last column, 4 last row, 8 first column;
                             the others have as many */
    uint8_t zero;
} gim_patch;

/* Writes the patches of the current mesh: at least as fine as its triangles, at most one split finer.
 * capacity  of patches; 2 for each triangle of the mesh are always enough
 * count     receives how many there are, also with GIM_SCRATCH_TOO_SMALL
 * patches   may be NULL if capacity is 0
 * GIM_LIMIT_EXCEEDED if the image has more than 65536 rows or columns. Cost: O(triangles). */
GIM_API gim_status gim_read_patches(const gim_refined* mesh, gim_patch* patches, uint32_t capacity, uint32_t* count);

#ifdef __cplusplus
}
#endif

#endif
