// write_refined VECTORS DAMAGED FOLDER: what the native library makes of gim/refine.h and gim/clusters.h, for the test of
// gim/refine. Writes FOLDER/refined.bin, all numbers that valid vectors give, as words of 32 bits, and FOLDER/refined.txt: a
// line "NAME COUNT" for each vector. Writes FOLDER/damaged-refined.txt: a line "NAME HASH" for each copy that write_damaged
// has left in DAMAGED. refine_all.mjs does the same with gim/refine.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "gim/clusters.h"
#include "gim/decoder.hpp"

namespace {

using Bytes = std::vector<uint8_t>;

constexpr gim_limits kLimits = {65536, 16, 2049};  // as in decode_all.mjs

// All numbers, in the order of refine_all.mjs.
class Words {
  public:
    void add(uint32_t word) { words_.push_back(word); }
    void add(float value) {
        uint32_t word = 0x7FC00000;
        if (value == value) std::memcpy(&word, &value, 4);
        add(word);
    }
    template <class T>
    void add(const T* values, size_t count) {
        for (size_t i = 0; i < count; ++i) add(values[i]);
    }
    const std::vector<uint32_t>& all() const { return words_; }

  private:
    std::vector<uint32_t> words_;
};

struct Place {
    const gim_info& info;
    const Bytes& file;
    uint32_t image, level;
};

float need_of(void* user, uint32_t, const float*, float error, float) { return error / *static_cast<float*>(user); }

// A domain, and what can be done with it.
class Walk {
  public:
    Walk(const gim_domain_info& shape, const gim_domain* domain, const std::vector<float>& positions, Words* words)
        : shape_(shape), domain_(domain), positions_(positions), words_(*words) {}

    void run() {
        for (const uint32_t number :
             {shape_.tile_count, shape_.intervals, shape_.vertex_count, shape_.width, shape_.height})
            words_.add(number);
        words_.add(static_cast<uint32_t>(shape_.most_triangles));
        add_worths();
        add_samples();
        const auto most = static_cast<uint32_t>(shape_.most_triangles);
        gim::Scratch memory;
        const uint64_t size = gim_refined_size(domain_, most);
        if (!memory.reserve(size)) return;
        if (!told(gim_begin_refined(domain_, most, memory.data(), memory.size(), &mesh_))) return;
        refine_in_turn();
        add_half_edges();
        add_patches();
        told(gim_split(mesh_, 0));
        told(gim_weld(mesh_, shape_.vertex_count - 1));
        add_triangles();
        for (const uint32_t side : {8u, 4u}) add_clusters(side);
    }

  private:
    bool told(gim_status status) {
        words_.add(static_cast<uint32_t>(status));
        return status == GIM_OK;
    }

    void add_worths() {
        for (uint32_t v = 0; v < shape_.vertex_count; ++v) {
            float error, radius;
            gim_vertex_worth(domain_, v, &error, &radius);
            words_.add(error);
            words_.add(radius);
            worst_ = std::max(worst_, error);
        }
    }
    void add_samples() {
        std::vector<uint32_t> vertices(size_t{shape_.width} * shape_.height);
        gim_read_sample_vertices(domain_, vertices.data());
        words_.add(vertices.data(), vertices.size());
        std::vector<float> samples(3 * vertices.size());
        gim_lay_out_samples(domain_, positions_.data(), 3, samples.data());
        words_.add(samples.data(), samples.size());
    }

    void refine(const gim_rule& rule, uint32_t most_operations = 0) {
        uint32_t done = 2;
        if (!told(gim_refine(mesh_, &rule, most_operations, &done))) return;
        words_.add(done);
        add_triangles();
        gim_changes c;
        gim_take_changes(mesh_, &c);
        words_.add(c.added, c.added_count);
        words_.add(c.removed, c.removed_count);
        words_.add(c.triangles, c.changed_count);
        words_.add(c.triangles_before);
        words_.add(c.triangle_count);
    }
    void refine_in_turn() {
        const float* first = positions_.data();
        const float* last = first + 3 * (size_t{shape_.vertex_count} - 1);
        gim_rule rule{};
        rule.object_error = worst_ / 8;
        refine(rule);
        rule = {};
        rule.pixel_error = 1;
        std::copy_n(first, 3, rule.eye);
        rule.pixels_per_unit = 256;
        rule.keep = 0.5f;
        refine(rule, 100);
        rule = {};
        rule.object_error = worst_ / 16;
        rule.most_triangles = 2 * shape_.tile_count + 50;
        refine(rule);
        rule = {};
        float share = worst_ / 4;
        rule.need = need_of;
        rule.user = &share;
        refine(rule);
        rule = {};
        rule.object_error = worst_ / 32;
        std::copy_n(last, 3, rule.sphere);
        rule.sphere[3] = worst_ * 4;
        const std::array<float, 8> planes = {0, 0, 1, -last[2], 0, 1, 0, worst_};
        rule.planes = planes.data();
        rule.plane_count = 2;
        for (size_t k = 0; k < 3; ++k) {
            rule.box[k] = std::min(first[k], last[k]);
            rule.box[3 + k] = std::max(first[k], last[k]);
        }
        refine(rule);
    }

