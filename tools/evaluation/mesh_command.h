// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "common_options.h"

#include <string>
#include <vector>

/** \brief What the user asked of the command mesh. */
struct MeshSettings : CommonOptions, SurfaceOptions
{
  std::vector<std::string> pose;             ///< T_truth_reconstruction, seven numbers
  std::string align = "none";                ///< or icp
  std::vector<std::string> obstacles, views; ///< files
  double free_space_tolerance_m = 0.01;
  std::string error_mesh, error_picture; ///< files to write
  double error_max_m = 0.0;              ///< 0: by the accuracy
  std::vector<std::string> up;           ///< three numbers
};

/** \brief pcl_cosection_evaluate mesh. */
EvaluationCommand meshCommand ();
