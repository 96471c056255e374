// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "arguments.h"

#include <pcl/cosection/surface/options.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

/** \brief Options of the method as the user gave them: what is absent leaves the preset as it is. */
struct GivenMethod : GeneralOptions
{
  std::optional<double> voxel_size, padding, background_voxel_size, alpha, beta_hull, beta_inter, sigma, tolerance;
  std::optional<int> resolution, max_iterations;
  std::string constraints, weighting, solver, preset, max_memory;
  std::vector<std::string> priors; // lists
  bool no_planes = false;
};

/** \brief Declare the options about volumes and memory, in the group "Volume". \param[in] background_default what the
 * background's voxels are, if nothing is given */
void declareVolumeOptions (CLI::App& app, GivenMethod& given, const std::string& background_default);

/** \brief Declare those about the energy and its minimisation, in the group "Method". */
void declareMethodOptions (CLI::App& app, GivenMethod& given);

/** \brief The options of the method. What the command line says of the size of voxels replaces what the configuration
 * file does. \throws UsageError, pcl::cosection::InvalidArgument */
pcl::cosection::CoSectionOptions methodOptions (GivenMethod given);

/** \brief "none", "hull", "intersection" or "all". */
std::string constraintsOf (const pcl::cosection::CoSectionOptions& method);

/** \brief Files by object from values "ID=FILE". \param[in] option for messages \throws UsageError */
std::pair<int, std::string> parseObjectFile (const std::string& option, const std::string& value);

/** \brief Several, one per object. \throws UsageError */
std::map<int, std::string> parseObjectFiles (const std::string& option, const std::vector<std::string>& values);
