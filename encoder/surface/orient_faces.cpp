#include "encoder/surface/orient_faces.h"

#include <algorithm>
#include <utility>

#include "encoder/surface/cut_one_sided.h"
#include "encoder/surface/join_faces.h"

namespace gim {

namespace {

constexpr double kMixed = 0.25;  // share of faces that show the other side; above it the file does not say a side

struct Piece {
    uint64_t faces = 0, turned = 0;
    bool open = false;
    double volume = 0;  // six times the volume, if the faces are turned as `turn` says
    Vec3 origin = Vec3::Zero();

    bool must_turn() const {
        const auto share = static_cast<double>(turned) / static_cast<double>(faces);
        if (!open && std::min(share, 1 - share) > kMixed) return volume < 0;
        return 2 * turned > faces;
    }
};

std::vector<Piece> measure_pieces(const std::vector<Point>& positions, const std::vector<Triangle>& places,
                                  const std::vector<uint32_t>& twin, const std::vector<uint8_t>& turn,
                                  const Components& components) {
    std::vector<Piece> pieces(components.count);
    const auto at = [&](uint32_t v) { return to_vec(positions[v]); };
    for (uint32_t f = 0; f < places.size(); ++f) {
        Piece& piece = pieces[components.of_face[f]];
        const Triangle& t = places[f];
        if (piece.faces++ == 0) piece.origin = at(t[0]);
        piece.turned += turn[f] ? 1 : 0;
        for (uint32_t h = 3 * f; h < 3 * f + 3; ++h) piece.open = piece.open || twin[h] == kNone;
        const Vec3 a = at(t[0]) - piece.origin, b = at(t[1]) - piece.origin, c = at(t[2]) - piece.origin;
        piece.volume += (turn[f] ? -1 : 1) * a.dot(b.cross(c));
    }
    return pieces;
}

}  // namespace

OrientCounts orient_faces(const std::vector<Point>& positions, std::vector<Triangle>& triangles,
                          std::vector<Triangle>& places, std::vector<uint32_t>& twin) {
    std::vector<uint8_t> turn = find_turning(places, twin).turn;
    const Components components = joined_components(twin);
    const std::vector<Piece> pieces = measure_pieces(positions, places, twin, turn, components);
    OrientCounts counts;
    for (const Piece& piece : pieces)
        counts.inside_out += !piece.open && (piece.must_turn() ? -1 : 1) * piece.volume < 0 ? 1 : 0;
    for (uint32_t f = 0; f < places.size(); ++f) {
        if (pieces[components.of_face[f]].must_turn()) turn[f] ^= 1;
        counts.flipped += turn[f];
    }
    if (counts.flipped == 0) return counts;

    // A turned face runs through its half-edges backwards: the first and the last change names.
    const auto name = [&](uint32_t h) { return h != kNone && turn[h / 3] ? 3 * (h / 3) + 2 - h % 3 : h; };
    std::vector<uint32_t> renamed(twin.size());
    for (uint32_t h = 0; h < twin.size(); ++h) renamed[name(h)] = name(twin[h]);
    twin = std::move(renamed);
    for (uint32_t f = 0; f < places.size(); ++f) {
        if (!turn[f]) continue;
        std::swap(triangles[f][1], triangles[f][2]);
        std::swap(places[f][1], places[f][2]);
    }
    return counts;
}

}  // namespace gim
