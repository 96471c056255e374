// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "data_uri.h"
#include "report_content.h"
#include "scene_directions.h"

#include <string>
#include <vector>

/** \brief A picture with what it shows. */
struct CaptionedPicture
{
  std::string caption;
  std::string alternative; ///< for those who cannot see it
  int width = 0, height = 0;
  std::string uri;
};

/** \brief A mesh from the side of the camera above the same from behind, on nothing.
 * \param[in] fit_to what fills the picture; the same for all pictures of an object */
TransparentPicture drawFrontAndBack (const pcl::cosection::TriangleMesh& mesh,
                                     const pcl::cosection::TriangleMesh& fit_to, const ObjectDirections& directions,
                                     int panel_px);

/** \brief What was seen of an object, what was completed, why it is there, and where it is wrong.
 * \param[in] errors_m of the completed mesh's vertices; empty: not known
 * \param[in] name of the object, for captions */
std::vector<CaptionedPicture> drawObject (const RunObject& object, const ObjectDirections& directions,
                                          const std::vector<double>& errors_m, double error_max_m,
                                          const std::string& name);

/** \brief The whole scene in the middle of the sequence, as it was seen and as it was completed: from above the cameras
 * and from the other side. Empty without trajectories or meshes. */
std::vector<CaptionedPicture> drawScenePanels (const ReportContent& content);
