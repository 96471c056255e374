// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "report_content.h"

#include <string>
#include <vector>

/** \brief What was seen of an object, what was completed, why it is there, and where it is wrong: for each picture,
 * from the side of the camera above and from behind below, `uri`, `caption`, `alternative` (for those who cannot see
 * it), `width` and `height`.
 * \param[in] errors_m of the completed mesh's vertices; empty: not known
 * \param[in] name of the object, for captions */
Json drawObject (const RunObject& object, const ObjectDirections& directions, const std::vector<double>& errors_m,
                 double error_max_m, const std::string& name);

/** \brief The whole scene in the middle of the sequence, as it was seen and as it was completed: from above the cameras
 * and from the other side. Empty without trajectories or meshes. */
Json drawScenePanels (const ReportContent& content);
