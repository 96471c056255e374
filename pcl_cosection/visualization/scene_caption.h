// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/visualization/scene_colours.h"
#include <pcl/cosection/common/export.h>
#include <pcl/cosection/visualization/run_scene.h>

#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief What surfaces are called on the command line, in the order of SurfaceMode. */
PCL_COSECTION_EXPORT const std::vector<std::string>& surfaceNames ();

/** \brief What colours are called, in the order of ColourMode. */
PCL_COSECTION_EXPORT const std::vector<std::string>& colourNames ();

/** \brief A line below a picture: which frame it is, what is in it, what its colours are. */
PCL_COSECTION_EXPORT std::string sceneCaption (const RunScene& scene, double stamp, SurfaceMode surface,
                                               ColourMode colour);

} // namespace pcl::cosection
