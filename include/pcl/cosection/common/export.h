// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

/** \namespace pcl
 * \brief The Point Cloud Library. */

/** \namespace pcl::cosection
 * \brief Completes the hidden surfaces of objects; and what comes before and after that: segmentation, tracking, fusion
 * of sequences, simulation, evaluation, pictures. Lengths are metres, angles radians, times seconds; T_a_b takes points
 * of frame b to frame a. */

// The library is built with hidden visibility; PCL's own PCL_EXPORTS is empty outside Windows.
#if defined _WIN32
#if defined PCL_COSECTION_BUILDING
#define PCL_COSECTION_EXPORT __declspec(dllexport)
#else
#define PCL_COSECTION_EXPORT __declspec(dllimport)
#endif
#else
#define PCL_COSECTION_EXPORT __attribute__ ((visibility ("default")))
#endif
