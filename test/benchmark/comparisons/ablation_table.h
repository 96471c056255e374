// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/evaluation/mesh_comparison.h>

#include <optional>
#include <string>
#include <vector>

/** \brief One object by one method. */
struct AblationResult
{
  std::optional<pcl::cosection::MeshComparison> comparison; ///< nothing: there is no mesh
  bool closed = false;
};

/** \brief All objects of a scene by one method. */
struct AblationRow
{
  std::string method;
  std::vector<AblationResult> results; ///< in the order of the objects
  double seconds = 0.0;                ///< all objects
};

struct AblationScene
{
  std::string name;
  std::vector<std::string> objects;
  std::vector<AblationRow> rows;
};

/** \brief A table for each scene: accuracy / completeness in millimetres and F-score, and their means. */
std::string markdown (const std::vector<AblationScene>& scenes);

/** \brief A line for each scene, method and object. */
std::string csv (const std::vector<AblationScene>& scenes);
