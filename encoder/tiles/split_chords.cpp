#include "encoder/tiles/split_chords.h"

#include <array>

namespace gim {

namespace {

// Marks the half-edges on creases and boundaries, on both sides.
std::vector<uint8_t> features_of(const Topology& topology, const std::vector<bool>& sharp) {
    std::vector<uint8_t> feature(topology.twin.size(), 0);
    for (uint32_t h = 0; h < feature.size(); ++h) {
        const uint32_t twin = topology.twin[h];
        if (twin != kNone && (sharp.empty() || !sharp[h])) continue;
        feature[h] = 1;
        if (twin != kNone) feature[twin] = 1;
    }
    return feature;
}

// A face, and which of its edges are creases.
struct Part {
    Triangle corners;
    std::array<bool, 3> crease;
};

// Cuts a part from the middle of its edge i to the opposite corner.
std::array<Part, 2> cut(const Part& part, size_t i, uint32_t middle) {
    const size_t j = (i + 1) % 3, k = (i + 2) % 3;
    const auto& [c, f] = part;
    return {Part{{c[i], middle, c[k]}, {f[i], false, f[k]}}, Part{{middle, c[j], c[k]}, {f[i], f[j], false}}};
}

}  // namespace

void split_chords(Mesh& mesh, std::vector<bool>& sharp) {
    const Topology topology = build_topology(mesh);
    const std::vector<uint8_t> feature = features_of(topology, sharp);
    std::vector<bool> on_feature(mesh.positions.size(), false);
    for (uint32_t h = 0; h < feature.size(); ++h) {
        if (feature[h]) on_feature[from(mesh, h)] = on_feature[to(mesh, h)] = true;
    }
    std::vector<uint32_t> middle(feature.size(), kNone);
    for (uint32_t h = 0; h < feature.size(); ++h) {
        const uint32_t a = from(mesh, h), b = to(mesh, h);
        if (feature[h] || h > topology.twin[h] || !on_feature[a] || !on_feature[b]) continue;
        middle[h] = middle[topology.twin[h]] = static_cast<uint32_t>(mesh.positions.size());
        mesh.positions.push_back(0.5 * (mesh.positions[a] + mesh.positions[b]));
    }

    std::vector<Part> extra;
    std::vector<bool> marks(feature.size());
    const auto store = [&](uint32_t f, const Part& part) {
        mesh.triangles[f] = part.corners;
        for (size_t i = 0; i < 3; ++i) marks[3 * f + i] = part.crease[i];
    };
    for (uint32_t f = 0; f < feature.size() / 3; ++f) {
        const uint32_t h = 3 * f;
        const auto crease = [&](uint32_t e) { return feature[e] != 0 && topology.twin[e] != kNone; };
        std::vector<Part> parts{{mesh.triangles[f], {crease(h), crease(h + 1), crease(h + 2)}}};
        for (uint32_t side = 0; side < 3; ++side) {
            if (middle[h + side] == kNone) continue;
            const uint32_t a = from(mesh, h + side), b = to(mesh, h + side);
            for (size_t p = 0; p < parts.size(); ++p) {  // the part that still has the whole edge
                size_t i = 0;
                while (i < 3 && (parts[p].corners[i] != a || parts[p].corners[(i + 1) % 3] != b)) ++i;
                if (i == 3) continue;
                const auto halves = cut(parts[p], i, middle[h + side]);
                parts[p] = halves[0];
                parts.push_back(halves[1]);
                break;
            }
        }
        extra.insert(extra.end(), parts.begin() + 1, parts.end());
        middle[h] = middle[h + 1] = middle[h + 2] = kNone;
        store(f, parts[0]);
    }
    for (const Part& part : extra) {
        mesh.triangles.emplace_back();
        marks.resize(marks.size() + 3);
        store(static_cast<uint32_t>(mesh.triangles.size() - 1), part);
    }
    if (!sharp.empty()) sharp = std::move(marks);
}

}  // namespace gim
