// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/export.h>
#include <pcl/cosection/io/rgbd_sequence.h>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include <map>
#include <optional>
#include <string>
#include <vector>

// What a summary.json says. It may lack anything, as those of earlier versions do, or have something else in its place.

namespace pcl::cosection {

/** \brief If the camera is not known. */
constexpr PinholeCamera usual_camera = {640, 480, 525.0, 525.0, 319.5, 239.5};

/** \brief A field of an object; null if there is none. */
const nlohmann::json& fieldOf (const nlohmann::json& json, const char* name);

/** \brief A field that is text; empty if it is not. */
std::string textOf (const nlohmann::json& json, const char* name);

/** \brief A field that is a list of \a count numbers; empty if it is not. */
std::vector<double> numbersOf (const nlohmann::json& json, const char* name, std::size_t count);

/** \brief A camera of a usual size. */
std::optional<PinholeCamera> cameraOf (const nlohmann::json& json);

/** \brief How the images of a sequence were read. */
SequenceSource sourceOf (const nlohmann::json& json);

/** \brief By object; classes that have a number only have no name. */
std::map<int, std::string> classesOf (const nlohmann::json& objects);

/** \brief The unit normal of the first plane [a, b, c, d] of a list. */
PCL_COSECTION_EXPORT std::optional<Eigen::Vector3d> firstNormalOf (const nlohmann::json& planes);

} // namespace pcl::cosection
