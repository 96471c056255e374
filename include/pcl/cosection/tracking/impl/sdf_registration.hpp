// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "pcl_cosection/tracking/surface_points.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/tracking/sdf_registration.h>

#include <pcl/common/transforms.h>
#include <pcl/console/print.h>
#include <pcl/point_types.h>

#include <cmath>
#include <limits>

namespace pcl::cosection
{

template <typename PointSource, typename PointTarget, typename Scalar>
SdfRegistration<PointSource, PointTarget, Scalar>::SdfRegistration ()
{
  reg_name_ = "cosection::SdfRegistration";
  max_iterations_ = options_.max_iterations;
  // So that align () gets as far as to say what is missing.
  target_ = pcl::make_shared<PointCloudTarget> ();
  target_cloud_updated_ = false;
}

template <typename PointSource, typename PointTarget, typename Scalar>
void
SdfRegistration<PointSource, PointTarget, Scalar>::publishSurface (const SignedDistanceField& field)
{
  const auto points = surfacePoints (field);
  if (points.empty ())
    throw InvalidArgument ("the signed distance has no surface: it does not change its sign");
  auto target = pcl::make_shared<PointCloudTarget> ();
  target->reserve (points.size ());
  for (const Eigen::Vector3f& p : points)
  {
    PointTarget point;
    point.getVector3fMap () = p;
    target->push_back (point);
  }
  this->setInputTarget (target);
}

template <typename PointSource, typename PointTarget, typename Scalar>
void
SdfRegistration<PointSource, PointTarget, Scalar>::setSignedDistance (const TsdfVolume::ConstPtr& volume)
{
  if (!volume)
    throw InvalidArgument ("the signed distance volume is a null pointer");
  publishSurface (volume->field ());
  volume_ = volume;
  field_.reset ();
}

template <typename PointSource, typename PointTarget, typename Scalar>
void
SdfRegistration<PointSource, PointTarget, Scalar>::setSignedDistance (const SignedDistanceField::ConstPtr& field)
{
  if (!field)
    throw InvalidArgument ("the signed distance field is a null pointer");
  publishSurface (SdfTarget (*field).field ()); // which checks it
  field_ = field;
  volume_.reset ();
}

template <typename PointSource, typename PointTarget, typename Scalar>
void
SdfRegistration<PointSource, PointTarget, Scalar>::setWeights (const std::vector<float>& weights)
{
  weights_ = weights;
}

template <typename PointSource, typename PointTarget, typename Scalar>
void
SdfRegistration<PointSource, PointTarget, Scalar>::setOptions (const SdfAlignmentOptions& options)
{
  options.validate ();
  options_ = options;
  max_iterations_ = options.max_iterations;
}

template <typename PointSource, typename PointTarget, typename Scalar>
SdfAlignmentOptions
SdfRegistration<PointSource, PointTarget, Scalar>::effectiveOptions (double voxel_size_m) const
{
  SdfAlignmentOptions options = options_;
  options.max_iterations = max_iterations_;
  if (corr_dist_threshold_ < std::sqrt (std::numeric_limits<double>::max ())) // which is the base's for any
    options.max_distance_m = corr_dist_threshold_;
  if (transformation_epsilon_ > 0.0)
    options.tolerance_vox = std::sqrt (transformation_epsilon_) / voxel_size_m;
  return options;
}

template <typename PointSource, typename PointTarget, typename Scalar>
void
SdfRegistration<PointSource, PointTarget, Scalar>::compute (const Matrix4& guess)
{
  if (!volume_ && !field_)
    throw InvalidArgument ("there is no signed distance to align with; setSignedDistance () gives one");
  if (!weights_.empty () && weights_.size () != input_->size ())
    throw InvalidArgument ("there are " + std::to_string (weights_.size ()) + " weights for " +
                           std::to_string (input_->size ()) + " points");
  std::vector<Eigen::Vector3f> points;
  std::vector<float> weights;
  points.reserve (indices_->size ());
  weights.reserve (weights_.empty () ? 0 : indices_->size ());
  for (const auto i : *indices_)
  {
    points.push_back ((*input_)[i].getVector3fMap ());
    if (!weights_.empty ())
      weights.push_back (weights_[i]);
  }
  const SdfTarget target = volume_ ? SdfTarget (*volume_) : SdfTarget (*field_);
  Eigen::Isometry3d first;
  first.matrix () = guess.template cast<double> ();
  SdfAlignment alignment (effectiveOptions (target.field ().grid.voxel_size_m));
  result_ = alignment.align (points, weights, target, first);
}

template <typename PointSource, typename PointTarget, typename Scalar>
void
SdfRegistration<PointSource, PointTarget, Scalar>::computeTransformation (PointCloudSource& output,
                                                                          const Matrix4& guess)
{
  result_ = SdfAlignmentResult ();
  try
  {
    compute (guess);
    final_transformation_ = result_.T_grid_sensor.matrix ().template cast<Scalar> ();
  }
  catch (const Error& error)
  {
    PCL_ERROR ("[pcl::%s::align] %s.\n", getClassName ().c_str (), error.what ());
    if (guess.allFinite ())
      final_transformation_ = guess;
  }
  converged_ = result_.converged;
  nr_iterations_ = result_.iterations;
  transformation_ = final_transformation_;
  pcl::transformPointCloud (output, output, final_transformation_);
}

} // namespace pcl::cosection

#define PCL_INSTANTIATE_CosectionSdfRegistration(T) template class pcl::cosection::SdfRegistration<T>;
