// A function of plain loops, made vectors of by the compiler for whatever machine it runs on.
#pragma once

#include <cstddef>  // tells the C library

/// Before a function whose loops are plain arithmetic on rows: it is compiled for each generation of x86-64 processors, and the
/// loader takes the one for this machine (GCC's target_clones). Results are the same on all, bit for bit, as long as products and
/// sums are not fused (-ffp-contract=off), so that QUELL_ISA need not choose. What a loop calls must be visible, and compiled
/// with -O3 -fno-math-errno -fno-trapping-math if it is to become vectors.
///
/// For loops that memory bounds. Where arithmetic does, write a kernel (quell/simd/vectors-inl.h). Under sanitizers, whose
/// functions the loader may not call yet while it chooses, and with other compilers the function is compiled once.
#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__) && __GNUC__ >= 12 && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define QUELL_PLAIN_LOOP [[gnu::target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")]]
#else
#define QUELL_PLAIN_LOOP
#endif
