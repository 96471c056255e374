// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/physics/physical_scene.h"

#include <string>
#include <vector>

namespace pcl::cosection {

// Each writes a scene into a folder that exists, its main file last, every file through a temporary name, and returns
// the paths of the files. If one cannot be written, those before it are removed. Each writes scene.json too, which is
// the same for all formats. \throws IoError

/** \brief scene.json: what no format has a place for, and the poses of the bodies, whose URDF files have none.
 *
 * Metres, kilograms, seconds. A pose is {"position": [x, y, z], "quaternion_xyzw": [x, y, z, w]}.
 *
 * - name, gravity (m/s^2), contact_tolerance_m (parts of two bodies may overlap by so much), warnings (one line each);
 * - T_result_scene: from the scene to the frame of the result;
 * - bodies, each with name, id (0: static), urdf (its file, if URDF was written), T_scene_body, static, mass_kg,
 *   centre_m (of mass, body frame), inertia (3 x 3, about the centre of mass), volume_m3, parts (their number), convex,
 *   parts_volume_m3, excess_m, missing_m, stands_on (name of a plane or null) and centre_shift_m;
 * - planes, each with name, urdf, T_scene_plane (z: the normal), size_m (x, y, thickness) and endless. */
std::vector<std::string> writeSceneJson (const PhysicalScene& scene, const std::string& folder);

/** \brief A file of the Unified Robot Description Format for each body and plane, with OBJ meshes. The poses are in
 * scene.json: a URDF file has no place for these. Static ones are fixed to a link named world. */
std::vector<std::string> writeUrdf (const PhysicalScene& scene, const std::string& folder);

/** \brief scene.sdf, a world of the Simulation Description Format 1.9 (Gazebo), with OBJ meshes. */
std::vector<std::string> writeSdf (const PhysicalScene& scene, const std::string& folder);

/** \brief scene.xml in MuJoCo's format, with OBJ meshes. */
std::vector<std::string> writeMjcf (const PhysicalScene& scene, const std::string& folder);

/** \brief scene.glb, binary glTF 2.0: nodes of the bodies, with vertex colours; y is up, as the format wants. Its
 * second scene has what the bodies collide by. */
std::vector<std::string> writeGltf (const PhysicalScene& scene, const std::string& folder);

/** \brief scene.usda, text of Universal Scene Description with the schemas of UsdPhysics. */
std::vector<std::string> writeUsd (const PhysicalScene& scene, const std::string& folder);

/** \brief planning_scene.json, fields of moveit_msgs/CollisionObject with meshes of shape_msgs/Mesh. */
std::vector<std::string> writePlanningScene (const PhysicalScene& scene, const std::string& folder);

} // namespace pcl::cosection
