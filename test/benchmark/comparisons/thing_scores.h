// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/evaluation/run_evaluation.h>
#include <pcl/cosection/surface/co_section.h>

#include <map>
#include <string>
#include <vector>

/** \brief How near some meshes are to their things. */
struct ThingScores
{
  std::vector<double> errors_m; ///< mean of accuracy and completeness
  std::vector<double> volumes;  ///< of the true one

  double meanError () const;

  double worstError () const;

  /** \brief Mean of how much of the true volume is too much or too little. */
  double meanVolumeError () const;
};

/** \brief Compare each object of a simulated scene with the mesh of its number; by name, and "all". What has no mesh is
 * told on the terminal. */
void measureThings (const pcl::cosection::SceneRecord& truth, const std::vector<pcl::cosection::ObjectResult>& meshes,
                    std::map<std::string, ThingScores>& scores);
