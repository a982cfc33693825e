// Codes the borders of a level's charts and how they are zipped together. Encoder and decoder share this traversal,
// each with its own coder.  spec/gim-format.md, "Borders".
// Sander, Wood, Gortler, Snyder, Hoppe. Multi-Chart Geometry Images. SGP 2003. Section 4.5 (zippering).
//
// The paper stores a bitmask. A chart is a disk, so its border says as much: a closed walk in eight directions, coded
// as changes of direction (after: Freeman. On the Encoding of Arbitrary Geometric Configurations. 1961). Triangles lie
// on its left if columns run along x and rows along y. The walk is cut into paths. Each path follows the one of the next
// coarser level, which tells where it is likely to turn. After the walk come the steps that zip each path to its mate, if
// that was coded before.
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

// Classes of where the coarser border leads (BorderGuide).
inline constexpr uint32_t kGuideClasses = 12;

struct BorderModels {
    std::array<std::array<BitModel, 4>, 45> turn;               // at the coarsest level: by the turns before
    std::array<std::array<BitModel, 4>, kGuideClasses> guided;  // at the others: by where the coarser border leads
    std::array<std::array<BitModel, 25>, 4> length;  // at the coarsest level: of paths without a known mate, and with
                                                     // one; at the others: likewise
    std::array<BitModel, 25> start;                  // of the first sample, at the others
    std::array<std::array<BitModel, 15>, 2> zip;     // whether kBoth; else which of the other two
};

// A path at the level that is coded.
struct BorderPath {
    uint32_t mate = kNoMate;  // number of the path, or kNoMate
    uint32_t length = 0;      // samples from its begin node to its end node, the begin not counted
    uint32_t first = 0;       // index of its begin node in BorderChart::samples
    uint32_t chart = 0;
    uint32_t coarse_length = 0, coarse_first = 0;  // the same at the next coarser level

    // What was coded last guides the next finer level.
    void keep_as_coarse() {
        coarse_length = length;
        coarse_first = first;
    }
};

// One chart's place in the arrays of its level.
struct BorderChart {
    uint32_t columns = 0, rows = 0;  // of its box at this level
    uint32_t first_path = 0, path_count = 0;
    uint32_t border_length = 0;   // filled in by a decoder
    uint32_t* samples = nullptr;  // border samples in order, as row * columns + column; room for columns * rows of them
    // The border of the next coarser level, in order, as row * coarse_columns + column. Null at the coarsest level.
    const uint32_t* coarse = nullptr;
    uint32_t coarse_columns = 0, coarse_border_length = 0;
};

// Where the border of the next coarser level leads. Follows one path from its begin node to its end node.
class BorderGuide {
  public:
    BorderGuide(const BorderChart& chart, const BorderPath& path) : chart_(chart), path_(path) {
        if (!chart.coarse) return;
        here_ = sample(0);
        next_ = sample(1);
    }

    // Returns the class of the angle from the direction of the last step to where the coarser border goes on, seen from
    // a sample of this level.
    uint32_t look(uint32_t column, uint32_t row, uint32_t direction) {
        while (at_ < path_.coarse_length && distance(next_, column, row) <= distance(here_, column, row)) {
            ++at_;
            here_ = next_;
            if (at_ < path_.coarse_length) next_ = sample(at_ + 1);
        }
        const int64_t x = next_[0] - int64_t{column}, y = next_[1] - int64_t{row};
        const auto [dx, dy] = kDirections[direction];
        return angle_class(dx * x + dy * y, dx * y - dy * x);
    }

  private:
    // Quarters of a right angle: 5 straight ahead, 1 .. 4 to the right, 6 .. 9 to the left. 0 and 10 are backwards, 11
    // is no direction.
    static uint32_t angle_class(int64_t ahead, int64_t left) {
        if (ahead == 0 && left == 0) return kGuideClasses - 1;
        const int64_t side = left < 0 ? -left : left;
        uint32_t size = 5;
        if (5 * side < ahead) {
            size = 0;
        } else if (3 * side < 2 * ahead) {
            size = 1;
        } else if (2 * side < 3 * ahead) {
            size = 2;
        } else if (side < 5 * ahead) {
            size = 3;
        } else if (side > -5 * ahead) {
            size = 4;
        }
        return left < 0 ? 5 - size : 5 + size;
    }
    // Column and row of sample k of the coarser path, in samples of this level.
    std::array<int64_t, 2> sample(uint32_t k) const {
        uint32_t i = path_.coarse_first + k;
        if (i >= chart_.coarse_border_length) i -= chart_.coarse_border_length;
        const uint32_t at = chart_.coarse[i];
        return {2 * int64_t{at % chart_.coarse_columns}, 2 * int64_t{at / chart_.coarse_columns}};
    }
    static int64_t distance(const std::array<int64_t, 2>& a, uint32_t column, uint32_t row) {
        const int64_t x = a[0] - int64_t{column}, y = a[1] - int64_t{row};
        return x * x + y * y;
    }

