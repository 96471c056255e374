// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "copy_evidence.h"

#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief A group of motions that may take an object to itself. */
struct Symmetry
{
  Motions motions;     ///< without the identity; several of a full turn
  double weight = 1.0; ///< independent motions of the group
  CopyEvidence evidence;
  bool on_plane = false; ///< copies below a plane contradicted

  /** \brief Log-likelihood ratio of the whole group, per sample. */
  double value () const { return weight * evidence.logLikelihoodRatio (); }
};

/** \brief The best symmetry of each kind that an object may have, by brute force over planes and axes. On a plane: a
 * full turn about its normal, one about an axis along it, a mirror plane, two mirror planes at right angles; all mirror
 * planes and other axes along the normal. Without a plane, the same along the three directions in which most normals
 * point, and three mirror planes at right angles.
 * \param[in] plane unit normal and offset, or zeros */
std::vector<Symmetry> findSymmetries (const CopyJudge& judge, const VoxelGrid& grid, const Eigen::Vector4d& plane);

/** \brief The full turn about a given axis, or, with a zero vector, about all axes through \a center. */
Symmetry givenTurn (const CopyJudge& judge, const Eigen::Vector3d& center, const Eigen::Vector3d& axis);

/** \brief The symmetry with the most evidence. Of those with about as much, the one with the most motions: it says more
 * of what was not seen.
 * \return nothing if all are contradicted, or there is no evidence for any */
std::optional<Symmetry> likeliest (const std::vector<Symmetry>& symmetries);

/** \brief Whether two full turns are about parallel axes. */
bool isAboutSameAxis (const Symmetry& a, const Symmetry& b);

/** \brief Whether a symmetry is about as likely as the best one. */
bool isAsLikely (const Symmetry& symmetry, const Symmetry& best);

} // namespace pcl::cosection
