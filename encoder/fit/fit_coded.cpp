// A round linearises the distances (fitter.h) around the samples. Then it minimises over the change y of their
// coordinates in the codec's own basis (fit_codec.h)
//
//     E(P S y) + sum_i price(c_i) (c_i + y_i)^2
//
// E is the sampled distances, S the wavelet synthesis, P the closing of the seams, and c the current coordinates. Then the round steps as far as nothing folds over. The price is the quadratic that touches
// bits(c) = kBits log2(1 + (c / (kNarrow step))^2) at c_i, times the worth of a bit: at high rates one more bit for
// each coefficient of step q lowers the error of a sample, q^2 / 12, by 2 ln 2 of it.
//
// The last rounds hold the tangential details at their quantized values. So do some rounds in between, because the
// details that a coarse quantizer leaves are a better start than unquantized ones. 8 free rounds and 3 held ones give 6
// to 8 % more bytes than 16 and 5, two of these in between. Still more rounds give 1 to 4 % less.
#include "encoder/fit/fit_coded.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "encoder/base/parallel.h"
#include "encoder/code/file_units.h"
#include "encoder/fit/prices.h"
#include "encoder/surface/surface_samples.h"

namespace gim {

namespace {

using Coordinates = ImageBasis::Coordinates;

// Unfolding makes details cheaper and folds fewer, but takes samples away from where they fit best. A full fit that
// nothing precedes unfolds before each free round. In a search, quick fits precede and full ones follow each other. There
// the first cycle of each moves samples by less than a quantizer would. What is still folded near its end is little,
// and is unfolded at any price.
constexpr double kFirstReach = 0.3;  // in steps of the quantizer
constexpr int kFullUnfoldings = 2;   // before the last free rounds
constexpr double kFarthest = std::numeric_limits<double>::infinity();

// Runs the cycles, then the last rounds. Each part runs its free rounds first, then its held ones.
struct Schedule {
    struct Part {
        int free, held;
    };
    int cycles;
    Part last;

    int rounds() const;
};
constexpr Schedule::Part kCycle = {4, 1};
int Schedule::rounds() const { return cycles * (kCycle.free + kCycle.held) + last.free + last.held; }

Schedule schedule_of(CodedFit::Effort effort, const FitRounds& rounds) {
    const Schedule::Part last{rounds.free, rounds.held};
    switch (effort) {
        case CodedFit::Effort::kSearch:
            return {1, {0, 0}};
        case CodedFit::Effort::kCoarse:
            return {rounds.cycles, {0, 0}};
        case CodedFit::Effort::kRefine:
        case CodedFit::Effort::kAdjust:
            return {0, last};
        case CodedFit::Effort::kFinal:
            break;
    }
    return {rounds.cycles, last};
}

// Part of a distance's pull along the surface, for preconditioning only. From coarse to fine, steps that expect more of it
// come nearer to the minimum (2 % fewer bytes on bunny, horse and dragon at side 257). On small squares they overshoot.
float tangential_pull_of(CodedFit::Effort effort) {
    return effort == CodedFit::Effort::kCoarse || effort == CodedFit::Effort::kRefine ? 0.3f : 0.1f;
}

// The price spreads samples evenly where the surface is curved. Where it is flat, nothing else keeps rows of samples from
// crowding. More than 0.01 takes bytes.
constexpr double kMembrane = 0.005;
// Samples of the reference per face. Rounds that others follow take fewer: what they miss, the others find.
constexpr double kDensity = 1.5, kSparse = 0.75;
constexpr double kTolerance = 1e-4;

double dot(const Coordinates& a, const Coordinates& b) {
    return parallel_sum(a.size(), 0, [&](size_t i) { return double{a[i]} * double{b[i]}; });
}

template <class Body>
void for_all(size_t count, const Body& body) {
    parallel_blocks(count, 16384, 0, [&](size_t, size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) body(i);
    });
}

// The energy of one round as a function of coordinates: S, then P, then the matrix of the distances.
class CoordinateSystem {
  public:
    CoordinateSystem(const FitSystem& system, const ImageBasis& basis, const FitCodec& codec)
        : system_(system), basis_(basis), codec_(codec) {
        for (size_t k = 0; k < 3; ++k) {
            in_[k].resize(system.right.size());
            out_[k].resize(system.right.size());
        }
    }

