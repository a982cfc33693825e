#include "decoder/refine/patches.h"

namespace gim {
namespace {

struct CellAt {
    uint32_t tile, row, column, exponent;
    uint32_t size() const { return 1u << exponent; }
};

// A cell as one patch.
struct Whole {
    bool is_one = false;
    uint8_t inside = 0, finer = 0;

    bool is_finer(uint32_t border) const { return (finer >> border & 1) != 0; }
};

class PatchWalk {
  public:
    PatchWalk(const RefinedMesh& mesh, PatchList* list) : mesh_(mesh), domain_(mesh.domain()), list_(list) {}

    void run() {
        const auto exponent = static_cast<uint32_t>(domain_.shape().most_splits() / 2);
        for (uint32_t t = 0; t < domain_.shape().tiles; ++t) {
            const CellAt tile{t, 0, 0, exponent};
            const Whole whole = visit(tile);
            if (whole.is_one) add(tile, whole);
        }
    }

  private:
    // Adds the patches of the cell, unless it can be one; then that is the caller's to add.
    Whole visit(const CellAt& cell) {
        if (!has_centre(cell)) {
            Whole whole{true, 0, 0};
            for (uint32_t border = 0; border < 4; ++border)
                whole.finer = static_cast<uint8_t>(whole.finer | (is_divided_beyond(cell, border) ? 1u << border : 0));
            return whole;
        }
        Whole parts[4];
        for (uint32_t q = 0; q < 4; ++q) parts[q] = visit(quarter(cell, q));
        const Whole whole = joined(parts);
        if (whole.is_one) return whole;
        for (uint32_t q = 0; q < 4; ++q) {
            if (parts[q].is_one) add(quarter(cell, q), parts[q]);
        }
        return {};
    }

    // Quarters of equal fineness are one patch if each border is as fine in both of its halves.
    static Whole joined(const Whole (&parts)[4]) {
        Whole whole{true, static_cast<uint8_t>(parts[0].inside + 1), 0};
        for (uint32_t q = 0; q < 4; ++q) {
            const Whole &part = parts[q], &next = parts[(q + 1) % 4];
            if (!part.is_one || part.inside != parts[0].inside || part.is_finer(q) != next.is_finer(q)) return {};
            if (part.is_finer(q)) whole.finer = static_cast<uint8_t>(whole.finer | 1u << q);
        }
        return whole;
    }

    // Quarters follow each other around the cell; border q runs along quarters q and q + 1.
    static CellAt quarter(const CellAt& cell, uint32_t q) {
        const uint32_t half = cell.size() / 2;
        return {cell.tile, cell.row + (q >= 2 ? half : 0), cell.column + (q == 1 || q == 2 ? half : 0),
                cell.exponent - 1};
    }

    bool is_there(uint32_t tile, uint32_t row, uint32_t column) const {
        return mesh_.level(domain_.vertex_at(tile, row, column)) != kNoVertexLevel;
    }
    bool has_centre(const CellAt& cell) const {
        const uint32_t half = cell.size() / 2;
        return half > 0 && is_there(cell.tile, cell.row + half, cell.column + half);
    }

    // Whether the cell of the same size on the other side of a border has its centre.
    bool is_divided_beyond(const CellAt& cell, uint32_t border) const {
        if (cell.exponent == 0) return false;
        const uint32_t n = domain_.shape().intervals, size = cell.size(), half = size / 2;
        const bool is_outer[4] = {cell.row == 0, cell.column + size == n, cell.row + size == n, cell.column == 0};
        if (!is_outer[border]) {
            const uint32_t row = border == 0 ? cell.row - half : border == 2 ? cell.row + size + half : cell.row + half;
            const uint32_t column = border == 3   ? cell.column - half
                                    : border == 1 ? cell.column + size + half
                                                  : cell.column + half;
            return is_there(cell.tile, row, column);
        }
        const uint32_t mate = domain_.glue().mate[4 * cell.tile + border];
        if (mate == kNoMate) return false;
        // Places along a side count from where its half-edge starts, and the mate runs back.
        const uint32_t along[4] = {cell.column + half, cell.row + half, n - cell.column - half, n - cell.row - half};
        const uint32_t t = n - along[border];
        const uint32_t places[4][2] = {{half, t}, {t, n - half}, {n - half, n - t}, {n - t, half}};
        return is_there(tile_of(mate), places[side_of(mate)][0], places[side_of(mate)][1]);
    }

    void add(const CellAt& cell, const Whole& whole) {
        const uint32_t row = domain_.shape().row_of(cell.tile) + cell.row;
        const uint32_t column = domain_.shape().column_of(cell.tile) + cell.column;
        list_->add({static_cast<uint16_t>(column), static_cast<uint16_t>(row), static_cast<uint8_t>(cell.exponent),
                    whole.inside, whole.finer, 0});
    }

    const RefinedMesh& mesh_;
    const QuadDomain& domain_;
    PatchList* list_;
};

}  // namespace

void list_patches(const RefinedMesh& mesh, PatchList* list) { PatchWalk(mesh, list).run(); }

}  // namespace gim
