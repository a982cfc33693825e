// The end of every encoding: images to bytes that meet the rate target, and the figures of the run.
#pragma once

#include <tbb/task_arena.h>

#include <exception>
#include <functional>
#include <memory>
#include <new>
#include <string>

#include "encoder/base/stage_clock.h"
#include "encoder/fit/fit_coded.h"
#include "encoder/planes/make_planes.h"
#include "encoder/squares/write_squares.h"
#include "encoder/surface/mesh.h"
#include "gim/encoder.h"

namespace gim {

// Ranges of EncodeOptions.
Result<bool> check_options(const EncodeOptions& options);

// What is coded: images of one layout or another.
struct CodingJob {
    std::function<Result<std::unique_ptr<FileWriter>>(const CodingParameters&)> make_writer;
    std::function<Result<std::vector<CodedPlane>>(const PlaneMaker&)> make_planes;
    // Fits what is coded to the quantizer of the parameters; writers made afterwards code the result. Empty: no such fit.
    std::function<Result<bool>(const CodingParameters&, CodedFit::Effort)> fit = nullptr;
    // The next fit begins from the start. Not empty where fit is not.
    std::function<void()> restart_fit = nullptr;
};

// Codes to the target of the options, judging the decoded surface against `reference`, and completes the report.
// `input`: the mesh as read, for its colours.
Result<Encoded> finish_encoding(const CodingJob& job, Mesh reference, const TriangleMesh& input,
                                const EncodeOptions& options, StageClock& clock, Encoded encoded);

// Runs body on `threads` threads (0: all cores) and turns what it throws into an Error: nothing leaves a public function.
template <class Body>
Result<Encoded> guarded(uint32_t threads, const Body& body) {
    try {
        tbb::task_arena arena(threads == 0 ? tbb::task_arena::automatic : static_cast<int>(threads));
        return arena.execute(body);
    } catch (const std::bad_alloc&) {
        return Error{Stage::kInput, "out of memory; take a smaller mesh or a smaller --size"};
    } catch (const std::exception& e) {
        return Error{Stage::kInput, std::string("internal error: ") + e.what()};
    }
}

}  // namespace gim
