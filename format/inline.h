// Marks functions and lambdas that must be inlined for speed, so that their state stays in registers. GIM_SMALL_CODE: but
// not in files that are built for size.
#pragma once

// Marks functions whose calls cost little against their work, and whose copies would be large.
#if defined(_MSC_VER) && !defined(__clang__)
#define GIM_NEVER_INLINE __declspec(noinline)
#else
#define GIM_NEVER_INLINE __attribute__((noinline))
#endif

#if defined(GIM_SMALL_CODE)
#define GIM_ALWAYS_INLINE inline
#define GIM_ALWAYS_INLINE_LAMBDA
#elif defined(_MSC_VER) && !defined(__clang__)
#define GIM_ALWAYS_INLINE __forceinline
#define GIM_ALWAYS_INLINE_LAMBDA
#else
#define GIM_ALWAYS_INLINE __attribute__((always_inline)) inline
#define GIM_ALWAYS_INLINE_LAMBDA __attribute__((always_inline))
#endif
