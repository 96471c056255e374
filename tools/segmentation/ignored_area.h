// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "arguments.h"

#include <pcl/cosection/common/image.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

/** \brief Options about parts of the image that are left out, as the user gives them. */
struct GivenIgnoredArea
{
  std::vector<std::string> regions;
  std::string mask;
};

/** \brief What is left out. */
struct IgnoredArea
{
  std::vector<std::array<int, 4>> regions; ///< left, top, width, height in pixels
  std::string mask;                        ///< file; empty: not given

  bool empty () const { return (regions.empty () && mask.empty ()); }
};

/** \brief Declare --ignore-region and --ignore-mask in the group "Input". */
void declareIgnoredArea (CLI::App& app, GivenIgnoredArea& given);

/** \throws UsageError */
IgnoredArea ignoredArea (const GivenIgnoredArea& given);

/** \brief 1: the pixel is left out. \throws UsageError if a region is not within the image \throws
 * pcl::cosection::IoError if the mask cannot be read, or has another size */
pcl::cosection::Image<std::uint8_t> ignoredPixels (const IgnoredArea& area, int width, int height);
