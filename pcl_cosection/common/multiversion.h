// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Functions marked so are compiled once more for processors with AVX2 and FMA; the loader chooses.
// No exported flag and no type's alignment depends on it, unlike with -march.
#if defined __x86_64__ && defined __GNUC__ && !defined __clang__ && !defined PCL_COSECTION_NO_MULTIVERSIONING
#if __GNUC__ >= 12
#define PCL_COSECTION_MULTIVERSION __attribute__ ((target_clones ("arch=x86-64-v3", "default")))
#else
#define PCL_COSECTION_MULTIVERSION __attribute__ ((target_clones ("avx2", "default")))
#endif
#else
#define PCL_COSECTION_MULTIVERSION
#endif

#define PCL_COSECTION_INLINE inline __attribute__ ((always_inline))
