// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/fusion/association/data_association.h"
#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/fusion/dynamic_fusion.h>
#include <pcl/cosection/tracking/sdf_alignment.h>

#include <cstddef>

namespace pcl::cosection {

/** \brief What is the same for all frames. */
struct FusionSetup
{
  /** \throws InvalidArgument as DynamicFusionOptions::validate () and PinholeCamera::validate () */
  FusionSetup (const PinholeCamera& camera, const DynamicFusionOptions& options);

  /** \brief Whether a mask should show an object that so many pixels belong to. */
  bool isExpectedInMask (std::size_t pixels) const
  {
    constexpr double expected_share = 0.25; // of the pixels of a new object
    return static_cast<double> (pixels) > expected_share * static_cast<double> (min_object_pixels);
  }

  PinholeCamera camera;
  DynamicFusionOptions options;
  DataAssociation association;
  SdfAlignmentOptions alignment;
  std::size_t min_object_pixels = 0; ///< of a new object, in an image of this size
  TsdfOptions background_tsdf;
  TsdfOptions object_tsdf;
};

} // namespace pcl::cosection
