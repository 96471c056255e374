// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "json_access.h"
#include "report_content.h"

#include <string>

/** \brief How much of the meshes the interactive view has. */
struct SceneBudget
{
  std::size_t background_triangles = 60000;
  std::size_t object_triangles = 24000; ///< of a completed mesh; two thirds of that of what was seen
  std::size_t all_triangles = 240000;   ///< of all objects' completed meshes together
  std::size_t frames = 1500;            ///< the trajectory is thinned evenly
};

/** \brief What the interactive view shows, for page/report.js: `up`, `target`, `eye` (metres, world), `is_frame`
 * (whether stamps are numbers of frames), `stamps`, `camera` (a pose per stamp, or null; `intrinsics`), `background`,
 * `error_max_mm`, `objects`
 * (`id`, `name`, `colour`, `poses`, `completed`, `seen`). A pose is [x, y, z, qx, qy, qz, qw]; meshes are as embedMesh
 * () makes them. */
Json sceneData (const ReportContent& content, const SceneBudget& budget = {});

/** \brief JSON as the text of a script element, which nothing in it can end. */
std::string asScriptText (const Json& json);
