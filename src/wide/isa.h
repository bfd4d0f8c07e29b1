// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Kernels are compiled once per instruction set (cmake/kernels.cmake); each version defines the same name
// with another ending, and the best one that may be used is chosen here.
#ifndef EWA_SRC_WIDE_ISA_H
#define EWA_SRC_WIDE_ISA_H

#include "ewa/base.h"

/// EWA_DECLARE_VERSIONS(type, name): what each version of a kernel's body defines.
/// EWA_CHOOSE(features, name): a pointer to the one for the widest of the EWA_CPU_* bits in `features`.
#if defined(__x86_64__)
#define EWA_DECLARE_VERSIONS(type, name) extern type name##_portable, name##_avx2, name##_avx512
#define EWA_CHOOSE(features, name)                                                                           \
    ((features)&EWA_CPU_AVX512 ? &name##_avx512 : (features)&EWA_CPU_AVX2 ? &name##_avx2 : &name##_portable)
#elif defined(__aarch64__)
#define EWA_DECLARE_VERSIONS(type, name) extern type name##_portable, name##_neon
#define EWA_CHOOSE(features, name)       ((features)&EWA_CPU_NEON ? &name##_neon : &name##_portable)
#else
#define EWA_DECLARE_VERSIONS(type, name) extern type name##_portable
#define EWA_CHOOSE(features, name)       ((void)(features), &name##_portable)
#endif

/// EWA_VERSION(name): the name in the version that is being compiled.
#if defined(WIDE_AVX512)
#define EWA_VERSION(name) name##_avx512
#elif defined(WIDE_AVX2)
#define EWA_VERSION(name) name##_avx2
#elif defined(WIDE_NEON)
#define EWA_VERSION(name) name##_neon
#elif defined(WIDE_PORTABLE)
#define EWA_VERSION(name) name##_portable
#endif

#endif
