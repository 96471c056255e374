// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "arguments.h"
#include "ignored_area.h"
#include "network_options.h"
#include "terminal.h"

#include <pcl/cosection/segmentation/geometric_segmentation.h>

#include <optional>
#include <string>
#include <vector>

/** \brief What the user of pcl_cosection_segment asked for. */
struct SegmentSettings
{
  std::string input, output;
  std::string json;
  std::optional<NetworkSettings> network; ///< not set: by geometry
  pcl::cosection::ObjectSegmentationOptions segmentation;
  IgnoredArea ignored;
  double scale = 1.0;
  bool world_points = false;
  Verbosity verbosity = Verbosity::Normal;
};

/** \brief What pcl_cosection_segment says about itself. */
const ProgramText& segmentationText ();

/** \brief Options as the user gives them. */
struct GivenSegmentation
{
  std::vector<std::string> paths;
  std::string json, method;
  GivenNetwork network;
  GivenIgnoredArea ignored;
  std::optional<double> max_object_size, min_object_size, concave_angle, min_support_area, scale;
  std::optional<int> threads;
  bool world_points = false, verbose = false, quiet = false;
};

void declareSegmentationOptions (CLI::App& app, GivenSegmentation& given);

/** \brief Read the command line. \return nothing if all that was asked for was printed \throws UsageError */
std::optional<SegmentSettings> parseSegmentCommandLine (int argc, const char* const* argv);
