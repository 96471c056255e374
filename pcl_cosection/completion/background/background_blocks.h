// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/completion/scene.h"

#include <cstddef>
#include <vector>

namespace pcl::cosection {

/** \brief Margin of an incremental background where it grows, as it will grow again; voxels. */
constexpr int growth_vox = 12;

/** \brief Longest edge of the volumes in which a background is solved, voxels; no volume has more than its cube. */
int blockEdge (const CoSectionOptions& options);

/** \brief Divide a background into blocks, and give those a volume that have data near. Blocks that are there already
 * and still fit are kept.
 * \param[in] box that the blocks cover, world frame
 * \param[in] planes continued in it
 * \param[in] options of the bodies
 * \param[in] used_bytes memory in use, without the blocks
 * \throws MemoryLimitExceeded, and nothing is changed
 * \throws InvalidArgument if the box has too many voxels */
void placeBlocks (const Scene& scene, const Eigen::AlignedBox3d& box, double voxel_size_m,
                  const std::vector<PlaneContinuation>& planes, const CoSectionOptions& options, CompletionMode mode,
                  std::size_t used_bytes, BackgroundBlocks& blocks);

/** \brief Bytes that the blocks keep between their solves. */
std::size_t bytesOf (const BackgroundBlocks& blocks);

/** \brief The grid of a box of the lattice's voxels. */
VoxelGrid gridOf (const BackgroundBlocks& blocks, const Eigen::AlignedBox3i& voxels);

/** \brief The block that a voxel of the lattice belongs to; null if that has no data near. */
BackgroundBlock* ownerOf (BackgroundBlocks& blocks, const Eigen::Vector3i& voxel);

/** \brief Copy the fields of the blocks around one into its margin. All must have a field. */
void takeFromNeighbours (BackgroundBlocks& blocks, BackgroundBlock& block);

/** \brief Where a block is beside the rest of the background, and not at its end: its voxels that are not at a border
 * whose values are held. Voxels of the block's domain; both ends belong to it. */
Eigen::AlignedBox3i freeVoxels (const BackgroundBlocks& blocks, const BackgroundBlock& block);

/** \brief Call f (voxel of the lattice, index in the domain of the block) for the voxels of a box within the domain. */
template <typename Function>
void
forEachVoxelOf (const BackgroundBlock& block, const Eigen::AlignedBox3i& box, Function&& f)
{
  for (int k = box.min ().z (); k <= box.max ().z (); ++k)
    for (int j = box.min ().y (); j <= box.max ().y (); ++j)
    {
      const Eigen::Vector3i first = Eigen::Vector3i (box.min ().x (), j, k) - block.domain.min ();
      std::size_t n = block.body.grid->index (first.x (), first.y (), first.z ());
      for (int i = box.min ().x (); i <= box.max ().x (); ++i, ++n)
        f (Eigen::Vector3i (i, j, k), n);
    }
}

} // namespace pcl::cosection
