// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/physics/physical_scene.h"
#include "scene_folder.h"

#include <string>

namespace pcl::cosection {

/** \brief Where meshes are, within the folder of a scene. */
constexpr const char* mesh_folder = "meshes";

/** \brief The number of a part is appended to the name of its body. */
std::string partName (const PhysicalBody& body, std::size_t part);

/** \brief File of a mesh, from the folder of the scene. */
std::string meshFile (const std::string& mesh_name);

/** \brief Write the visual meshes, which are named as their bodies, and the parts. */
void writeMeshFiles (const PhysicalScene& scene, SceneFolder& folder);

/** \brief Remove the parts that an earlier scene in a folder had more of. */
void removeFormerParts (const PhysicalScene& scene, const std::string& folder);

} // namespace pcl::cosection
