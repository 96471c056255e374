// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ignored_area.h"
#include "method_options.h"
#include "network_options.h"
#include "terminal.h"

#include <pcl/cosection/fusion/sequence_fusion.h>

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

/** \brief What the user of pcl_cosection_fusion asked for. */
struct FusionSettings
{
  std::string dataset;
  std::string output;
  pcl::cosection::SequenceSource source;
  std::string camera_trajectory;                  ///< file; empty: the poses that come with the images, or tracking
  std::map<int, std::string> object_trajectories; ///< files, by id
  std::string masks;                              ///< folder; empty: there are no objects
  bool ids_per_frame = false;                     ///< asked for: a number of a mask means another object in the next
  std::string segmentation;                       ///< what finds objects without masks; empty: nothing
  std::optional<NetworkSettings> network;         ///< that finds them
  IgnoredArea ignored;                            ///< of every image
  std::string preset;                             ///< empty: our own defaults
  bool save_keyframes = false;
  bool live = false;
  std::string json; ///< a further summary
  Verbosity verbosity = Verbosity::Normal;
  pcl::cosection::FusionOptions fusion;
};

/** \brief What pcl_cosection_fusion says about itself. */
const ProgramText& fusionText ();

/** \brief Options as the user gives them. */
struct GivenFusion : GivenMethod
{
  std::vector<std::string> paths, intrinsics, object_trajectories;
  std::string format, depth_dir, camera_trajectory, masks, mask_ids, segmentation, frames, json;
  GivenNetwork network;
  GivenIgnoredArea ignored;
  std::optional<double> depth_scale, max_depth;
  std::optional<int> keyframe_every, max_views;
  bool save_keyframes = false, deterministic = false, live = false, verbose = false, quiet = false;
};

void declareFusionOptions (CLI::App& app, GivenFusion& given);

/** \brief Read the command line. \return nothing if all that was asked for was printed \throws UsageError */
std::optional<FusionSettings> parseFusionCommandLine (int argc, const char* const* argv);
