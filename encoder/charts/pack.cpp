#include "encoder/charts/pack.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <string>

#include "encoder/base/parallel.h"
#include "encoder/base/result.h"
#include "encoder/charts/piece.h"
#include "encoder/charts/squeeze.h"
#include "encoder/surface/surface_samples.h"

namespace gim {

namespace {

// A strip of fixed width that is filled from row 0 on. level(k, row): bit x is set if any of the 2^k samples from x on
// is taken or next to a taken one.
class Strip {
  public:
    Strip(uint32_t width, uint32_t height)
        : width_(width),
          height_(height),
          words_(width / 64 + 1),
          levels_(static_cast<uint32_t>(std::bit_width(width))) {
        bits_.assign(size_t{levels_} * height_ * words_, 0);
    }
    uint32_t height() const { return height_; }

    // Finds the columns at which the piece must not begin in `row`, as bits. Returns false if that is all of them.
    bool free_columns(const Piece& piece, uint32_t row, std::vector<uint64_t>& blocked) const {
        blocked.resize(words_);
        const uint32_t last = width_ - piece.width;
        for (uint32_t w = 0; w < words_; ++w) blocked[w] = ~low_bits(w, last + 1);
        size_t countdown = 4;
        for (const PieceRun& run : piece.scan) {
            const uint32_t k = static_cast<uint32_t>(std::bit_width(run.length)) - 1;
            const uint64_t* source = level(k, row + run.row);
            or_shifted(blocked, source, run.column);
            if (run.length > (1u << k)) or_shifted(blocked, source, run.column + run.length - (1u << k));
            if (--countdown == 0) {
                countdown = 4;
                if (all_set(blocked)) return false;
            }
        }
        return !all_set(blocked);
    }

    void put(const Piece& piece, uint32_t column, uint32_t row) {
        for (const PieceRun& run : piece.runs) {
            const uint32_t y = row + run.row, x = column + run.column;
            set(y, x > 0 ? x - 1 : 0, std::min(x + run.length + 1, width_));
            if (y > 0) set(y - 1, x, x + run.length);
            if (y + 1 < height_) set(y + 1, x, x + run.length);
        }
        for (uint32_t y = row > 0 ? row - 1 : 0; y < std::min(row + piece.height + 1, height_); ++y) update_levels(y);
    }

  private:
    uint64_t* level(uint32_t k, uint32_t row) { return bits_.data() + (size_t{k} * height_ + row) * words_; }
    const uint64_t* level(uint32_t k, uint32_t row) const {
        return bits_.data() + (size_t{k} * height_ + row) * words_;
    }
    // Returns the bits of word w that lie below position `end`.
    static uint64_t low_bits(uint32_t w, uint32_t end) {
        if (end <= w * 64) return 0;
        return end >= w * 64 + 64 ? ~uint64_t{0} : (uint64_t{1} << (end - w * 64)) - 1;
    }
    static bool all_set(const std::vector<uint64_t>& words) {
        return std::all_of(words.begin(), words.end(), [](uint64_t w) { return w == ~uint64_t{0}; });
    }
    void set(uint32_t row, uint32_t begin, uint32_t end) {
        uint64_t* words = level(0, row);
        for (uint32_t w = begin / 64; w <= (end - 1) / 64; ++w) words[w] |= low_bits(w, end) & ~low_bits(w, begin);
    }
    void or_shifted(std::vector<uint64_t>& into, const uint64_t* from_words, uint32_t shift) const {
        const uint32_t skip = shift / 64, bits = shift % 64;
        for (uint32_t w = 0; w + skip < words_; ++w) {
            uint64_t value = from_words[w + skip] >> bits;
            if (bits != 0 && w + skip + 1 < words_) value |= from_words[w + skip + 1] << (64 - bits);
            into[w] |= value;
        }
    }
    void update_levels(uint32_t row) {
        for (uint32_t k = 1; k < levels_; ++k) {
            const uint64_t* below = level(k - 1, row);
            uint64_t* here = level(k, row);
            const uint32_t shift = 1u << (k - 1), skip = shift / 64, bits = shift % 64;
            for (uint32_t w = 0; w < words_; ++w) {
                uint64_t value = below[w];
                if (w + skip < words_) value |= below[w + skip] >> bits;
                if (bits != 0 && w + skip + 1 < words_) value |= below[w + skip + 1] << (64 - bits);
                here[w] = value;
            }
        }
    }

