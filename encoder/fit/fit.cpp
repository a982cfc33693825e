// Fits a geometry image to its surface (fit.h).
//
// A round splits the cells, samples both surfaces by area, and finds the closest points. Then it minimises over the
// displacements dx:
//
//     sum_o w |p - S(x + dx)|^2_W + sum_m w |S(x + dx) - q|^2_W
//         + lambda sum_edges a/4 |T (x_i - x_j)|^2 + mu sum_v a_v |dx|^2
//
// S(x) is the sampled point of the image; p and q are points of the reference. W = n n^T + tau (1 - n n^T). n is the
// face normal if the closest point is inside a face, else the direction to it. T keeps the tangential part. x_i, x_j
// run over grid edges. Then the round steps as far as the guard allows: no steep face may turn further away from the
// reference's normal. lambda falls from round to round, and the number of samples rises. If the start has folds, the
// first rounds begin with unfolding: they relax the samples around folds along the surface.
//
// Everything runs in a frame where the reference's bounding box has diagonal 1.
#include "encoder/fit/fit.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "encoder/base/parallel.h"
#include "encoder/base/result.h"
#include "encoder/fit/fitter.h"
#include "encoder/surface/creases.h"
#include "encoder/surface/refine.h"
#include "encoder/surface/surface_samples.h"