    uint32_t count() const {
        uint32_t triangles = 0;
        (void)gim_refined_triangles(mesh_, &triangles);
        return triangles;
    }
    void add_triangles() { words_.add(gim_refined_triangles(mesh_, nullptr), 3 * size_t{count()}); }
    void add_half_edges() {
        for (uint32_t h = 0; h < 3 * count(); ++h) {
            gim_half_edge e;
            if (!told(gim_read_half_edge(mesh_, h, &e))) return;
            for (const uint32_t number : {e.mate, e.vertex, e.tile, uint32_t{e.start[0]}, uint32_t{e.start[1]},
                                          uint32_t{e.end[0]}, uint32_t{e.end[1]}, e.level})
                words_.add(number);
        }
    }
    void add_patches() {
        std::vector<gim_patch> patches(2 * size_t{count()});
        uint32_t used = 0;
        if (!told(gim_read_patches(mesh_, patches.data(), static_cast<uint32_t>(patches.size()), &used))) return;
        std::vector<uint32_t> words(2 * size_t{used});
        std::memcpy(words.data(), patches.data(), 8 * size_t{used});
        words_.add(words.data(), words.size());
    }

    void add_clusters(uint32_t side) {
        gim_cluster_sizes sizes;
        if (!told(gim_read_cluster_sizes(domain_, side, &sizes))) return;
        std::vector<gim_cluster> clusters(sizes.cluster_count);
        std::vector<uint32_t> vertices(sizes.vertex_count);
        Bytes triangles(3 * size_t{sizes.triangle_count});
        gim::Scratch scratch;
        gim_cluster_tree tree;
        if (!scratch.reserve(sizes.scratch_size)) return;
        if (!told(gim_decode_clusters(domain_, side, clusters.data(), vertices.data(), triangles.data(), scratch.data(),
                                      scratch.size(), &tree)))
            return;
        words_.add(tree.mesh_depth_count);
        for (uint32_t i = 0; i < tree.depth_count; ++i) {
            const gim_cluster_depth& d = tree.depths[i];
            for (const uint32_t number :
                 {d.first_cluster, d.cluster_count, d.first_vertex, d.vertex_count, d.first_triangle, d.triangle_count})
                words_.add(number);
            words_.add(d.error);
        }
        for (uint32_t i = 0; i < tree.cluster_count; ++i) add_cluster(clusters[i]);
        words_.add(vertices.data(), tree.vertex_count);
        for (size_t i = 0; i < 3 * size_t{tree.triangle_count}; ++i) words_.add(uint32_t{triangles[i]});
        add_indices(clusters.data() + tree.depths[0].first_cluster, tree.depths[0], vertices, triangles);
    }
    void add_cluster(const gim_cluster& c) {
        words_.add(c.center, 3);
        words_.add(c.radius);
        words_.add(c.cone_apex, 3);
        words_.add(c.cone_cutoff);
        words_.add(c.cone_axis, 3);
        words_.add(c.error);
        words_.add(c.parent_error);
        for (const uint32_t number : {c.parent, c.first_child, c.child_count, c.depth, c.first_vertex, c.vertex_count,
                                      c.first_triangle, c.triangle_count})
            words_.add(number);
    }
    void add_indices(const gim_cluster* first, const gim_cluster_depth& depth, const std::vector<uint32_t>& vertices,
                     const Bytes& triangles) {
        std::vector<uint32_t> indices(3 * size_t{depth.triangle_count});
        gim_read_cluster_triangles(first, depth.cluster_count, vertices.data(), triangles.data(), indices.data());
        words_.add(indices.data(), indices.size());
    }