    std::vector<float> image_of(const Coordinates& y) const {
        std::vector<float> image = basis_.synthesize(y);
        codec_.close(image);
        return image;
    }
    // Returns the right side times `scale`.
    Coordinates right(float scale) const {
        std::vector<float> image(3 * system_.right.size());
        for (size_t i = 0; i < image.size(); ++i)
            image[i] = scale * static_cast<float>(system_.right[i / 3][static_cast<int>(i % 3)]);
        return coordinates_of(std::move(image));
    }
    Coordinates apply(const Coordinates& y) {
        std::vector<float> image = image_of(y);
        for_all(system_.right.size(), [&](size_t i) {
            for (size_t k = 0; k < 3; ++k) in_[k][i] = image[3 * i + k];
        });
        system_.matrix.multiply(in_, out_);
        for_all(system_.right.size(), [&](size_t i) {
            for (size_t k = 0; k < 3; ++k) image[3 * i + k] = out_[k][i];
        });
        return coordinates_of(std::move(image));
    }

  private:
    Coordinates coordinates_of(std::vector<float> image) const {
        codec_.close_transposed(image);
        return basis_.transposed(std::move(image));
    }

    const FitSystem& system_;
    const ImageBasis& basis_;
    const FitCodec& codec_;
    Channels in_, out_;
};

// Returns the change of the coordinates, by conjugate gradients. c: the current coordinates.
Coordinates minimise(CoordinateSystem& system, const Prices& prices, const Coordinates& c, float scale,
                     int most_steps) {
    Coordinates y(c.size(), 0.0f), residual = system.right(scale), z(c.size());
    const auto precondition = [&] { for_all(z.size(), [&](size_t i) { z[i] = prices.inverse[i] * residual[i]; }); };
    for_all(c.size(),
            [&](size_t i) { residual[i] = prices.inverse[i] > 0 ? residual[i] - prices.price[i] * c[i] : 0; });
    precondition();
    Coordinates direction = z;
    double rz = dot(residual, z);
    const double goal = kTolerance * rz;
    for (int k = 0; k < most_steps && rz > goal; ++k) {
        Coordinates image = system.apply(direction);
        for_all(image.size(),
                [&](size_t i) { image[i] = prices.inverse[i] > 0 ? image[i] + prices.price[i] * direction[i] : 0; });
        const double curvature = dot(direction, image);
        if (!(curvature > 0)) break;
        const auto alpha = static_cast<float>(rz / curvature);
        for_all(y.size(), [&](size_t i) {
            y[i] += alpha * direction[i];
            residual[i] -= alpha * image[i];
        });
        precondition();
        const double before = rz;
        rz = dot(residual, z);
        const auto beta = static_cast<float>(rz / before);
        for_all(y.size(), [&](size_t i) { direction[i] = z[i] + beta * direction[i]; });
    }
    return y;
}

}  // namespace

struct CodedFit::Impl {
    Impl(const GeometryImage& start, std::shared_ptr<const FitSurface> fit_surface, uint64_t first_seed,
         const Rails& rails, const FitRounds& fit_rounds)
        : gluing(start.gluing),
          surface(std::move(fit_surface)),
          frame(surface->frame),
          fitter(start.positions, surface->reference, gluing, frame, {.rails = rails}),
          first_positions(fitter.positions()),
          seed(first_seed),
          plan(fit_rounds) {}

    GridGluing gluing;
    std::shared_ptr<const FitSurface> surface;
    FitFrame frame;
    Fitter fitter;
    std::vector<Vec3> first_positions;  // in the frame
    uint64_t seed;
    FitRounds plan;
    uint64_t rounds = 0;
    std::vector<Vec3> cycled_positions;  // from the last final fit, before its last rounds; in the frame
    uint64_t cycled_rounds = 0;
    std::unique_ptr<FitCodec> codec;

    void keep_as_cycled() {
        cycled_positions = fitter.positions();
        cycled_rounds = rounds;
    }
    void back_to_cycled() {
        if (cycled_positions.empty()) return;
        fitter.place(cycled_positions);
        rounds = cycled_rounds;
    }

    std::vector<Vec3> positions() const {
        std::vector<Vec3> positions;
        for (const Vec3& p : fitter.positions()) positions.push_back(frame.out_of(p));
        return positions;
    }
    std::vector<float> samples_in(const Units& units) const { return to_units<float>(positions(), units); }

    // Unfolds, but moves no sample farther than `reach` (in the frame). 0: does nothing.
    void unfold(double reach) {
        if (reach > 0) fitter.unfold(reach);
    }

    // Runs one round (see the head of this file). tangential_pull: as Prices.
    void round(const Units& units, Free free, float tangential_pull, double density) {
        const FitSystem system = fitter.linearise(kMembrane, density, mix_bits(seed) + 2 * rounds++);
        const DetailCoding coding = detail_coding_of(units);
        const std::vector<float> image = samples_in(units);
        const auto [basis, c] = codec->coordinates(image, coding);
        const auto unit = static_cast<float>(double{units.step} * frame.scale);  // a unit's length in the frame
        CoordinateSystem coordinates(system, *basis, *codec);
        const Prices prices(*basis, c, coding.quantizer, free, tangential_pull);
        const Coordinates y = minimise(coordinates, prices, c, 1 / unit, plan.steps);
        codec->follow(y);
        const std::vector<float> change = coordinates.image_of(y);
        std::vector<Vec3> step(fitter.positions().size());
        for (size_t i = 0; i < change.size(); ++i) step[i / 3][static_cast<int>(i % 3)] = double{unit * change[i]};
        fitter.take_step(step, true);
    }

