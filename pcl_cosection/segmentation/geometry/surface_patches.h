// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "depth_grid.h"

#include <Eigen/Core>

#include <map>
#include <utility>
#include <vector>

namespace pcl::cosection {

/** \brief A small connected piece of surface with one orientation. */
struct SurfacePatch
{
  Eigen::Vector3f centre = Eigen::Vector3f::Zero ();
  Eigen::Vector3f normal = Eigen::Vector3f::Zero (); ///< mean, unit; zero if no pixel has one
  Eigen::Matrix3f spread = Eigen::Matrix3f::Zero (); ///< sum of the pixels' (p - centre) (p - centre)^T
  Eigen::Matrix3f bend = Eigen::Matrix3f::Zero ();   ///< sum of (p - centre) (n - normal)^T
  int pixels = 0;

  /** \brief Normal curvature along a unit direction, 1/m: positive where the surface is convex. */
  float curvature (const Eigen::Vector3f& direction) const
  {
    const float length2 = direction.dot (spread * direction);
    return (length2 > 0.0f ? direction.dot (bend * direction) / length2 : 0.0f);
  }
};

struct PatchImage
{
  std::vector<int> patch_of; ///< one per pixel: index of its patch, -1 for none
  std::vector<SurfacePatch> patches;
};

/** \brief Divides pixels into patches of about one size in the image: k-means in place and normal among the nearest
 * cells of a grid (R. Achanta et al., "SLIC Superpixels Compared to State-of-the-art Superpixel Methods", PAMI 2012),
 * then connected pieces of each.
 * \param[in] used one per pixel: whether it takes part */
PatchImage computeSurfacePatches (const DepthGrid& grid, const std::vector<char>& used, int threads);

/** \brief Take patches out of the image. \param[in] gone one per patch */
void removePatches (PatchImage& patches, const std::vector<char>& gone);

/** \brief What speaks for two patches being parts of one object, in pixels of their common border; negative: against
 * it. */
using PatchEvidence = std::map<std::pair<int, int>, float>;

/** \brief Evidence of all pairs of patches that touch: for, where they continue each other or meet at a convex edge,
 * against, where they meet at an edge that is concave by more than \a concave_angle_rad. */
PatchEvidence convexityEvidence (const DepthGrid& grid, const PatchImage& image, float concave_angle_rad);

/** \brief Greedy additive edge contraction: joins the two sets with the most evidence for it, adding up what their
 * members say about other sets, until none is left with evidence for it.
 * \return one per patch: the number of its set, from 0 */
std::vector<int> contractEdges (std::size_t patches, const PatchEvidence& evidence);

} // namespace pcl::cosection
