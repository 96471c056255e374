// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/fusion/fusion_setup.h"
#include "pcl_cosection/fusion/tracking/frame_cloud.h"

#include <pcl/cosection/volume/tsdf_volume.h>

#include <optional>

namespace pcl::cosection {

/** \brief Place the volume of the background, world frame, around the points of the first frame; in later ones, shift
 * it to the points in view: what is far behind the camera is forgotten. A frame with hardly any point changes nothing.
 */
void followBackground (const PosedFrame& frame, const FusionSetup& setup, std::optional<TsdfVolume>& background);

} // namespace pcl::cosection
