// Passes errors of the encoder on. They say what failed, in which stage, at which element, and what to do about it.
#pragma once

#include <string>
#include <utility>
#include <variant>

#include "gim/encoder.h"

namespace gim {

// Returns the error of a Result-valued expression, or binds its value to `name`.
#define GIM_TRY(name, expression)                          \
    auto name##_result = (expression);                     \
    if (!name##_result.ok()) return name##_result.error(); \
    auto& name = name##_result.value()

// Returns the error of a Result<void>, or continues.
#define GIM_CHECK(expression) \
    if (auto checked_result = (expression); !checked_result.ok()) return checked_result.error()

}  // namespace gim