    uint32_t width_, height_, words_, levels_;
    std::vector<uint64_t> bits_;
};

// Says how to make one packing: the strip's width, the order of the charts, and what "low" means for each. 1: its top
// edge is lowest. 0: its centre of gravity is lowest.
struct Recipe {
    uint32_t width = 0;
    std::vector<uint32_t> order;
    std::vector<float> top_weight;
};

struct Attempt {
    std::vector<PieceSpot> spots;  // empty if the packing would be higher than the limit
    uint32_t height = 0;
    double crowding = 0;  // mean top edge; if heights are equal, lower is better
};

// Puts each chart as low as it goes, then as far left. Gives up above `limit` rows.
Attempt try_recipe(const std::vector<Shape>& shapes, const Recipe& recipe, uint32_t limit) {
    Strip strip(recipe.width, limit);
    Attempt attempt;
    attempt.spots.resize(shapes.size());
    std::vector<uint64_t> blocked;
    for (const uint32_t c : recipe.order) {
        double best_cost = std::numeric_limits<double>::infinity();
        PieceSpot best;
        const double weight = recipe.top_weight[c];
        for (uint32_t o = 0; o < shapes[c].size(); ++o) {
            const Piece& piece = shapes[c][o];
            if (piece.width > recipe.width) continue;
            const double offset = weight * piece.height + (1 - weight) * piece.centre;
            for (uint32_t row = 0; row + piece.height <= limit && row + offset < best_cost; ++row) {
                if (!strip.free_columns(piece, row, blocked)) continue;
                uint32_t column = 0;
                while ((blocked[column / 64] >> (column % 64)) & 1) ++column;
                best_cost = row + offset;
                best = {o, column, row};
                break;
            }
        }
        if (!std::isfinite(best_cost)) return {};
        const Piece& piece = shapes[c][best.orientation];
        strip.put(piece, best.column, best.row);
        attempt.spots[c] = best;
        attempt.height = std::max(attempt.height, best.row + piece.height);
        attempt.crowding += (best.row + piece.height) / static_cast<double>(shapes.size());
    }
    return attempt;
}

class Packer {
  public:
    Packer(const std::vector<PackShape>& shapes, const PackOptions& options)
        : input_(shapes), options_(options), random_(mix_bits(options.seed)) {}

    Result<Packing> run(const Progress& progress) {
        double area = 0;
        for (const PackShape& shape : input_)
            area += polygon_area(shape.border) * shape.magnification * shape.magnification;
        if (!(area > 0)) return Error{Stage::kSample, "the charts have no area to pack"};
        // Make a first packing at one scale.
        constexpr double kSmaller = 0.85;
        double scale = std::sqrt(0.8 * options_.most_samples / area) / kSmaller;
        std::vector<Candidate> best;
        for (int trial = 0; best.empty(); ++trial) {
            if (trial == 8) return no_room();
            scale *= kSmaller;
            if (!rasterize(scale) || !all_short()) return report_broken();
            best = explore();
        }
        // Squeeze it, then enlarge it until it is as large as allowed.
        SqueezeOptions squeeze_options;
        squeeze_options.most_moves = uint64_t{options_.effort} * kMovesPerEffort;
        squeeze_options.seed = options_.seed;
        squeeze_options.most_aspect = options_.most_aspect;
        if (progress) progress(Stage::kSample, 0.1);
        const PieceLayout layout = squeeze_several(best, squeeze_options);
        if (progress) progress(Stage::kSample, 0.8);
        return enlarge(layout, scale, squeeze_options);
    }

  private:
    static constexpr uint32_t kMovesPerEffort = 200, kFirstRounds = 4;

    struct Candidate {
        Recipe recipe;
        uint32_t height = 0;
        double crowding = 0;
        double area() const { return static_cast<double>(recipe.width) * height; }
        bool operator<(const Candidate& o) const {
            return area() != o.area() ? area() < o.area() : crowding < o.crowding;
        }
    };

    Error no_room() const {
        return {Stage::kSample, "the charts do not fit into " + std::to_string(options_.most_samples) +
                                    " samples; ask for more samples or fewer charts"};
    }
    static double polygon_area(const std::vector<Vec2>& p) {
        double area = 0;
        for (size_t i = 0; i < p.size(); ++i) {
            const Vec2 &a = p[i], &b = p[(i + 1) % p.size()];
            area += 0.5 * (a.x() * b.y() - a.y() * b.x());
        }
        return area;
    }
    uint32_t random(uint32_t count) {
        random_ = mix_bits(random_);
        return static_cast<uint32_t>(random_ % count);
    }

