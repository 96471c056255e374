// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/physics/physical_scene.h"
#include "scene_folder.h"

#include <nlohmann/json.hpp>

#include <string>

namespace pcl::cosection {

/** \brief An array of the elements of an Eigen vector. */
template <typename Vector>
nlohmann::ordered_json
toJson (const Vector& values)
{
  nlohmann::ordered_json array = nlohmann::ordered_json::array ();
  for (int n = 0; n < values.size (); ++n)
    array.push_back (values[n]);
  return array;
}

/** \brief An array of the rows. */
nlohmann::ordered_json toJson (const Eigen::Matrix3d& matrix);

/** \brief The document as text; what is not UTF-8 in it is replaced. \a indent -1: on one line */
std::string jsonText (const nlohmann::ordered_json& json, int indent);

/** \brief Write scene.json. */
void addSceneJson (const PhysicalScene& scene, SceneFolder& folder);

} // namespace pcl::cosection
