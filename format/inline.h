// Marks functions and lambdas that must be inlined for speed, so that their state stays in registers. GIM_SMALL_CODE: but
// not in files that are built for size.
#pragma once

#include <cstddef>  // defines __GLIBC__, where that is the C library

// Marks functions of loops over arrays that GCC shall compile twice: for x86-64 as it is everywhere, and with AVX2. Which one
// runs is found out when the program starts. Both give the same bits: nothing contracts or reorders arithmetic. Sanitizers
// come too late for that start, so they see the plain one.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && defined(__GLIBC__) && !defined(__AVX2__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define GIM_VECTOR_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define GIM_VECTOR_CLONES
#endif

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
