// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/physics/scene_builder.h"

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

/** \brief What to write of a completed scene. */
struct ExportSettings
{
  std::vector<std::string> formats; ///< of exportFormats ()
  pcl::cosection::PhysicsOptions physics;
  std::size_t points = 0;             ///< of each object, on its surface; 0: no points
  bool save_sdf = false;              ///< each object's signed distance
  std::optional<double> sdf_margin_m; ///< around an object; nothing: some voxels
};

/** \brief What was written, and what is to be said of it. */
struct ExportReport
{
  pcl::cosection::PhysicalScene scene;
  std::vector<std::string> files;
};

/** \brief Names of the formats. */
const std::vector<std::string>& exportFormats ();

/** \brief Make rigid bodies of a result and write them in some formats into a folder, which is made.
 * \param[in] result folder that pcl_cosection or pcl_cosection_fusion wrote
 * \param[in] go_on false stops: what an earlier export wrote stays as it is, as after an error
 * \throws pcl::cosection::Error, Cancelled */
ExportReport exportScene (const std::string& result, const std::string& output, const ExportSettings& settings,
                          const std::function<bool ()>& go_on = {});
