// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/simulation/simulated_scene.h>

#include <string>
#include <vector>

namespace pcl::cosection
{

/** \brief Read the description of a scene: JSON, comments allowed; doc/pcl_cosection_simulate.md has its fields.
 * \param[in] text the description
 * \param[in] name what messages call it, a file's name for instance
 * \param[in] folder where the names of mesh files begin
 * \throws InvalidArgument naming the field, if it is unknown, missing or not right
 * \throws IoError if a mesh file cannot be read */
PCL_COSECTION_EXPORT SimulatedScene parseSceneSpec (const std::string& text, const std::string& name,
                                                    const std::string& folder = ".");

/** \brief Read it from a file; mesh files are found beside it. \throws as parseSceneSpec () */
PCL_COSECTION_EXPORT SimulatedScene loadSceneSpec (const std::string& path);

/** \brief What the scene was read from, with its present seed, noise and views, and the full names of its mesh files;
 * empty if it was not read from anything. */
PCL_COSECTION_EXPORT std::string effectiveSpec (const SimulatedScene& scene);

/** \brief A scene that comes with the library. */
struct PCL_COSECTION_EXPORT ScenePreset
{
  std::string name;
  std::string meaning;
  std::string spec; ///< for parseSceneSpec ()
};

/** \brief Objects on a table; toys that drive on a floor; an object that is lifted, turned and put on another. */
PCL_COSECTION_EXPORT const std::vector<ScenePreset>& scenePresets ();

} // namespace pcl::cosection
