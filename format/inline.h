// Marks functions and lambdas that must be inlined for speed, so that their state stays in registers.
#pragma once

#if defined(_MSC_VER) && !defined(__clang__)
#define GIM_ALWAYS_INLINE __forceinline
#define GIM_ALWAYS_INLINE_LAMBDA
#else
#define GIM_ALWAYS_INLINE __attribute__((always_inline)) inline
#define GIM_ALWAYS_INLINE_LAMBDA __attribute__((always_inline))
#endif
