#include "decoder/refine/cluster_builder.h"

#include <algorithm>
#include <bit>
#include <cfloat>

#include "decoder/pyramid/cells.h"
#include "decoder/pyramid/vector3.h"

namespace gim {
namespace {

uint32_t exponent_of(uint32_t power_of_2) { return static_cast<uint32_t>(std::countr_zero(power_of_2)); }

// What the clusters of one depth are made of.
struct DepthPlan {
    uint32_t stride;    // samples along a cell
    uint32_t cells;     // along a side of a tile
    uint32_t per_side;  // clusters along a side of a tile; 1 if a tile has one or is a part of one
    uint32_t level;     // of the groups of tiles

    DepthPlan(uint32_t depth, uint32_t intervals, uint32_t side)
        : stride(1u << depth),
          cells(intervals >> depth),
          per_side(std::max(cells / side, 1u)),
          level(cells >= side ? 0 : exponent_of(side / cells)) {}
    uint32_t clusters_per_tile() const { return per_side * per_side; }
};

// Clusters of a tile in Morton order, so that two by two of them follow each other: every second bit.
uint32_t even_bits(uint32_t x) {
    uint32_t bits = 0;
    for (uint32_t k = 0; k < 16; ++k) bits |= (x >> (2 * k) & 1) << k;
    return bits;
}

}  // namespace

ClusterBuilder::ClusterBuilder(const QuadDomain* domain, uint32_t side, Arena* arena)
    : domain_(domain), side_(side), groups_(domain, exponent_of(side), arena) {
    local_ = arena->take<uint8_t>(domain->shape().vertices);
    normals_ = arena->take<Normal>(domain->shape().most_triangles());
}

Status ClusterBuilder::read_sizes(const DomainShape& shape, uint32_t side, gim_cluster_sizes* sizes) {
    const uint64_t tiles = shape.tiles;
    uint64_t clusters = 0, vertices = 0, triangles = 0;
    for (uint32_t depth = 0; shape.intervals >> depth > 0; ++depth) {
        const DepthPlan plan(depth, shape.intervals, side);
        const uint64_t width = std::min(plan.cells, side) + 1;
        clusters += tiles * plan.clusters_per_tile();
        vertices += tiles * plan.clusters_per_tile() * width * width;
        triangles += tiles * 2 * plan.cells * plan.cells;
    }
    constexpr uint32_t kMembers = TileGroups::kMostMembers;
    for (uint64_t groups = tiles; groups > 1;) clusters += groups = (groups + kMembers - 1) / kMembers;
    if (std::max({clusters, vertices, triangles}) > UINT32_MAX) return Status::kLimitExceeded;
    sizes->cluster_count = static_cast<uint32_t>(clusters);
    sizes->vertex_count = static_cast<uint32_t>(vertices);
    sizes->triangle_count = static_cast<uint32_t>(triangles);
    return Status::kOk;
}

void ClusterBuilder::run(const ClusterArrays& out, gim_cluster_tree* tree) {
    out_ = out;
    tree_ = tree;
    groups_.run();
    std::fill_n(local_, domain_->shape().vertices, uint8_t{0});
    number_clusters();
    tree->vertex_count = tree->triangle_count = 0;
    for (uint32_t depth = 0; depth < tree->depth_count; ++depth) {
        gim_cluster_depth& all = tree->depths[depth];
        all.first_vertex = tree->vertex_count;
        all.first_triangle = tree->triangle_count;
        for (uint32_t i = 0; i < all.cluster_count; ++i) {
            gim_cluster* const cluster = out.clusters + all.first_cluster + i;
            fill(depth, i, cluster);
            bound(depth, i, cluster);
            all.error = std::max(all.error, cluster->error);
        }
        all.vertex_count = tree->vertex_count - all.first_vertex;
        all.triangle_count = tree->triangle_count - all.first_triangle;
    }
}

// Counts, parents and children.
void ClusterBuilder::number_clusters() {
    const DomainShape& shape = domain_->shape();
    tree_->mesh_depth_count = exponent_of(shape.intervals) + 1;
    tree_->depth_count = tree_->mesh_depth_count + groups_.levels() - 1 - exponent_of(side_);
    uint32_t next = 0;
    for (uint32_t depth = 0; depth < tree_->depth_count; ++depth) {
        const uint32_t finer = std::min(depth, tree_->mesh_depth_count - 1);
        const DepthPlan plan(finer, shape.intervals, side_);
        const uint32_t level = plan.level + depth - finer;
        const uint32_t count = groups_.count(level) * plan.clusters_per_tile();
        tree_->depths[depth] = {next, count, 0, 0, 0, 0, 0};
        const uint32_t below = depth > 0 ? tree_->depths[depth - 1].first_cluster : 0;
        for (uint32_t i = 0; i < count; ++i) {
            gim_cluster& cluster = out_.clusters[next + i];
            cluster = {};
            cluster.depth = depth;
            cluster.parent = cluster.first_child = GIM_NOTHING;
            cluster.parent_error = FLT_MAX;
            if (depth == 0) continue;
            const uint32_t first = level > 0 ? groups_.first_member(level, i) : 4 * i;
            const uint32_t end = level > 0 ? groups_.first_member(level, i + 1) : 4 * i + 4;
            cluster.first_child = below + first;
            cluster.child_count = end - first;
            for (uint32_t c = first; c < end; ++c) out_.clusters[below + c].parent = next + i;
        }
        next += count;
    }
    tree_->cluster_count = next;
}

// Vertices, triangles and error.
void ClusterBuilder::fill(uint32_t depth, uint32_t place, gim_cluster* cluster) {
    cluster->first_vertex = tree_->vertex_count;
    cluster->first_triangle = tree_->triangle_count;
    for (uint32_t c = 0; c < cluster->child_count; ++c)
        cluster->error = std::max(cluster->error, out_.clusters[cluster->first_child + c].error);
    if (depth >= tree_->mesh_depth_count) {
        cluster->error = FLT_MAX;
    } else {
        const DepthPlan plan(depth, domain_->shape().intervals, side_);
        const uint32_t per_tile = plan.clusters_per_tile(), group = place / per_tile, block = place % per_tile;
        const uint32_t row = even_bits(block >> 1) * side_ * plan.stride,
                       column = even_bits(block) * side_ * plan.stride;
        const uint32_t end = groups_.first_tile(plan.level, group + 1);
        for (uint32_t t = groups_.first_tile(plan.level, group); t < end; ++t)
            add_square({groups_.tile(t), row, column, plan.stride, false}, std::min(side_, plan.cells), cluster);
    }
    for (uint32_t c = 0; c < cluster->child_count; ++c)
        out_.clusters[cluster->first_child + c].parent_error = cluster->error;
    tree_->vertex_count += cluster->vertex_count;
    tree_->triangle_count += cluster->triangle_count;
}

// Row after row, so that a cache that holds a row and a little more keeps the row above. The vertices of the first row come
// interleaved with those of the second one, so 16 are too few for rows of 8; the first two rows come in two parts.
void ClusterBuilder::add_square(const CoarseCell& first, uint32_t cells, gim_cluster* cluster) {
    constexpr uint32_t kPart = 6;
    if (cells > kPart) {
        add_cells(first, {0, 2, 0, kPart}, cluster);
        add_cells(first, {0, 2, kPart, cells}, cluster);
        add_cells(first, {2, cells, 0, cells}, cluster);
    } else {
        add_cells(first, {0, cells, 0, cells}, cluster);
    }
}

void ClusterBuilder::add_cells(const CoarseCell& first, const Part& part, gim_cluster* cluster) {
    for (uint32_t r = part.row; r < part.row_end; ++r) {
        for (uint32_t c = part.column; c < part.column_end; ++c) {
            CoarseCell cell = first;
            cell.row += r * cell.size;
            cell.column += c * cell.size;
            add_cell(cell, cluster);
        }
    }
}

void ClusterBuilder::add_cell(CoarseCell cell, gim_cluster* cluster) {
    const uint32_t below = cell.row + cell.size, beside = cell.column + cell.size;
    cell.is_main = is_main(cell);
    uint32_t vertices[6];
    write_cell(domain_->vertex_at(cell.tile, cell.row, cell.column), domain_->vertex_at(cell.tile, cell.row, beside),
               domain_->vertex_at(cell.tile, below, cell.column), domain_->vertex_at(cell.tile, below, beside),
               cell.is_main, vertices);
    uint8_t* const local = out_.triangles + 3 * (size_t{cluster->first_triangle} + cluster->triangle_count);
    for (int i = 0; i < 6; ++i) local[i] = local_number(vertices[i], cluster);
    cluster->triangle_count += 2;
    cluster->error = std::max(cluster->error, cell_error(*domain_, cell));
}

uint8_t ClusterBuilder::local_number(uint32_t vertex, gim_cluster* cluster) {
    uint32_t* const list = out_.vertices + cluster->first_vertex;
    uint8_t& local = local_[vertex];
    if (local >= cluster->vertex_count || list[local] != vertex) {
        local = static_cast<uint8_t>(cluster->vertex_count);
        list[cluster->vertex_count++] = vertex;
    }
    return local;
}

bool ClusterBuilder::is_main(const CoarseCell& cell) const {
    const uint32_t last = domain_->shape().intervals - cell.size;
    if (last == 0) return domain_->glue().is_anti[cell.tile] == 0;
    const bool top = cell.row == 0, bottom = cell.row == last, left = cell.column == 0, right = cell.column == last;
    if ((top || bottom) && (left || right)) return top == left;
    const auto at = [&](uint32_t row, uint32_t column) {
        return domain_->value(domain_->vertex_at(cell.tile, row, column)).position;
    };
    const uint32_t below = cell.row + cell.size, beside = cell.column + cell.size;
    return squared_distance(at(cell.row, cell.column), at(below, beside)) <=
           squared_distance(at(cell.row, beside), at(below, cell.column));
}

// Ball and cone, from all triangles of depth 0 below, which follow each other.
void ClusterBuilder::bound(uint32_t depth, uint32_t place, gim_cluster* cluster) {
    const Leaves leaves = leaves_of(depth, place);
    const uint32_t first = out_.clusters[leaves.begin].first_vertex;
    const gim_cluster& last = out_.clusters[leaves.end - 1];
    Ball ball = ball_around(*domain_, {out_.vertices + first, last.first_vertex + last.vertex_count - first});
    for (uint32_t c = 0; c < cluster->child_count; ++c) {
        const gim_cluster& child = out_.clusters[cluster->first_child + c];
        include_ball({{child.center[0], child.center[1], child.center[2]}, child.radius}, &ball);
    }
    if (depth == 0) list_normals(*cluster, normals_ + cluster->first_triangle);
    const Cone cone = cone_of(*cluster, leaves, ball);

    std::copy_n(ball.center, 3, cluster->center);
    cluster->radius = ball.radius;
    std::copy_n(cone.apex, 3, cluster->cone_apex);
    std::copy_n(cone.axis, 3, cluster->cone_axis);
    cluster->cone_cutoff = cone.cutoff;
}

Cone ClusterBuilder::cone_of(const gim_cluster& cluster, const Leaves& leaves, const Ball& ball) const {
    float axis[3] = {};
    bool is_there = may_have_cone(cluster);
    if (is_there) {
        const gim_cluster& last = out_.clusters[leaves.end - 1];
        const uint32_t first = out_.clusters[leaves.begin].first_triangle;
        middle_of_normals({normals_ + first, last.first_triangle + last.triangle_count - first}, axis);
    }
    ConeFit fit(axis, ball);
    is_there = is_there && add_to_cone(cluster, &fit);
    for (uint32_t leaf = leaves.begin; leaf < leaves.end && is_there; ++leaf)
        is_there = add_to_cone(out_.clusters[leaf], &fit);
    return is_there ? fit.finish() : no_cone(ball);
}

// What is too wide for a cone below is too wide here.
bool ClusterBuilder::may_have_cone(const gim_cluster& cluster) const {
    for (uint32_t c = 0; c < cluster.child_count; ++c) {
        if (out_.clusters[cluster.first_child + c].cone_cutoff == 1) return false;
    }
    return true;
}

void ClusterBuilder::list_normals(const gim_cluster& cluster, Normal* normals) const {
    const uint32_t* const list = out_.vertices + cluster.first_vertex;
    const uint8_t* local = out_.triangles + 3 * size_t{cluster.first_triangle};
    for (uint32_t t = 0; t < cluster.triangle_count; ++t, local += 3) {
        const uint32_t vertices[3] = {list[local[0]], list[local[1]], list[local[2]]};
        double normal[3];
        const bool is_fine = face_normal(*domain_, vertices, normal) == Facing::kFine;
        for (int k = 0; k < 3; ++k) normals[t].x[k] = is_fine ? static_cast<float>(normal[k]) : 0.0f;
    }
}

bool ClusterBuilder::add_to_cone(const gim_cluster& cluster, ConeFit* fit) const {
    const uint32_t* const list = out_.vertices + cluster.first_vertex;
    const uint8_t* local = out_.triangles + 3 * size_t{cluster.first_triangle};
    bool is_there = true;
    for (uint32_t t = 0; t < cluster.triangle_count && is_there; ++t, local += 3) {
        const uint32_t vertices[3] = {list[local[0]], list[local[1]], list[local[2]]};
        is_there = fit->add(*domain_, vertices);
    }
    return is_there;
}

ClusterBuilder::Leaves ClusterBuilder::leaves_of(uint32_t depth, uint32_t place) const {
    const gim_cluster_depth& all = tree_->depths[depth];
    const gim_cluster* const cluster = out_.clusters + all.first_cluster + place;
    const bool is_last = place + 1 == all.cluster_count;
    return {first_leaf(cluster), is_last ? tree_->depths[0].cluster_count : first_leaf(cluster + 1)};
}

uint32_t ClusterBuilder::first_leaf(const gim_cluster* cluster) const {
    while (cluster->depth > 0) cluster = out_.clusters + cluster->first_child;
    return static_cast<uint32_t>(cluster - out_.clusters);
}

}  // namespace gim
