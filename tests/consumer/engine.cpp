// An engine's use of gim in one file: streaming, memory, choosing levels, refining, culling. spec/embedding.md explains it.
// Usage: engine FILE.gim      Prints what it does to one mesh while an eye comes nearer.
#include <gim/clusters.h>
#include <gim/decoder.h>
#include <gim/refine.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <vector>

namespace {
// The library allocates nothing. An engine brings its own allocator; its blocks are aligned to 16 bytes.
struct alignas(16) Block {
    unsigned char bytes[16];
};
struct Memory {
    std::vector<Block> blocks;
    explicit Memory(std::uint64_t size) : blocks(size / sizeof(Block) + 1) {}
    void* data() { return blocks.data(); }
    std::size_t size() const { return blocks.size() * sizeof(Block); }
};

// What all instances of a mesh share. One thread opens it; then any number of threads may read it.
struct Mesh {
    std::vector<unsigned char> file;
    gim_info info{};
    std::vector<float> positions;  // the vertex buffer of all resolutions
    Memory memory{0};
    const gim_domain* domain = nullptr;
    std::vector<gim_cluster> clusters;
    gim_cluster_tree tree{};
};

// Streaming: shows the coarsest level as soon as its bytes are there, then finer ones. Here the bytes come by the kilobyte.
// Returns whether level 0 was reached.
bool stream(Mesh* mesh) {
    std::uint32_t wanted = GIM_MAX_LEVELS;  // the level to show next
    for (std::size_t here = 0; here < mesh->file.size();) {
        here = std::min(here + 1024, mesh->file.size());
        if (gim_read_info(mesh->file.data(), here, nullptr, &mesh->info) != GIM_OK) continue;  // or a broken file
        if (wanted == GIM_MAX_LEVELS) wanted = mesh->info.level_count - 1;
        gim_level_info level;
        while (gim_read_level_info(&mesh->info, mesh->file.data(), here, 0, wanted, &level) == GIM_OK &&
               level.prefix_size <= here) {
            Memory scratch(level.scratch_size);
            mesh->positions.resize(3 * std::size_t{level.vertex_count});
            if (gim_decode_mesh(&mesh->info, mesh->file.data(), here, 0, wanted, mesh->positions.data(), nullptr,
                                nullptr, nullptr, scratch.data(), scratch.size()) != GIM_OK)
                return false;
            std::printf("%zu bytes: level %u, %u vertices\n", here, wanted, level.vertex_count);
            if (wanted-- == 0) return true;
        }
    }
    return false;
}

// Prepares refining and culling at level 0.
bool open(Mesh* mesh) {
    gim_domain_info shape;
    if (gim_read_domain_info(&mesh->info, mesh->file.data(), mesh->file.size(), 0, 0, &shape) != GIM_OK) return false;
    mesh->memory = Memory(shape.domain_size);
    Memory scratch(shape.scratch_size);
    if (gim_open_domain(&mesh->info, mesh->file.data(), mesh->file.size(), 0, 0, mesh->positions.data(),
                        mesh->memory.data(), mesh->memory.size(), scratch.data(), scratch.size(),
                        &mesh->domain) != GIM_OK)
        return false;
    gim_cluster_sizes sizes;
    if (gim_read_cluster_sizes(mesh->domain, 8, &sizes) != GIM_OK) return false;
    mesh->clusters.resize(sizes.cluster_count);
    std::vector<std::uint32_t> vertices(sizes.vertex_count);  // for the GPU, as the next one
    std::vector<std::uint8_t> triangles(3 * std::size_t{sizes.triangle_count});
    Memory of_clusters(sizes.scratch_size);
    return gim_decode_clusters(mesh->domain, 8, mesh->clusters.data(), vertices.data(), triangles.data(),
                               of_clusters.data(), of_clusters.size(), &mesh->tree) == GIM_OK;
}

// Choosing a level for the whole mesh: the coarsest depth whose error is below a pixel.
std::uint32_t choose_depth(const Mesh& mesh, float pixels_per_unit) {
    std::uint32_t depth = 0;
    while (depth + 1 < mesh.tree.mesh_depth_count && mesh.tree.depths[depth + 1].error * pixels_per_unit < 1) ++depth;
    return depth;
}

// Culling: triangles of the clusters of a depth that may face the eye.
std::uint32_t facing_triangles(const Mesh& mesh, std::uint32_t depth, const float (&eye)[3]) {
    std::uint32_t triangles = 0;
    const gim_cluster_depth& d = mesh.tree.depths[depth];
    for (std::uint32_t i = d.first_cluster; i < d.first_cluster + d.cluster_count; ++i) {
        const gim_cluster& c = mesh.clusters[i];
        float dot = 0, length = 0;
        for (int k = 0; k < 3; ++k) {
            dot += (c.cone_apex[k] - eye[k]) * c.cone_axis[k];
            length += (c.cone_apex[k] - eye[k]) * (c.cone_apex[k] - eye[k]);
        }
        if (dot < c.cone_cutoff * std::sqrt(length)) triangles += c.triangle_count;
    }
    return triangles;
}

// Refining: each instance has a mesh of its own, and an index buffer that follows its changes.
struct Instance {
    Memory memory;
    gim_refined* refined = nullptr;
    std::vector<std::uint32_t> indices;

    Instance(const Mesh& mesh, std::uint32_t most_triangles) : memory(gim_refined_size(mesh.domain, most_triangles)) {
        gim_begin_refined(mesh.domain, most_triangles, memory.data(), memory.size(), &refined);
    }
    // Returns how many triangles had to be written again.
    std::uint32_t update(const float (&eye)[3], float pixels_per_unit) {
        gim_rule rule{};
        rule.pixel_error = 1;
        rule.pixels_per_unit = pixels_per_unit;
        for (int k = 0; k < 3; ++k) rule.eye[k] = eye[k];
        gim_refine(refined, &rule, 2000, nullptr);  // at most 2000 splits and welds a frame: the rest comes later
        gim_changes changes;
        gim_take_changes(refined, &changes);
        const std::uint32_t* triangles = gim_refined_triangles(refined, nullptr);
        indices.resize(3 * std::size_t{changes.triangle_count});
        for (std::uint32_t i = 0; i < changes.changed_count; ++i) {
            for (int k = 0; k < 3; ++k) indices[3 * changes.triangles[i] + k] = triangles[3 * changes.triangles[i] + k];
        }
        return changes.changed_count;
    }
};

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    std::ifstream in(argv[1], std::ios::binary);
    Mesh mesh;
    mesh.file.assign(std::istreambuf_iterator<char>(in), {});
    if (!stream(&mesh) || !open(&mesh)) return 1;
    const gim_cluster& root = mesh.clusters[mesh.tree.cluster_count - 1];
    Instance instance(mesh, 100000);
    if (!instance.refined) return 1;
    for (float distance = 64; distance >= 1; distance /= 2) {  // in radii of the mesh
        const float eye[3] = {root.center[0], root.center[1] - (1 + distance) * root.radius, root.center[2]};
        const float pixels_per_unit = 1000;  // of an edge of length 1 at distance 1
        const std::uint32_t depth = choose_depth(mesh, pixels_per_unit / (distance * root.radius));
        const std::uint32_t changed = instance.update(eye, pixels_per_unit);
        std::printf("distance %g: depth %u, %u triangles of it face the eye; refined: %zu triangles, %u changed\n",
                    distance, depth, facing_triangles(mesh, depth, eye), instance.indices.size() / 3, changed);
    }
    return 0;
}
