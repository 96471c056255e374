// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/simulation/simulated_scene.h>

#include <string>

namespace pcl::cosection {

/** \brief Which frames to write, and how. */
struct SequenceOptions
{
  int first = 0;
  int last = -1;   ///< not written itself; -1: all from first on
  int threads = 0; ///< 0: all; the files do not depend on it
};

/** \brief Render a scene into a new folder, with the truth:
 *
 *     scene.json                     the description, if the scene comes from one
 *     calibration.txt                fx fy cx cy width height
 *     colour/ColorNNNN.png           8 bits
 *     depth_noise/DepthNNNN.png|exr  as measured; without noise, or exact depth as well: depth/
 *     mask/MaskNNNN.png              pixel = id of the object, 0 = background
 *     gt-cam-0.txt                   frame tx ty tz qx qy qz qw: T_world_camera
 *     gt-NAME-ID.txt                 T_world_object
 *     gt-mesh/NAME.ply               surface, in the frame of the object; that of the background too
 *     views/ViewNNNN.pcd             organised and labelled, as measured, with VIEWPOINT; if the scene asks for them
 *     views/gt-NAME-ID.txt           T_world_object, stamps = number of the view
 *
 * Frames of the same number have the same bytes whatever part of the sequence is written. Nothing is left if it fails.
 * \throws IoError if the folder exists, or something cannot be written; Cancelled; InvalidArgument if there are no such
 * frames */
void writeSequence (const SimulatedScene& scene, const std::string& folder, const SequenceOptions& options = {},
                    const ProgressCallback& progress = {});

} // namespace pcl::cosection