namespace gim {

namespace {

constexpr uint32_t kUnfoldRounds = 4;  // first rounds of a schedule that unfold
constexpr int kLastUnfoldings = 3;     // tries to unfold a fit with more folds than its start, before it is dropped
constexpr uint64_t kSamplesPerFold =
    8000;                              // a fit may add a fold for so many samples, since it removes most of its error
constexpr double kCreased = 0.06;      // unfolding may do harm if more than this part of the surface is at creases
constexpr double kUnfoldPrice = 1.06;  // factor of RMS distance that unfolding may cost: half a decibel

struct Schedule {
    double first_lambda, last_lambda;
    uint32_t rounds;
    double first_density, last_density;  // samples of the reference per face of the image
};

// The stiff lambda makes files of 65 and 70 dB smallest: 0.03 to 0.05 on bunny-closed, horse, gargoyle and rocker-arm.
// 0.08 takes about 1 % more bytes, 0.3 takes 4 to 11 % more.
Schedule schedule_of(const FitOptions& options) {
    Schedule schedule = options.strength == FitOptions::Strength::kStiff ? Schedule{0.05, 0.05, 5, 1, 1.5}
                                                                         : Schedule{0.02, 0.0003, 16, 1, 3.5};
    if (options.thorough && options.strength == FitOptions::Strength::kLoose) schedule = {0.02, 0.0001, 32, 1, 3.5};
    if (options.rounds > 0) schedule.rounds = options.rounds;
    return schedule;
}

Result<void> check_input(const GeometryImage& image, const Mesh& reference, const std::vector<bool>& held) {
    const auto fail = [](const char* message) { return Error{Stage::kFit, message}; };
    if (image.width() < 3 || image.height() < 3 || image.positions.size() != image.gluing.sample_count())
        return fail("the image is not a rectangle of samples");
    if (reference.triangles.empty()) return fail("the mesh to fit to has no triangles");
    if (!held.empty() && held.size() != image.positions.size())
        return fail("the mask of held samples has another size than the image");
    for (const Vec3& p : image.positions) {
        if (!p.allFinite()) return fail("the image has samples that are not finite");
    }
    return {};
}

// few: number of folds that do not matter.
bool no_worse(const FitQuality& after, const FitQuality& before, uint64_t few) {
    return after.to_image <= before.to_image && after.to_reference <= before.to_reference &&
           after.folds <= std::max(before.folds, few);
}

double distance(const FitQuality& quality) { return std::max(quality.to_image, quality.to_reference); }

// Returns the part of the surface within a mean sample spacing of creases.
double crease_share(const Mesh& mesh, double samples) {
    const double area = surface_area(mesh);
    return area > 0 ? 2 * crease_length(mesh) / std::sqrt(area * samples) : 0;
}

// What the first rounds do differently.
struct Plan {
    uint32_t unfolding;  // number of rounds that begin with unfolding
    // Number of rounds that may fold faces over. They free samples that are stuck in a bad place. The guarded rounds
    // that follow unfold more faces than these fold.
    uint32_t unguarded;
};

void run_schedule(Fitter& fitter, const Schedule& schedule, const Plan& plan, uint64_t seed, const Progress& progress) {
    for (uint32_t k = 0; k < schedule.rounds; ++k) {
        if (progress) progress(Stage::kFit, static_cast<double>(k) / schedule.rounds);
        const double t = schedule.rounds > 1 ? static_cast<double>(k) / (schedule.rounds - 1) : 1.0;
        const double lambda = schedule.first_lambda * std::pow(schedule.last_lambda / schedule.first_lambda, t);
        const double density = schedule.first_density + t * (schedule.last_density - schedule.first_density);
        if (k < plan.unfolding) fitter.unfold();
        fitter.round(lambda, density, mix_bits(seed) + 2 * k, k >= plan.unguarded);
    }
}

Fitted fit_in_arena(const GeometryImage& image, const Mesh& input, const FitOptions& options,
                    const Progress& progress) {
    const std::vector<Vec3>& start = image.positions;
    const GridGluing& gluing = image.gluing;
    const FitFrame frame(input);
    const FitReference reference(Mesh{frame.into(input.positions), input.triangles});
    std::optional<Fitter> fitter(std::in_place, start, reference, gluing, frame, options);
    const FitQuality before = fitter->quality();
    const Schedule schedule = schedule_of(options);

    // An image without folds stays so from the first round on. Folds stay if unfolding them costs accuracy.
    std::vector<Plan> plans = {{0, 0}};
    if (before.folds > 0) plans = {{std::min(kUnfoldRounds, schedule.rounds), 0}, {0, schedule.rounds / 2}, {0, 0}};
    // Samples that are relaxed along the surface leave its creases, and not all come back. If that may matter,
    // unfolding is compared with the next plan: for loose fits, and on machined parts.
    const bool compare = before.folds > 0 && !options.thorough &&
                         (options.strength == FitOptions::Strength::kLoose ||
                          crease_share(reference.mesh, static_cast<double>(gluing.defined_count())) > kCreased);
    const uint64_t few = gluing.defined_count() / kSamplesPerFold;
    Fitted result;
    result.positions = start;
    FitQuality after = before;
    for (size_t k = 0; k < plans.size(); ++k) {
        if (k > 0) fitter.emplace(start, reference, gluing, frame, options);
        run_schedule(*fitter, schedule, plans[k], options.seed, k == 0 ? progress : Progress{});
        result.rounds += schedule.rounds;
        FitQuality reached = fitter->quality();
        for (int again = 0; again < kLastUnfoldings && reached.folds > std::max(before.folds, few); ++again) {
            fitter->unfold();
            reached = fitter->quality();
        }
        if (!no_worse(reached, before, few)) continue;
        if (result.improved && kUnfoldPrice * distance(reached) >= distance(after))
            break;  // the unfolded fit is better
        after = reached;
        for (uint32_t v = 0; v < start.size(); ++v) {
            if (gluing.is_defined(v) && !fitter->held()[v]) result.positions[v] = frame.out_of(fitter->positions()[v]);
        }
        const bool compare_with_next = compare && k == 0 && !result.improved;
        result.improved = true;
        if (!compare_with_next) break;
    }
    const auto in_input_unit = [&](FitQuality quality) {
        quality.to_image /= frame.scale;
        quality.to_reference /= frame.scale;
        return quality;
    };
    result.before = in_input_unit(before);
    result.after = in_input_unit(after);
    if (progress) progress(Stage::kFit, 1.0);
    return result;
}

}  // namespace

Result<Fitted> fit(const GeometryImage& start, const Mesh& reference, const FitOptions& options,
                   const Progress& progress) {
    GIM_CHECK(check_input(start, reference, options.held));
    Fitted result;
    with_threads(options.threads, [&] { result = fit_in_arena(start, reference, options, progress); });
    return result;
}

Result<FitQuality> measure_fit(const GeometryImage& image, const Mesh& reference, const std::vector<bool>& held,
                               uint32_t threads) {
    GIM_CHECK(check_input(image, reference, held));
    FitQuality quality;
    with_threads(threads, [&] {
        const FitFrame frame(reference);
        const FitReference scaled(Mesh{frame.into(reference.positions), reference.triangles});
        const std::vector<Vec3> points = frame.into(image.positions);
        ClosestPointTree tree(Mesh{});
        quality = measure(points, image.gluing, scaled, held.empty() ? std::vector<bool>(points.size(), false) : held,
                          front_side(points, image.gluing, scaled), tree);
        quality.to_image /= frame.scale;
        quality.to_reference /= frame.scale;
    });
    return quality;
}

}  // namespace gim