    // Returns the side of a coarse cell: coarse enough to try all places quickly, fine enough to tell good from bad.
    static uint32_t coarse_cell(double samples) {
        constexpr double kFewestCells = 64;
        uint32_t cell = 2;
        while (cell < 16 && 4.0 * cell * cell * kFewestCells < samples) cell *= 2;
        return cell;
    }
    // Rasterizes chart c in all orientations. If `angle` is given, tries the few about it first. If no orientation can
    // be used, the chart grows by itself. Empty if that does not help.
    Shape rasterize(uint32_t c, double scale, const double* angle) const {
        // A border that is too short grows with the chart. An inlet may or may not open.
        constexpr int kMostGrowths = 40, kMostGrowthsOfNoDisk = 6;
        const double turn = 2 * std::numbers::pi / options_.orientations, near = 2.5 * turn;
        double magnification = input_[c].magnification;
        const uint32_t cell = coarse_cell(polygon_area(input_[c].border) * scale * scale);
        Shape shape;
        for (int growth = 0, no_disk = 0; growth <= kMostGrowths && no_disk <= kMostGrowthsOfNoDisk; ++growth) {
            bool any_disk = false;
            for (uint32_t o = 0; o < options_.orientations; ++o) {
                if (angle && std::cos(o * turn - *angle) < std::cos(near)) continue;
                ChartMask chart = rasterize_chart(input_[c].border, scale * magnification, o * turn);
                any_disk |= chart.is_disk;
                if (chart.is_disk && chart.border_length >= input_[c].least_border)
                    shape.push_back(make_piece(std::move(chart), cell));
            }
            if (!shape.empty()) return shape;
            if (angle) {
                angle = nullptr;
                continue;
            }
            no_disk += !any_disk;
            magnification *= 1.1;
        }
        return shape;
    }
    // Rasterizes all charts. Returns false if any is broken. `angles`: one per chart to keep close to, or none.
    bool rasterize(double scale, const std::vector<double>& angles = {}) {
        shapes_.assign(input_.size(), {});
        parallel_blocks(input_.size(), 1, options_.threads, [&](size_t c, size_t, size_t) {
            const double* angle = angles.empty() ? nullptr : &angles[c];
            shapes_[c] = rasterize(static_cast<uint32_t>(c), scale, angle);
        });
        for (uint32_t c = 0; c < shapes_.size(); ++c) {
            if (shapes_[c].empty()) broken_.push_back(c);
        }
        return broken_.empty();
    }
    // Charts too long for any good rectangle count as broken too. Returns false if there are any.
    bool all_short() {
        constexpr double kLongest = 1.2;  // in sides of the square of all samples
        for (uint32_t c = 0; c < shapes_.size(); ++c) {
            double length = std::numeric_limits<double>::infinity();
            for (const Piece& piece : shapes_[c])
                length = std::min<double>(length, std::max(piece.width, piece.height));
            if (length > kLongest * std::sqrt(options_.most_samples)) broken_.push_back(c);
        }
        return broken_.empty();
    }
    Packing report_broken() const {
        Packing packing;
        packing.broken = broken_;
        return packing;
    }

    bool aspect_is_fine(uint32_t width, uint32_t height) const {
        return width < options_.most_aspect * height && height < options_.most_aspect * width;
    }
    // Tries recipes in parallel. Leaves out those with a forbidden aspect.
    std::vector<Candidate> evaluate(std::vector<Recipe> recipes, double slack) {
        std::vector<Attempt> attempts(recipes.size());
        parallel_blocks(recipes.size(), 1, options_.threads, [&](size_t, size_t begin, size_t end) {
            for (size_t k = begin; k < end; ++k) {
                const auto limit = static_cast<uint32_t>(slack * options_.most_samples / recipes[k].width);
                attempts[k] = try_recipe(shapes_, recipes[k], limit);
            }
        });
        std::vector<Candidate> candidates;
        for (size_t k = 0; k < recipes.size(); ++k) {
            if (attempts[k].spots.empty() || !aspect_is_fine(recipes[k].width, attempts[k].height)) continue;
            candidates.push_back({std::move(recipes[k]), attempts[k].height, attempts[k].crowding});
        }
        return candidates;
    }

