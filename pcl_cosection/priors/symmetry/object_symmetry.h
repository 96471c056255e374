// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "measured_shape.h"
#include "motions.h"
#include "pcl_cosection/priors/object_priors.h"
#include "symmetry_search.h"

#include <Eigen/Geometry>

#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief The likeliest symmetry of an object. */
struct ObjectSymmetry
{
  Motions motions;
  bool is_fitted = false;                ///< its axis or centre, to the normals
  bool is_round = false;                 ///< a full turn, by copies and by normals
  std::optional<Eigen::Affine3d> mirror; ///< a level one

  /** \brief Those with the level mirror plane, too. */
  Motions all () const;

  /** \brief Whether the motions tell how far the object reaches along a direction: a full turn does that moves it,
   * mirror planes do not. */
  bool tellsExtentAlong (const Eigen::Vector3d& direction) const;
};

/** \brief The full turn about the axis of a surface that was fitted to points, judged by the points that the surface
 * holds: a handle is not copied. A nearly vertical axis of what rests is made vertical.
 * \param[in] plane unit normal and offset, or zeros \param[in] rests whether the object rests on it */
Symmetry fittedTurn (const ProfiledShape& surface, const MeasuredShape& shape, const std::vector<OrientedPoint>& points,
                     const Eigen::Vector4d& plane, bool rests, const OcclusionMap::Views& views);

/** \param[in] plane unit normal and offset, or zeros \param[in] rests whether the object rests on it
 * \param[in] only_side plane along the only side that was seen of it, which is flat, if that is known: copies of the
 * side onto itself tell nothing of what is behind it
 * \param[in] round surfaces of revolution that were fitted to its points */
ObjectSymmetry symmetryOf (const Observation& object, const Priors& priors, const Eigen::Vector4d& plane, bool rests,
                           const std::optional<Eigen::Vector4d>& only_side, const std::vector<ProfiledShape>& round,
                           const MeasuredShape& shape, const BodyEnergy& energy);

} // namespace pcl::cosection
