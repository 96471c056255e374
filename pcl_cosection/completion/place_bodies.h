// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "surroundings.h"

#include <cstddef>
#include <vector>

namespace pcl::cosection {

constexpr int default_resolution = 64; ///< voxels along the longest side of an object
constexpr int thin_resolution = 96;    ///< of one that is thin

/** \brief Box of the space in \a within that no view saw free and that is connected with an object's points, with a
 * margin.
 * \param[in] views depth views and their sensors' poses in the points' frame
 * \param[in] planes that bound the space, normals towards the points; it does not extend along the layer of \a layer_m
 * on them */
Eigen::AlignedBox3d unseenBox (const Observation& object, const Eigen::AlignedBox3d& within,
                               const OcclusionMap::Views& views, const std::vector<Eigen::Vector4d>& planes,
                               double layer_m);

/** \brief A grid of voxels of the given size over a box. \throws InvalidArgument */
VoxelGrid layoutBox (const Eigen::AlignedBox3d& box, double voxel_size_m);

/** \brief \throws MemoryLimitExceeded if a volume needs more than is left
 * \param[in] limit_bytes 0: no limit
 * \param[in] used_bytes memory in use */
void checkMemory (const VoxelGrid& grid, std::size_t limit_bytes, std::size_t used_bytes);

std::size_t bytesOf (const SignedDistanceField& field);

std::size_t bytesOf (const std::vector<Obstacle>& obstacles);

/** \brief Approximate bytes of points, views and volumes; without obstacles and fields. */
std::size_t bytesInUse (const Scene& scene, const SceneState& state, const std::vector<Observation>& observations);

/** \brief Give a body a grid that covers a box, or keep its present grid if that covers it.
 * \param[in] blur factor of the points' Gaussians, for voxels finer than the points support
 * \param[in] used_bytes memory in use, without the body's own
 * \throws MemoryLimitExceeded */
void placeBody (const Eigen::AlignedBox3d& box, double voxel_size_m, double blur, bool carve, std::size_t used_bytes,
                const CoSectionOptions& options, CompletionMode mode, BodyState& body);

/** \brief Give each object a grid, with voxels as small as its points support and the memory allows for all objects.
 * \return the objects that have a grid, in the order of the scene; they refer to the arguments */
std::vector<SceneObject> placeObjects (const Scene& scene, const std::vector<Observation>& observations,
                                       const std::vector<SupportPlanes>& support, CompletionMode mode,
                                       SceneState& state, CompletionLog& log);

} // namespace pcl::cosection
