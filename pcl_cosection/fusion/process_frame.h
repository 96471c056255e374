// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "fusion_setup.h"
#include "pcl_cosection/fusion/mapping/object_map.h"
#include "pcl_cosection/fusion/segmenters/scheduled_segmenter.h"
#include "pcl_cosection/fusion/tracking/camera_tracking.h"
#include "run_log.h"

#include <map>
#include <optional>
#include <string>

namespace pcl::cosection {

/** \brief What goes from frame to frame. */
struct FusionState
{
  explicit FusionState (const FusionSetup& setup) : segmenter (setup.options.segment_every), alignment (setup.alignment)
  {
    camera.T_world_camera = setup.options.first_pose;
  }

  std::optional<TsdfVolume> background; ///< world frame; nothing before the first frame
  ObjectMap objects;
  CameraState camera;
  ScheduledSegmenter segmenter;
  SdfAlignment alignment; ///< only its buffers go on
  EventLog log;
  std::map<std::string, double> timings_s; ///< by stage
};

/** \brief Process one frame: DynamicFusion::process (). \param[in,out] state updated */
TrackedFrame processFrame (const RgbdFrame& frame, const Image<std::uint16_t>* given_mask, const FusionSetup& setup,
                           FusionState& state);

} // namespace pcl::cosection
