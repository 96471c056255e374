// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

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
