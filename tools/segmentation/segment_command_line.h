// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ignored_area.h"
#include "network_options.h"

#include <pcl/cosection/segmentation/geometric_segmentation.h>

#include <optional>
#include <string>

/** \brief Options as the user gives them. */
struct GivenSegmentation : GeneralOptions
{
  std::string json, method;
  GivenNetwork given_network;
  GivenIgnoredArea given_area;
  std::optional<double> max_object_size, min_object_size, concave_angle, min_support_area;
  double scale = 1.0;
  bool world_points = false;
  std::string axes = "optical"; ///< of the sensor
};

/** \brief What the user of pcl_cosection_segment asked for: the options, and what they mean together. */
struct SegmentSettings : GivenSegmentation
{
  std::string input, output;
  std::optional<NetworkSettings> network; ///< not set: by geometry
  pcl::cosection::ObjectSegmentationOptions segmentation;
  IgnoredArea ignored;
};

/** \brief What pcl_cosection_segment says about itself. */
const ProgramText& segmentationText ();

void declareSegmentationOptions (CLI::App& app, GivenSegmentation& given);

/** \brief Read the command line. \return nothing if all that was asked for was printed \throws UsageError */
std::optional<SegmentSettings> parseSegmentCommandLine (int argc, const char* const* argv);
