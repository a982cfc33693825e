/* gim/clusters.h: a decoded image in clusters of triangles, with what it takes to cull them. C99 and C++.
 * After: Gu, Gortler, Hoppe. Geometry images. 2002, section 4; fields as in meshoptimizer, by Arseny Kapoulkine.
 *
 * Nothing here allocates, prints, throws or keeps state. The caller brings the memory.
 *
 *   gim_cluster_sizes sizes;  // domain: from gim_open_domain
 *   gim_read_cluster_sizes(domain, 8, &sizes);
 *   gim_cluster* clusters  = malloc(sizes.cluster_count * sizeof(gim_cluster));
 *   uint32_t*    vertices  = malloc(sizes.vertex_count * sizeof(uint32_t));
 *   uint8_t*     triangles = malloc(sizes.triangle_count * 3);
 *   gim_cluster_tree tree;
 *   gim_decode_clusters(domain, 8, clusters, vertices, triangles, malloc(sizes.scratch_size), sizes.scratch_size, &tree);
 *
 * Clusters are the nodes of a tree. Those of depth 0 are blocks of side x side cells of the image, two triangles a cell. A
 * cluster of depth d has cells of 2^d x 2^d samples, and two by two clusters below it. Where a tile has fewer cells than a
 * cluster, up to four clusters of neighbouring tiles are one. The clusters of one depth are the whole surface, as
 * watertight as it is, with the vertices of gim_decode_mesh at the level of the domain and their numbers. So one vertex
 * buffer serves all depths.
 * The depths from mesh_depth_count on have no triangles. They hold the coarsest clusters together, four by four, up to one
 * root.
 * Triangles of different depths do not meet: side by side they leave cracks. Draw one depth for an object; or use
 * gim_refine, which leaves none; or hide the cracks, with an error well below a pixel.
 * Cells are split along the shorter diagonal; those at the corners of a tile through the corner, so that no two triangles
 * share both ends of an edge. */
#ifndef GIM_CLUSTERS_H
#define GIM_CLUSTERS_H

#include "gim/refine.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Everything that is said about "all below" holds for the cluster's own triangles and for those of depth 0 below it, so
 * whoever culls a cluster may skip its whole subtree. Bounds are a little larger than they need be, so that tests in
 * binary32 do not err. Object units. */
typedef struct gim_cluster {
    float center[3], radius; /* a ball that holds all below, and the balls of the children */
    /* All below look away from the eye if dot(normalize(cone_apex - eye), cone_axis) >= cone_cutoff. Where normals differ
     * too much, the axis is 0 and the cutoff 1: never. */
    float cone_apex[3], cone_axis[3], cone_cutoff;
    /* No point of the triangles is farther from the surface of depth 0, and none of that surface below is farther from the
     * triangles. 0 in depth 0, FLT_MAX without triangles; a parent's is at least its children's. */
    float error;
    float parent_error;      /* of the root: FLT_MAX */
    uint32_t parent;         /* GIM_NOTHING: this is the root */
    uint32_t first_child;    /* children follow each other; GIM_NOTHING in depth 0 */
    uint32_t child_count;    /* 1 to 4 */
    uint32_t depth;          /* 0: finest */
    uint32_t first_vertex;   /* in `vertices` */
    uint32_t vertex_count;   /* at most 130 for side 8, 34 for side 4 */
    uint32_t first_triangle; /* in `triangles`: three bytes each, from byte 3 * first_triangle on */
    uint32_t triangle_count; /* at most 128 for side 8, 32 for side 4 */
} gim_cluster;

/* What the arrays need at most, and the scratch. */
typedef struct gim_cluster_sizes {
    uint32_t cluster_count;
    uint32_t vertex_count;
    uint32_t triangle_count;
    uint64_t scratch_size; /* bytes */
} gim_cluster_sizes;

/* side: cells along a side of a cluster: 8 (81 vertices and 128 triangles in the midst of a tile) or 4 (25 and 32).
 * GIM_BAD_ARGUMENT for another side, GIM_LIMIT_EXCEEDED if a count does not fit 32 bits. Cost: O(1). */
GIM_API gim_status gim_read_cluster_sizes(const gim_domain* domain, uint32_t side, gim_cluster_sizes* sizes);

/* The clusters of one depth follow each other, as do their vertices and triangles. */
typedef struct gim_cluster_depth {
    uint32_t first_cluster, cluster_count;
    uint32_t first_vertex, vertex_count;
    uint32_t first_triangle, triangle_count;
    float error; /* the largest of its clusters */
} gim_cluster_depth;

enum { GIM_MAX_CLUSTER_DEPTHS = 32 };

typedef struct gim_cluster_tree {
    uint32_t cluster_count, vertex_count, triangle_count; /* how much of the arrays is used */
    uint32_t depth_count;                                 /* the root is the last cluster, alone in depth_count - 1 */
    uint32_t mesh_depth_count;                            /* depths with triangles: log2(intervals of a tile) + 1 */
    gim_cluster_depth depths[GIM_MAX_CLUSTER_DEPTHS];
} gim_cluster_tree;

/* Makes all clusters, depth 0 first.
 * clusters   room for gim_cluster_sizes.cluster_count
 * vertices   room for gim_cluster_sizes.vertex_count: for each cluster the vertices of gim_decode_mesh that it has
 * triangles  room for three times gim_cluster_sizes.triangle_count: for each triangle three places in the vertices of its
 *            cluster, counter-clockwise seen from outside, row after row of cells
 * scratch    scratch_size bytes, aligned to 16 bytes; only for the call
 * The same domain gives the same clusters. Cost: O(triangles * depths). */
GIM_API gim_status gim_decode_clusters(const gim_domain* domain, uint32_t side, gim_cluster* clusters,
                                       uint32_t* vertices, uint8_t* triangles, void* scratch, size_t scratch_size,
                                       gim_cluster_tree* tree);

/* Writes the triangles of clusters that follow each other, such as those of one depth, as an index buffer.
 * indices: room for three times the sum of their triangle_count. Cost: O(triangles). */
GIM_API void gim_read_cluster_triangles(const gim_cluster* clusters, uint32_t cluster_count, const uint32_t* vertices,
                                        const uint8_t* triangles, uint32_t* indices);

/* How often a vertex is transformed, with a cache that keeps the vertices that came last. */
typedef struct gim_cache_statistics {
    uint32_t misses;
    float acmr; /* misses for each triangle: 0.5 at best on a large mesh, 3 at worst */
    float atvr; /* misses for each vertex that is used: 1 at best */
} gim_cache_statistics;

/* triangles     triangle_count times three numbers below vertex_count: GIM_BAD_ARGUMENT for others, GIM_LIMIT_EXCEEDED
 *               for more than 2^32 / 3 triangles
 * cache_size    vertices in the cache, first in, first out; 16 is usual. 1 .. 2^30
 * scratch       vertex_count numbers, only for the call
 * Cost: O(triangles + vertices). */
GIM_API gim_status gim_count_cache_misses(const uint32_t* triangles, uint32_t triangle_count, uint32_t vertex_count,
                                          uint32_t cache_size, uint32_t* scratch, gim_cache_statistics* statistics);

#ifdef __cplusplus
}
#endif

#endif