    // Keeps a beam of the best recipes and varies them over and over.
    std::vector<Candidate> explore() {
        std::vector<Recipe> recipes;
        std::vector<uint32_t> order(shapes_.size());
        std::iota(order.begin(), order.end(), 0u);
        std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
            return shapes_[a][0].chart.defined > shapes_[b][0].chart.defined;
        });
        constexpr int kWidths = 12;
        for (int k = 0; k <= kWidths; ++k) {
            const double aspect = std::pow(std::min(2.0, options_.most_aspect * 0.97), 2.0 * k / kWidths - 1);
            for (const float weight : {1.0f, 0.5f, 0.0f}) {
                recipes.push_back({static_cast<uint32_t>(std::sqrt(options_.most_samples * aspect)), order,
                                   std::vector<float>(shapes_.size(), weight)});
            }
        }
        constexpr size_t kBeam = 6, kBatch = 16;
        std::vector<Candidate> best = evaluate(std::move(recipes), 1.6);
        std::stable_sort(best.begin(), best.end());
        if (best.size() > kBeam) best.resize(kBeam);
        for (uint32_t round = 0; round < std::min(options_.effort, kFirstRounds) && !best.empty(); ++round) {
            recipes.clear();
            for (size_t k = 0; k < kBatch; ++k)
                recipes.push_back(vary(best[random(static_cast<uint32_t>(best.size()))].recipe));
            for (Candidate& c : evaluate(std::move(recipes), best.back().area() / options_.most_samples))
                best.push_back(std::move(c));
            std::stable_sort(best.begin(), best.end());
            if (best.size() > kBeam) best.resize(kBeam);
        }
        return best;
    }

    Recipe vary(Recipe recipe) {
        const auto count = static_cast<uint32_t>(recipe.order.size());
        if (random(3) == 0)
            recipe.width =
                static_cast<uint32_t>(std::max(1, static_cast<int>(recipe.width) + static_cast<int>(random(11)) - 5));
        if (random(3) == 0) recipe.top_weight[random(count)] = 0.25f * static_cast<float>(random(5));
        for (uint32_t moves = 1 + random(3); moves > 0 && count > 1; --moves) {
            const uint32_t place = random(count), other = random(count);
            if (random(2) == 0) {
                std::swap(recipe.order[place], recipe.order[other]);
            } else {
                const uint32_t chart = recipe.order[place];
                recipe.order.erase(recipe.order.begin() + place);
                recipe.order.insert(recipe.order.begin() + other, chart);
            }
        }
        return recipe;
    }

    PieceLayout layout_of(const Candidate& candidate) const {
        Attempt attempt = try_recipe(shapes_, candidate.recipe, candidate.height);
        return {candidate.recipe.width, attempt.height, std::move(attempt.spots)};
    }

    // Squeezes the best candidates side by side and returns the smallest.
    PieceLayout squeeze_several(const std::vector<Candidate>& best, const SqueezeOptions& options) const {
        constexpr size_t kChains = 4;
        std::vector<PieceLayout> layouts(kChains);
        parallel_blocks(kChains, 1, options_.threads, [&](size_t k, size_t, size_t) {
            SqueezeOptions own = options;
            own.seed = options.seed + k;
            uint64_t moves = 0;
            layouts[k] = squeeze(shapes_, layout_of(best[k % best.size()]), own, moves);
        });
        return *std::min_element(layouts.begin(), layouts.end(),
                                 [](const PieceLayout& a, const PieceLayout& b) { return a.area() < b.area(); });
    }

    // Returns the rectangle of the layout's shape that makes the most of the bound.
    PieceLayout largest_rectangle(const PieceLayout& layout) const {
        const double ideal = layout.width * std::sqrt(options_.most_samples / static_cast<double>(layout.area()));
        PieceLayout result;
        const auto middle = static_cast<uint32_t>(ideal), slack = 1 + middle / 64;
        for (uint32_t width = middle > slack ? middle - slack : 1; width <= middle + slack; ++width) {
            const uint32_t height = options_.most_samples / width;
            if (aspect_is_fine(width, height) && uint64_t{width} * height > result.area())
                result.width = width, result.height = height;
        }
        return result;
    }

