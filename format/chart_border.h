// Codes the borders of a level's charts and how they are zipped together. Encoder and decoder share this traversal,
// each with its own coder.  spec/gim-format.md, "Borders".
// Sander, Wood, Gortler, Snyder, Hoppe. Multi-Chart Geometry Images. SGP 2003. Section 4.5 (zippering).
//
// The paper stores a bitmask. A chart is a disk, so its border says as much: a closed walk in eight directions, coded
// as changes of direction (after: Freeman. On the Encoding of Arbitrary Geometric Configurations. 1961). Triangles lie
// on its left if columns run along x and rows along y. The walk is cut into paths. After it come the steps that zip
// each path to its mate, if that was coded before.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "format/bit_model.h"
#include "format/mate.h"

namespace gim {

// One step of a zipper from sample to sample along two mated paths, the second walked backwards.
enum class ZipStep : uint8_t {
    kBoth = 0,    // goes on along both: their next samples become one surface point
    kFirst = 1,   // goes on along the first path: its next sample joins the current point
    kSecond = 2,  // goes on along the second path, likewise
};

// Steps in columns and rows, counter-clockwise from +column if rows run along y.
inline constexpr std::array<std::array<int32_t, 2>, 8> kDirections{
    {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};

struct BorderModels {
    std::array<std::array<BitModel, 4>, 45> turn;    // by the turns before
    std::array<std::array<BitModel, 25>, 2> length;  // of paths without a known mate, and with one
    std::array<std::array<BitModel, 15>, 2> zip;     // whether kBoth; else which of the other two
};

// A path at the level that is coded.
struct BorderPath {
    uint32_t mate = kNoMate;  // number of the path, or kNoMate
    uint32_t length = 0;      // samples from its begin node to its end node, the begin not counted
    uint32_t first = 0;       // index of its begin node in BorderChart::samples
    uint32_t chart = 0;
};

// One chart's place in the arrays of its level.
struct BorderChart {
    uint32_t columns = 0, rows = 0;  // of its box at this level
    uint32_t first_path = 0, path_count = 0;
    uint32_t border_length = 0;   // filled in by a decoder
    uint32_t* samples = nullptr;  // border samples in order, as row * columns + column; room for columns * rows of them
};

// Coder: as for BandCoder. An encoder brings charts and paths, a decoder fills them in. The functions return false on
// borders that no encoder writes; what they have filled in by then is within bounds.
template <class Coder>
class BorderCoder {
  public:
    BorderCoder(Coder* coder, BorderModels* models) : coder_(*coder), models_(*models) {}

    // Codes the walk along a chart's border. paths: of all charts.
    bool code_border(BorderChart& chart, BorderPath* paths);

    // Codes the zipper of a path (`second`) and its mate (`first`), both walked. Only an encoder calls known(), the
    // next step. glue(i, j) joins sample i of the first path and sample length - j of the second, from (0, 0) on.
    template <class Known, class Glue>
    bool code_zipper(const BorderPath& first, const BorderPath& second, const Known& known, const Glue& glue);

  private:
    bool code_length(BorderPath& path, const BorderPath* paths, uint32_t number);
    bool code_number(std::array<BitModel, 25>& models, uint32_t* value);
    int32_t code_turn(int32_t known);

    Coder& coder_;
    BorderModels& models_;
    std::array<int32_t, 3> turns_{};  // the last three, latest first
};

// ---- implementation ----

template <class Coder>
bool BorderCoder<Coder>::code_number(std::array<BitModel, 25>& models, uint32_t* value) {
    const uint32_t known = *value + 1;
    const uint32_t known_width = static_cast<uint32_t>(std::bit_width(known)) - 1;
    uint32_t width = 0;
    while (coder_.code_bit(models[width], known_width > width)) {
        if (++width == models.size()) return false;
    }
    const uint32_t low = width > 0 ? coder_.code_raw(known & ((1u << width) - 1), width) : 0;
    *value = (1u << width | low) - 1;
    return true;
}

template <class Coder>
bool BorderCoder<Coder>::code_length(BorderPath& path, const BorderPath* paths, uint32_t number) {
    if (path.mate < number) {
        // Codes the difference to the mate's length: 0, 1, -1, 2, -2 .. as 0, 1, 2, 3, 4 ..
        const auto expected = static_cast<int32_t>(paths[path.mate].length);
        const int32_t difference = static_cast<int32_t>(path.length) - expected;
        uint32_t coded =
            difference > 0 ? 2 * static_cast<uint32_t>(difference) - 1 : 2 * static_cast<uint32_t>(-difference);
        if (!code_number(models_.length[1], &coded)) return false;
        const auto half = static_cast<int32_t>((coded + 1) / 2);
        const int32_t length = expected + (coded & 1 ? half : -half);
        if (length < 1) return false;
        path.length = static_cast<uint32_t>(length);
        return true;
    }
    uint32_t coded = path.length - 1;
    if (!code_number(models_.length[0], &coded)) return false;
    path.length = coded + 1;
    return true;
}

// Codes a turn of -3 .. 3 eighths of a full turn.
template <class Coder>
int32_t BorderCoder<Coder>::code_turn(int32_t known) {
    const auto sign = [](int32_t t) { return t > 0 ? 2u : t < 0 ? 0u : 1u; };
    const uint32_t last = turns_[0] > 1 ? 4u : turns_[0] < -1 ? 3u : sign(turns_[0]);
    auto& models = models_.turn[(last * 3 + sign(turns_[1])) * 3 + sign(turns_[2])];
    int32_t turn = 0;
    if (coder_.code_bit(models[0], known != 0)) {
        const bool right = coder_.code_bit(models[1], known < 0);
        const int32_t size = known < 0 ? -known : known;
        turn = 1;
        while (turn < 3 && coder_.code_bit(models[1 + static_cast<size_t>(turn)], size > turn)) ++turn;
        if (right) turn = -turn;
    }
    turns_ = {turn, turns_[0], turns_[1]};
    return turn;
}

template <class Coder>
bool BorderCoder<Coder>::code_border(BorderChart& chart, BorderPath* paths) {
    const uint32_t start = chart.samples[0];
    const uint32_t column_bits = static_cast<uint32_t>(std::bit_width(chart.columns - 1)),
                   row_bits = static_cast<uint32_t>(std::bit_width(chart.rows - 1));
    uint32_t column = 0, row = 0;
    if constexpr (Coder::kWrites) column = start % chart.columns, row = start / chart.columns;
    column = coder_.code_raw(column, column_bits);
    row = coder_.code_raw(row, row_bits);
    if (column >= chart.columns || row >= chart.rows) return false;
    chart.samples[0] = row * chart.columns + column;
    turns_ = {};

    uint32_t done = 0, direction = 0;
    const uint32_t capacity = chart.columns * chart.rows;
    for (uint32_t p = chart.first_path; p < chart.first_path + chart.path_count; ++p) {
        BorderPath& path = paths[p];
        path.first = done;
        if (!code_length(path, paths, p) || path.length > capacity - done) return false;
        for (uint32_t k = 0; k < path.length; ++k) {
            uint32_t wanted = 0;  // direction
            if constexpr (Coder::kWrites) {
                const uint32_t to = chart.samples[done + 1 < chart.border_length ? done + 1 : 0];
                const auto dx = static_cast<int32_t>(to % chart.columns) - static_cast<int32_t>(column),
                           dy = static_cast<int32_t>(to / chart.columns) - static_cast<int32_t>(row);
                while (kDirections[wanted][0] != dx || kDirections[wanted][1] != dy) ++wanted;
            }
            if (done == 0) {
                direction = coder_.code_raw(wanted, 3);
            } else {
                const auto known = static_cast<int32_t>((wanted - direction + 3) & 7) - 3;
                direction = (direction + static_cast<uint32_t>(code_turn(known))) & 7;
            }
            const uint32_t to_column = column + static_cast<uint32_t>(kDirections[direction][0]),
                           to_row = row + static_cast<uint32_t>(kDirections[direction][1]);
            if (to_column >= chart.columns || to_row >= chart.rows) return false;  // numbers below 0 wrap round
            column = to_column;
            row = to_row;
            ++done;
            if (done < capacity) chart.samples[done] = row * chart.columns + column;
        }
    }
    // A border has three samples at least and ends where it began.
    if constexpr (!Coder::kWrites) chart.border_length = done;
    return done >= 3 && row * chart.columns + column == chart.samples[0];
}

template <class Coder>
template <class Known, class Glue>
bool BorderCoder<Coder>::code_zipper(const BorderPath& first, const BorderPath& second, const Known& known,
                                     const Glue& glue) {
    const int64_t a_length = first.length, b_length = second.length;
    const int64_t longer = a_length > b_length ? a_length : b_length;
    int64_t a = a_length, b = b_length;  // steps left on each path
    ZipStep step = ZipStep::kBoth;
    glue(0u, 0u);
    while (a > 0 || b > 0) {
        ZipStep wanted = ZipStep::kBoth;
        if constexpr (Coder::kWrites) wanted = known();
        if (a == 0 || b == 0) {
            step = a == 0 ? ZipStep::kSecond : ZipStep::kFirst;
        } else {
            // Which side lags behind, and by how much.
            const int64_t lag = 2 * (a * b_length - b * a_length), size = lag < 0 ? -lag : lag;
            const uint32_t phase = size < longer ? 0 : (lag > 0 ? 1u : 3u) + (size < 3 * longer ? 0u : 1u);
            if (!coder_.code_bit(models_.zip[0][static_cast<uint32_t>(step) * 5 + phase], wanted != ZipStep::kBoth)) {
                step = ZipStep::kBoth;
            } else {
                const bool is_second = coder_.code_bit(models_.zip[1][static_cast<uint32_t>(step) * 5 + phase],
                                                       wanted == ZipStep::kSecond);
                step = is_second ? ZipStep::kSecond : ZipStep::kFirst;
            }
        }
        a -= step != ZipStep::kSecond;
        b -= step != ZipStep::kFirst;
        glue(static_cast<uint32_t>(a_length - a), static_cast<uint32_t>(b_length - b));
    }
    return true;
}

}  // namespace gim
