// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "common_options.h"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <string>
#include <vector>

/** \brief What the user asked of the command mesh. */
struct MeshSettings
{
  CommonOptions common;
  long samples = 10000;
  std::uint64_t seed = 0;
  double f_threshold_m = 0.01;
  std::vector<std::string> pose;             ///< T_truth_reconstruction, seven numbers
  std::string align = "none";                ///< or icp
  std::vector<std::string> obstacles, views; ///< files
  double penetration_voxel_m = 0.0;          ///< 0: by the size of the meshes
  double free_space_tolerance_m = 0.01;
  std::string error_mesh, error_picture; ///< files to write
  double error_max_m = 0.0;              ///< 0: by the accuracy
  std::vector<std::string> up;           ///< three numbers
};

void declareMeshOptions (CLI::App& app, MeshSettings& settings);

/** \brief pcl_cosection_evaluate mesh. \throws UsageError, pcl::cosection::Error */
void runMeshCommand (int argc, const char* const* argv, Terminal& terminal);