    const BorderChart& chart_;
    const BorderPath& path_;
    uint32_t at_ = 0;                         // the sample of the coarser path that is near
    std::array<int64_t, 2> here_{}, next_{};  // it and the one behind it; equal at the end
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
    bool code_start(const BorderChart& chart, uint32_t* column, uint32_t* row);
    bool code_length(BorderPath& path, const BorderPath* paths, uint32_t number, bool is_guided);
    bool code_difference(std::array<BitModel, 25>& models, int64_t* difference);
    bool code_number(std::array<BitModel, 25>& models, uint32_t* value);
    int32_t code_turn(std::array<BitModel, 4>& models, int32_t known);
    std::array<BitModel, 4>& models_by_turns();

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

// Codes a difference: 0, 1, -1, 2, -2 .. as 0, 1, 2, 3, 4 ..
template <class Coder>
bool BorderCoder<Coder>::code_difference(std::array<BitModel, 25>& models, int64_t* difference) {
    const int64_t size = *difference < 0 ? -*difference : *difference;
    auto coded = static_cast<uint32_t>(*difference > 0 ? 2 * size - 1 : 2 * size);
    if (!code_number(models, &coded)) return false;
    const int64_t half = (int64_t{coded} + 1) / 2;
    *difference = coded % 2 != 0 ? half : -half;
    return true;
}

template <class Coder>
bool BorderCoder<Coder>::code_length(BorderPath& path, const BorderPath* paths, uint32_t number, bool is_guided) {
    const bool has_first = path.mate < number;
    if (!is_guided && !has_first) {
        uint32_t coded = path.length - 1;
        if (!code_number(models_.length[0], &coded)) return false;
        path.length = coded + 1;
        return true;
    }
    const int64_t expected = is_guided ? 2 * int64_t{path.coarse_length} : int64_t{paths[path.mate].length};
    int64_t difference = int64_t{path.length} - expected;
    if (!code_difference(models_.length[(is_guided ? 2u : 0u) + (has_first ? 1u : 0u)], &difference)) return false;
    if (expected + difference < 1) return false;
    path.length = static_cast<uint32_t>(expected + difference);
    return true;
}

// Codes a turn of -3 .. 3 eighths of a full turn.
template <class Coder>
int32_t BorderCoder<Coder>::code_turn(std::array<BitModel, 4>& models, int32_t known) {
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

// The models of a turn without a guide.
template <class Coder>
std::array<BitModel, 4>& BorderCoder<Coder>::models_by_turns() {
    const auto sign = [](int32_t t) { return t > 0 ? 2u : t < 0 ? 0u : 1u; };
    const uint32_t last = turns_[0] > 1 ? 4u : turns_[0] < -1 ? 3u : sign(turns_[0]);
    return models_.turn[(last * 3 + sign(turns_[1])) * 3 + sign(turns_[2])];
}

// Codes the first sample of a chart's border.
template <class Coder>
bool BorderCoder<Coder>::code_start(const BorderChart& chart, uint32_t* column, uint32_t* row) {
    if (!chart.coarse) {
        *column = coder_.code_raw(*column, static_cast<uint32_t>(std::bit_width(chart.columns - 1)));
        *row = coder_.code_raw(*row, static_cast<uint32_t>(std::bit_width(chart.rows - 1)));
    } else {
        const int64_t near_column = 2 * int64_t{chart.coarse[0] % chart.coarse_columns},
                      near_row = 2 * int64_t{chart.coarse[0] / chart.coarse_columns};
        int64_t right = *column - near_column, down = *row - near_row;
        if (!code_difference(models_.start, &right) || !code_difference(models_.start, &down)) return false;
        if (near_column + right < 0 || near_row + down < 0) return false;
        *column = static_cast<uint32_t>(near_column + right);
        *row = static_cast<uint32_t>(near_row + down);
    }
    return *column < chart.columns && *row < chart.rows;
}

template <class Coder>
bool BorderCoder<Coder>::code_border(BorderChart& chart, BorderPath* paths) {
    const uint32_t start = chart.samples[0];
    uint32_t column = 0, row = 0;
    if constexpr (Coder::kWrites) column = start % chart.columns, row = start / chart.columns;
    if (!code_start(chart, &column, &row)) return false;
    chart.samples[0] = row * chart.columns + column;
    turns_ = {};

    uint32_t done = 0, direction = 0;
    const uint32_t capacity = chart.columns * chart.rows;
    for (uint32_t p = chart.first_path; p < chart.first_path + chart.path_count; ++p) {
        BorderPath& path = paths[p];
        path.first = done;
        if (!code_length(path, paths, p, chart.coarse != nullptr) || path.length > capacity - done) return false;
        BorderGuide guide(chart, path);
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
                auto& models = chart.coarse ? models_.guided[guide.look(column, row, direction)] : models_by_turns();
                direction = (direction + static_cast<uint32_t>(code_turn(models, known))) & 7;
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
