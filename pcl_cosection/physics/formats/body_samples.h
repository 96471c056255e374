// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/physics/physical_scene.h"
#include "scene_folder.h"

#include <cstddef>

namespace pcl::cosection {

/** \brief Write points/NAME.pcd for a body: \a count points evenly over its visual mesh (sampleEvenly ()), in the frame
 * of the scene, binary.
 *
 * Fields x y z, normal_x normal_y normal_z and, as far as the mesh has them, rgb, intensity, confidence (1 at
 * measurements), sigma_m (expected error, metres) and provenance (unsigned char: Provenance).
 * \param[in] threads 0: all
 * \throws IoError, and as sampleEvenly () */
void writeBodyPoints (const PhysicalBody& body, std::size_t count, int threads, SceneFolder& folder);

/** \brief Write the signed distance to a body's visual mesh (sampleSignedDistance ()), exact in all of a box around it.
 *
 * - sdf/NAME.npy: a NumPy array of float32, metres, positive outside; element [i, j, k] is the distance at origin_m +
 *   voxel_size_m * (i, j, k) in the body's frame;
 * - sdf/NAME.json: origin_m, voxel_size_m, shape and what frame that is;
 * - sdf/NAME.vti: the field as VTK image data.
 * \param[in] margin_m the least distance from the mesh to the border of the box, metres \param[in] threads 0: all
 * \throws IoError, and as sampleSignedDistance () */
void writeBodyDistance (const PhysicalBody& body, double voxel_size_m, double margin_m, int threads,
                        SceneFolder& folder);

} // namespace pcl::cosection