    // Moves samples to where a decoder would put them.
    void quantize(const Units& units, bool mends_folds) {
        fitter.place(codec->decoded(samples_in(units), units, mends_folds));
    }
};

CodedFit::~CodedFit() = default;
CodedFit::CodedFit(CodedFit&&) noexcept = default;
CodedFit& CodedFit::operator=(CodedFit&&) noexcept = default;

FitSurface::FitSurface(const Mesh& mesh) : frame(mesh), reference(Mesh{frame.into(mesh.positions), mesh.triangles}) {}

CodedFit::CodedFit(const GeometryImage& start, const MakeFitCodec& make_codec, const Mesh& reference, uint64_t seed,
                   const Rails& rails, const FitRounds& rounds)
    : CodedFit(start, make_codec, std::make_shared<const FitSurface>(reference), seed, rails, rounds) {}

CodedFit::CodedFit(const GeometryImage& start, const MakeFitCodec& make_codec,
                   std::shared_ptr<const FitSurface> surface, uint64_t seed, const Rails& rails,
                   const FitRounds& rounds)
    : impl_(std::make_unique<Impl>(start, std::move(surface), seed, rails, rounds)) {
    impl_->codec = make_codec({impl_->gluing, impl_->surface->reference, impl_->frame, impl_->fitter.front()});
}

void CodedFit::restart() { impl_->fitter.place(impl_->first_positions); }

void CodedFit::forget() {
    impl_->fitter.begin_at(impl_->first_positions);
    impl_->rounds = 0;
    impl_->cycled_positions.clear();
}

void CodedFit::repair(std::span<Pyramid<int32_t>> bands, const Units& units) { impl_->codec->repair(bands, units); }

std::vector<Vec3> CodedFit::run(const Units& units, Effort effort, const Progress& progress) {
    const Schedule schedule = schedule_of(effort, impl_->plan);
    int done = 0;
    const bool is_alone = impl_->rounds == 0 && effort != Effort::kSearch;
    const double first_reach = kFirstReach * double{units.quantizer} * double{units.step} * impl_->frame.scale;
    // reach: how far the unfolding before a free round may move samples; before the last ones of all, as far as it takes.
    // Cycles mend no folds, since later rounds would undo that.
    const auto rounds = [&](const Schedule::Part& part, double reach, bool is_last) {
        const int full = is_last ? kFullUnfoldings : 0;
        const int few = impl_->fitter.is_large() ? part.free / 2 : 0;
        const int sparse = is_last || effort == Effort::kSearch ? few : part.free + part.held;
        for (int k = 0; k < part.free + part.held; ++k) {
            if (progress) progress(Stage::kFit, double(done++) / schedule.rounds());
            const Free free = k < part.free ? Free::kAll : Free::kNormals;
            if (free == Free::kNormals) impl_->quantize(units, is_last);
            if (free == Free::kAll) impl_->unfold(is_alone || k >= part.free - full ? kFarthest : reach);
            impl_->round(units, free, tangential_pull_of(effort), k < sparse ? kSparse : kDensity);
        }
    };
    if (effort == Effort::kAdjust) impl_->back_to_cycled();
    for (int cycle = 0; cycle < schedule.cycles; ++cycle) rounds(kCycle, cycle == 0 ? first_reach : 0, false);
    if (effort == Effort::kFinal || effort == Effort::kRefine) impl_->keep_as_cycled();
    rounds(schedule.last, 0, true);
    return positions();
}

uint64_t CodedFit::folds() const { return impl_->fitter.folds(); }

double CodedFit::distance() const {
    const FitQuality quality = impl_->fitter.quality();
    return std::max(quality.to_image, quality.to_reference) / impl_->frame.scale;
}

std::vector<Vec3> CodedFit::positions() const { return impl_->positions(); }

void CodedFit::place(const std::vector<Vec3>& positions) {
    std::vector<Vec3> placed = impl_->frame.into(positions);
    for (const auto& members : impl_->gluing.shared) {
        Vec3 sum = Vec3::Zero();
        for (const uint32_t v : members) sum += placed[v];
        for (const uint32_t v : members) placed[v] = sum / static_cast<double>(members.size());
    }
    impl_->fitter.place(std::move(placed));
}

}  // namespace gim
