// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "report_content.h"

#include <string>

/** \brief What the interactive view shows, for page/report.js: `up`, `target`, `eye` (metres, world), `is_frame`
 * (whether stamps are numbers of frames), `stamps`, `camera` (a pose per stamp, or null; `intrinsics`), `background`,
 * `error_max_mm`, `objects`
 * (`id`, `name`, `colour`, `poses`, `completed`, `seen`). A pose is [x, y, z, qx, qy, qz, qw]; meshes are as embedMesh
 * () makes them. */
Json sceneData (const ReportContent& content);

/** \brief JSON as the text of a script element, which nothing in it can end. */
std::string asScriptText (const Json& json);
