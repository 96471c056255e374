// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "object_pictures.h"
#include "report_content.h"

#include <vector>

/** \brief The whole scene in the middle of the sequence, as it was seen and as it was completed: from above the cameras
 * and from the other side. None without trajectories or meshes. */
std::vector<CaptionedPicture> drawScenePanels (const ReportContent& content);
