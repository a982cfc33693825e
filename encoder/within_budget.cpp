#include "encoder/within_budget.h"

#include <string>

#include "encoder/code/rate_target.h"

namespace gim {

Result<Encoded> within_budget(const EncodeOptions& options,
                              const std::function<Result<Encoded>(const EncodeOptions&)>& run) {
    auto encoded = run(options);
    const bool may_be_too_few =
        options.rate.kind == RateTarget::Kind::kBytes && !encoded.ok() && encoded.error().stage == Stage::kCode;
    if (!may_be_too_few) return encoded;
    EncodeOptions fewest = options;
    fewest.rate.value = kFewestBytes;
    fewest.try_smaller_sides = false;
    auto least = run(fewest);
    if (!least.ok()) return encoded;
    const size_t size = least.value().bytes.size();
    if (double(size) <= options.rate.value) return least;
    return Error{Stage::kCode, std::to_string(static_cast<uint64_t>(options.rate.value)) +
                                   " bytes are too few: the smallest file of this size of image has " +
                                   std::to_string(size) + "; take a smaller --size, or allow more"};
}

}  // namespace gim
