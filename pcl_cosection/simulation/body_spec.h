// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "spec_node.h"

#include <pcl/cosection/simulation/simulated_scene.h>

#include <string>

namespace pcl::cosection {

/** \brief The keys of a motion; those of a camera may look at something. */
KeyedMotion parseKeys (const SpecNode& list, bool is_camera);

/** \brief A body of a description. \param[in] number from 1; 0 is the background, which does not move
 * \param[in] folder from which paths of mesh files begin \throws InvalidArgument with the path of the field */
SceneBody parseBody (SpecNode node, int number, const std::string& folder);

} // namespace pcl::cosection
