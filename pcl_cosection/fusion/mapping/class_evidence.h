// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/fusion/dynamic_fusion.h>

#include <cstddef>
#include <map>
#include <optional>
#include <string>

namespace pcl::cosection {

/** \brief What an object is, by all detections of it.
 *
 * A detection tells the score of one class; those of all others are taken for 0. The score of a class is the mean over
 * all detections. Fusion++ averages class probabilities so, instead of multiplying them as SemanticFusion does:
 * detections from similar views are not independent, and their product soon is certain of what is wrong. J. McCormac et
 * al., "Fusion++: Volumetric Object-Level SLAM", 3DV 2018; J. McCormac et al., "SemanticFusion: Dense 3D Semantic
 * Mapping with Convolutional Neural Networks", ICRA 2017. */
class ClassEvidence
{
public:
  /** \brief Count a detection. \throws InvalidArgument if its score is not in [0, 1] */
  void add (const ClassScore& detection);

  /** \brief Count all detections of something else that turns out to be the same object. */
  void add (const ClassEvidence& other);

  /** \brief How many there were. */
  std::size_t detections () const { return detections_; }

  /** \brief The class of the highest score, of equals that of the smallest class_id, with its score; nothing without a
   * detection. The name is the one that came first with the class_id. */
  std::optional<ClassScore> best () const;

private:
  std::map<int, ClassScore> sums_; // over detections, by class_id
  std::size_t detections_ = 0;
};

} // namespace pcl::cosection