    // Takes a layout of `old_shapes` over to shapes_, which have another scale. Centres and angles stay.
    PieceLayout rescaled(const std::vector<Shape>& old_shapes, const PieceLayout& layout, PieceLayout result) const {
        const double across = static_cast<double>(result.width) / layout.width;
        const double down = static_cast<double>(result.height) / layout.height;
        for (size_t c = 0; c < shapes_.size(); ++c) {
            const PieceSpot& spot = layout.spots[c];
            const Piece& old = old_shapes[c][spot.orientation];
            const auto turn = [&](const Piece& piece) {
                if (piece.width > result.width || piece.height > result.height) return 10.0;
                return 1 - std::cos(piece.chart.pose.angle - old.chart.pose.angle);
            };
            const auto nearest = std::min_element(shapes_[c].begin(), shapes_[c].end(),
                                                  [&](const Piece& a, const Piece& b) { return turn(a) < turn(b); });
            if (turn(*nearest) > 2) return {};  // none is small enough for the rectangle
            const auto place = [](double centre, uint32_t extent, uint32_t side) {
                return static_cast<uint32_t>(
                    std::clamp(std::round(centre - 0.5 * extent), 0.0, static_cast<double>(side - extent)));
            };
            result.spots.push_back({static_cast<uint32_t>(nearest - shapes_[c].begin()),
                                    place(across * (spot.column + 0.5 * old.width), nearest->width, result.width),
                                    place(down * (spot.row + 0.5 * old.height), nearest->height, result.height)});
        }
        return result;
    }

    // Packs at the largest scale at which the layout still comes out without overlap.
    Result<Packing> enlarge(const PieceLayout& layout, double scale, SqueezeOptions options) {
        constexpr double kFirstStep = 0.004, kLastStep = 0.0005;
        const std::vector<Shape> shapes = shapes_;
        const PieceLayout rectangle = largest_rectangle(layout);
        std::vector<double> angles;
        for (size_t c = 0; c < shapes.size(); ++c)
            angles.push_back(shapes[c][layout.spots[c].orientation].chart.pose.angle);
        options.most_moves /= 4;
        double best_scale = 0, step = kFirstStep;
        double trial = scale * std::sqrt(static_cast<double>(rectangle.area()) / static_cast<double>(layout.area()));
        std::optional<Packing> packed;
        for (int round = 0; round < 60 && step >= kLastStep; ++round) {
            if (!rasterize(trial, angles)) return report_broken();
            PieceLayout next = rescaled(shapes, layout, rectangle);
            uint64_t moves = 0;
            if (!next.spots.empty()) next = separate(shapes_, std::move(next), options, moves);
            if (!next.spots.empty()) {
                packed = finish(trial, next);
                best_scale = trial;
            } else if (packed) {
                step /= 2;
            }
            trial = packed ? best_scale * (1 + step) : trial * (1 - step);
        }
        if (!packed) return no_room();
        return std::move(*packed);
    }

    Packing finish(double scale, const PieceLayout& layout) const {
        Packing packing;
        packing.scale = scale;
        packing.width = layout.width;
        packing.height = layout.height;
        for (size_t c = 0; c < layout.spots.size(); ++c) {
            const PieceSpot& spot = layout.spots[c];
            PlacedChart placed{shapes_[c][spot.orientation].chart, spot.column, spot.row};
            placed.chart.pose.offset += Vec2(spot.column, spot.row);
            packing.defined += placed.chart.defined;
            packing.charts.push_back(std::move(placed));
        }
        return packing;
    }

    const std::vector<PackShape>& input_;
    const PackOptions& options_;
    uint64_t random_;
    std::vector<Shape> shapes_;
    std::vector<uint32_t> broken_;
};

}  // namespace

std::vector<uint32_t> owners_of(const Packing& packing) {
    std::vector<uint32_t> owner(size_t{packing.width} * packing.height, kNone);
    for (uint32_t c = 0; c < packing.charts.size(); ++c) {
        const PlacedChart& placed = packing.charts[c];
        const SampleMask& mask = placed.chart.mask;
        for (uint32_t i = 0; i < mask.defined.size(); ++i) {
            if (mask.defined[i])
                owner[size_t{placed.row + i / mask.width} * packing.width + placed.column + i % mask.width] = c;
        }
    }
    return owner;
}

Result<Packing> pack(const std::vector<PackShape>& shapes, const PackOptions& options, const Progress& progress) {
    if (shapes.empty()) return Error{Stage::kSample, "there are no charts to pack"};
    return Packer(shapes, options).run(progress);
}

}  // namespace gim
