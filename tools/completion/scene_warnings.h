// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene_input.h"

#include <pcl/cosection/common/oriented_point.h>
#include <pcl/cosection/io/pcd_view.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/** \brief A warning of a view without labels that shows more than an object that was cut out, if it does: a whole
 * image, or things on a plane. */
std::optional<std::string> wholeScene (const pcl::cosection::LabelledView& view);

/** \brief A warning of an object that is too long to be one, if it is: without labels it may be a whole scene, or its
 * unit is not the metre. */
std::optional<std::string> tooLong (std::uint32_t label, const std::vector<pcl::cosection::OrientedPoint>& points);

/** \brief A warning about a background that extends no farther than an object, if it does: it may be the first object.
 */
std::optional<std::string> smallBackground (const SceneInput& scene);

/** \brief A warning of an object that extends about all the others, if there is no background: it may be that.
 * \param[in] background_labels that were given; empty: label 0 */
std::optional<std::string> objectLikeBackground (const SceneInput& scene,
                                                 const std::vector<std::uint32_t>& background_labels);

/** \brief A warning of the object that has the fewest voxels across, if they are too few for its shape. */
std::optional<std::string> largeVoxels (const SceneInput& scene, double voxel_size_m);

/** \brief A warning of given planes that are all farther from every object than that is long, if they are: they are not
 * to be used. */
std::optional<std::string> distantPlanes (const SceneInput& scene);
