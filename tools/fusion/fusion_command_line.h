// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ignored_area.h"
#include "method_options.h"
#include "network_options.h"

#include <pcl/cosection/fusion/frame_segmenter.h>
#include <pcl/cosection/fusion/sequence_fusion.h>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/** \brief Options as the user gives them. */
struct GivenFusion : GivenMethod
{
  std::vector<std::string> intrinsics, trajectory_values;
  std::string format, depth_dir, mask_ids, frames;
  std::string camera_trajectory;    ///< file; empty: the poses that come with the images, or tracking
  std::string masks;                ///< folder; empty: there are no objects
  std::string segmentation;         ///< what finds objects without masks; empty: nothing
  std::string json;                 ///< a further summary
  std::vector<std::string> exports; ///< formats for simulators
  GivenNetwork given_network;
  GivenIgnoredArea given_area;
  std::optional<double> depth_scale, max_depth;
  std::optional<int> keyframe_every, max_views, background_block;
  bool save_keyframes = false, deterministic = false, live = false;
};

/** \brief What the user of pcl_cosection_fusion asked for: the options, and what they mean together. */
struct FusionSettings : GivenFusion
{
  std::string dataset, output;
  pcl::cosection::SequenceSource source;
  std::map<int, std::string> object_trajectories; ///< files, by id
  std::optional<NetworkSettings> network;         ///< that finds objects
  IgnoredArea ignored;                            ///< of every image
  pcl::cosection::FusionOptions fusion;
};

/** \brief What pcl_cosection_fusion says about itself. */
const ProgramText& fusionText ();

void declareFusionOptions (CLI::App& app, GivenFusion& given);

/** \brief Read the command line. \return nothing if all that was asked for was printed \throws UsageError */
std::optional<FusionSettings> parseFusionCommandLine (int argc, const char* const* argv);

/** \brief What finds objects where there are no masks. \param[in] name a value of --segmentation \param[in] threads 0:
 * all \param[in] network for mask-rcnn \throws UsageError, pcl::cosection::IoError */
std::shared_ptr<pcl::cosection::FrameSegmenter> makeSegmenter (const std::string& name, int threads,
                                                               const std::optional<NetworkSettings>& network);
