// A decoded image in clusters of triangles, as a tree (gim/clusters.h).
#pragma once

#include <cstdint>

#include "decoder/pyramid/arena.h"
#include "decoder/refine/bounds.h"
#include "decoder/refine/quad_domain.h"
#include "decoder/refine/tile_groups.h"
#include "format/container.h"
#include "gim/clusters.h"

namespace gim {

struct ClusterArrays {
    gim_cluster* clusters;
    uint32_t* vertices;
    uint8_t* triangles;
};

class ClusterBuilder {
  public:
    // side: 4 or 8. Takes its arrays from the arena. Without memory it only counts.
    ClusterBuilder(const QuadDomain* domain, uint32_t side, Arena* arena);

    // kLimitExceeded if a count does not fit 32 bits. Leaves scratch_size as it is. Cost: O(1).
    static Status read_sizes(const DomainShape& shape, uint32_t side, gim_cluster_sizes* sizes);

    void run(const ClusterArrays& out, gim_cluster_tree* tree);

  private:
    // Cells of a square, up to the ends.
    struct Part {
        uint32_t row, row_end, column, column_end;
    };

    // The clusters of depth 0 below a cluster.
    struct Leaves {
        uint32_t begin, end;
    };

    void number_clusters();
    void fill(uint32_t depth, uint32_t place, gim_cluster* cluster);
    void add_square(const CoarseCell& first, uint32_t cells, gim_cluster* cluster);
    void add_cells(const CoarseCell& first, const Part& part, gim_cluster* cluster);
    void add_cell(CoarseCell cell, gim_cluster* cluster);
    uint8_t local_number(uint32_t vertex, gim_cluster* cluster);
    bool is_main(const CoarseCell& cell) const;
    void bound(uint32_t depth, uint32_t place, gim_cluster* cluster);
    Cone cone_of(const gim_cluster& cluster, const Leaves& leaves, const Ball& ball) const;
    bool may_have_cone(const gim_cluster& cluster) const;
    void list_normals(const gim_cluster& cluster, Normal* normals) const;
    bool add_to_cone(const gim_cluster& cluster, ConeFit* fit) const;
    Leaves leaves_of(uint32_t depth, uint32_t place) const;
    uint32_t first_leaf(const gim_cluster* cluster) const;

    const QuadDomain* domain_;
    uint32_t side_;
    TileGroups groups_;
    uint8_t* local_;   // per vertex: its place in the list of a cluster that has it
    Normal* normals_;  // per triangle of depth 0
    ClusterArrays out_{};
    gim_cluster_tree* tree_ = nullptr;
};

}  // namespace gim
