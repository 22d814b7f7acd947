#pragma once
// Inner loops compiled for AVX2, too, and chosen at run time. Sums stay what they are: every lane
// adds in the same order, and the build forbids fused multiply-adds. A file that uses this includes
// no library whose types depend on the instruction set. Sanitizers cannot cope with the run-time
// choice, which happens before they start.

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define ROVIGO_SIMD_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define ROVIGO_SIMD_CLONES
#endif
