// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "measured_shape.h"
#include "motions.h"
#include "pcl_cosection/priors/occlusion_map.h"
#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Geometry>

#include <cstdint>
#include <vector>

namespace pcl::cosection {

/** \brief What copies of an object's points say for and against the motions that made them. */
struct CopyEvidence
{
  double support = 0.0;       ///< share of the copies on observed surface of the same orientation
  double contradiction = 0.0; ///< share where the object cannot be

  /** \brief Per copy, against chance. Copies by a true symmetry that can be seen are on the surface three times in
   * four, and where the object cannot be once in thirty times, as noise is at edges; those by chance one in ten and six
   * in ten times. A hidden copy says nothing. */
  double logLikelihoodRatio () const { return 2.0 * support - 3.0 * contradiction; }
};

/** \brief Judges motions that may take an object to itself by the copies of its points (S. Thrun, B. Wegbreit, "Shape
 * from symmetry", ICCV 2005). A copy in space that a view saw free, or below the support plane, contradicts; so does,
 * half as much, one on observed surface that is turned across it. One on surface with the same normal supports, a
 * hidden one is neutral, and so is one on the other side of a wall. */
class CopyJudge
{
public:
  /** \param[in] points of the object, the grid's frame \param[in] plane on which it stands, unit normal towards it
   * \param[in] views and the poses of their sensors in that frame; shape and views must outlive this */
  CopyJudge (const MeasuredShape& shape, const std::vector<OrientedPoint>& points, const Eigen::Vector4d& plane,
             const OcclusionMap::Views& views);

  /** \brief Evenly spread points of the object, moved to the measured surface; at most some fifteen hundred. */
  const std::vector<OrientedPoint>& samples () const { return samples_; }

  bool hasEnoughSamples () const; ///< for any evidence

  bool onPlane () const { return !plane_.head<3> ().isZero (); }

  /** \param[in] stride only every stride-th sample */
  CopyEvidence judge (const Motions& motions, std::size_t stride = 1) const;

private:
  friend class Judgement;

  double freeShare (const Eigen::Vector3d& place) const;
  float nearestReading (std::size_t view, const Eigen::Array2i& pixel) const;
  void judge (const OrientedPoint& sample, const Eigen::Affine3d& motion, CopyEvidence& sums) const;

  const MeasuredShape& shape_;
  Eigen::Vector4d plane_;
  const OcclusionMap::Views& views_;
  std::vector<Eigen::Isometry3d> T_sensor_object_;
  mutable std::vector<std::vector<float>>
      nearest_m_;                           // per view and pixel: nearest reading around; 0: not asked for yet
  std::vector<float> farthest_m_;           // reading, per view
  std::vector<std::uint8_t> known_between_; // per voxel: which of the eight are known of which it is the lowest
  std::vector<OrientedPoint> samples_;
};

/** \brief The evidence for motions, judged copy by copy: motions that cannot be the best any more need not be judged to
 * the end. */
class Judgement
{
public:
  /** \param[in] motions none: they are impossible \param[in] stride as CopyJudge::judge () has it */
  Judgement (Motions motions, const CopyJudge& judge, std::size_t stride);

  bool isDone () const { return judged_ == copies_; }

  /** \brief Judge so many more copies, or those that are left. */
  void goOn (const CopyJudge& judge, std::size_t copies);

  /** \brief Of all copies. */
  CopyEvidence evidence () const;

  /** \brief The log-likelihood ratio; before all copies are judged, one that it cannot exceed. */
  double most () const;

private:
  Motions motions_;
  std::size_t stride_, copies_, judged_ = 0;
  std::size_t motion_ = 0, sample_ = 0; // of the next copy
  CopyEvidence sums_;
};

} // namespace pcl::cosection