    const gim_domain_info& shape_;
    const gim_domain* domain_;
    const std::vector<float>& positions_;
    Words& words_;
    gim_refined* mesh_ = nullptr;
    float worst_ = 0;
};

gim_status walk_domain(const Place& at, const std::vector<float>& positions, Words* words) {
    gim_domain_info shape;
    const void* const bytes = at.file.data();
    const size_t size = at.file.size();
    gim_status status = gim_read_domain_info(&at.info, bytes, size, at.image, at.level, &shape);
    if (status != GIM_OK) return status;
    gim::Scratch memory, scratch;
    if (!memory.reserve(shape.domain_size) || !scratch.reserve(shape.scratch_size)) return GIM_SCRATCH_TOO_SMALL;
    const gim_domain* domain = nullptr;
    status = gim_open_domain(&at.info, bytes, size, at.image, at.level, positions.data(), memory.data(), memory.size(),
                             scratch.data(), scratch.size(), &domain);
    if (status != GIM_OK) return status;
    words->add(uint32_t{0});
    Walk(shape, domain, positions, words).run();
    return GIM_OK;
}

// The finest level of the displacements.
gim_status walk_details(const Place& at, gim::Decoder& decoder, const std::vector<float>& positions, Words* words) {
    gim::DecoderPlane plane;
    gim_status status = decoder.read_plane(at.image, GIM_PLANE_DISPLACEMENTS, 0, &plane);
    if (status != GIM_OK) return status;
    std::vector<float> displacements(3 * size_t{plane.width} * plane.height);
    status = decoder.plane(plane, displacements);
    if (status != GIM_OK) return status;
    gim_domain_info shape;
    const void* const bytes = at.file.data();
    const size_t size = at.file.size();
    status = gim_read_detailed_domain_info(&at.info, bytes, size, at.image, 0, &shape);
    if (status != GIM_OK) return status;
    gim::Scratch memory, scratch;
    if (!memory.reserve(shape.domain_size) || !scratch.reserve(shape.scratch_size)) return GIM_SCRATCH_TOO_SMALL;
    std::vector<float> detailed(3 * size_t{shape.vertex_count});
    const gim_domain* domain = nullptr;
    status = gim_open_detailed_domain(&at.info, bytes, size, at.image, 0, positions.data(), displacements.data(),
                                      detailed.data(), memory.data(), memory.size(), scratch.data(), scratch.size(),
                                      &domain);
    if (status != GIM_OK) return status;
    words->add(uint32_t{0});
    words->add(detailed.data(), detailed.size());
    Walk(shape, domain, detailed, words).run();
    return GIM_OK;
}

Words words_of(const Bytes& file) {
    Words words;
    gim::Decoder decoder;
    const auto told = [&words](gim_status status) {
        if (status != GIM_OK) words.add(static_cast<uint32_t>(status));
        return status == GIM_OK;
    };
    if (!told(decoder.open(file, &kLimits))) return words;
    for (uint32_t image = 0; image < decoder.info().image_count; ++image) {
        gim::DecoderLevel level;
        for (uint32_t l = 0; l <= level.coarsest_level; ++l) {
            if (!told(decoder.read_level(image, l, &level))) break;
            std::vector<float> positions(3 * size_t{level.vertex_count});
            if (!told(decoder.mesh(level, {positions, {}, {}, {}}))) continue;
            const Place at = {decoder.info(), file, image, l};
            told(walk_domain(at, positions, &words));
            if (l == 0) told(walk_details(at, decoder, positions, &words));
        }
    }
    return words;
}

Bytes read(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

uint32_t hash_of(const Words& words) {
    uint32_t hash = 2166136261u;  // FNV-1a over words
    for (const uint32_t word : words.all()) hash = (hash ^ word) * 16777619u;
    return hash;
}

void write_vectors(const std::filesystem::path& vectors, const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> paths;
    for (const auto& entry : std::filesystem::directory_iterator(vectors / "valid"))
        if (entry.path().extension() == ".gim") paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    std::ofstream bytes(folder / "refined.bin", std::ios::binary), text(folder / "refined.txt");
    for (const auto& path : paths) {
        const Words words = words_of(read(path));
        bytes.write(reinterpret_cast<const char*>(words.all().data()),
                    static_cast<std::streamsize>(4 * words.all().size()));
        text << path.stem().string() << ' ' << words.all().size() << '\n';
    }
}

void write_damaged(const std::filesystem::path& damaged, const std::filesystem::path& folder) {
    std::ifstream bytes(damaged / "damaged.bin", std::ios::binary), text(damaged / "damaged.txt");
    std::ofstream hashes(folder / "damaged-refined.txt");
    std::string name;
    for (uint64_t size, hash; text >> name >> size >> hash;) {
        Bytes copy(size);
        bytes.read(reinterpret_cast<char*>(copy.data()), static_cast<std::streamsize>(size));
        hashes << name << ' ' << hash_of(words_of(copy)) << '\n';
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 4) return std::fprintf(stderr, "usage: write_refined VECTORS DAMAGED FOLDER\n"), 2;
    const std::filesystem::path folder = argv[3];
    std::filesystem::create_directories(folder);
    write_vectors(argv[1], folder);
    write_damaged(argv[2], folder);
    return 0;
}
