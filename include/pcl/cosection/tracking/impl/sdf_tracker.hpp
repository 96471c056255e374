// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/tracking/sdf_tracker.h>

#include <pcl/console/print.h>
#include <pcl/point_types.h>

namespace pcl::cosection
{

template <typename PointInT, typename StateT> SdfTracker<PointInT, StateT>::SdfTracker ()
{
  tracker_name_ = "cosection::SdfTracker";
}

template <typename PointInT, typename StateT>
void
SdfTracker<PointInT, StateT>::setSignedDistance (const TsdfVolume::ConstPtr& volume)
{
  if (!volume)
    throw InvalidArgument ("the signed distance volume is a null pointer");
  volume_ = volume;
  field_.reset ();
}

template <typename PointInT, typename StateT>
void
SdfTracker<PointInT, StateT>::setSignedDistance (const SignedDistanceField::ConstPtr& field)
{
  if (!field)
    throw InvalidArgument ("the signed distance field is a null pointer");
  const SdfTarget checked (*field);
  field_ = field;
  volume_.reset ();
}

template <typename PointInT, typename StateT>
void
SdfTracker<PointInT, StateT>::setTrans (const Eigen::Affine3f& T_sensor_object)
{
  const Eigen::Matrix3d linear = T_sensor_object.linear ().cast<double> ();
  if (!T_sensor_object.matrix ().allFinite () || !linear.isUnitary (1e-3) || !(linear.determinant () > 0.0))
    throw InvalidArgument ("the pose of the object must be a finite rigid motion");
  T_sensor_object_.setIdentity ();
  T_sensor_object_.linear () = Eigen::Quaterniond (linear).normalized ().toRotationMatrix ();
  T_sensor_object_.translation () = T_sensor_object.translation ().cast<double> ();
  motion_.reset ();
  found_before_ = false;
}

template <typename PointInT, typename StateT>
void
SdfTracker<PointInT, StateT>::setMinimumInlierShare (float share)
{
  if (!(share >= 0.0f && share <= 1.0f))
    throw InvalidArgument ("the least share of inliers must be in [0, 1]");
  min_inlier_share_ = share;
}

template <typename PointInT, typename StateT>
void
SdfTracker<PointInT, StateT>::setOptions (const SdfAlignmentOptions& options)
{
  alignment_ = SdfAlignment (options); // validates
}

template <typename PointInT, typename StateT>
StateT
SdfTracker<PointInT, StateT>::getResult () const
{
  StateT state = StateT::toState (Eigen::Affine3f (T_sensor_object_.matrix ().cast<float> ()));
  state.weight = lost_ ? 0.0f : static_cast<float> (result_.inlier_share);
  return state;
}

template <typename PointInT, typename StateT>
bool
SdfTracker<PointInT, StateT>::initCompute ()
{
  result_ = SdfAlignmentResult ();
  lost_ = true;
  return Base::initCompute ();
}

template <typename PointInT, typename StateT>
bool
SdfTracker<PointInT, StateT>::alignFrom (const Eigen::Isometry3d& expected)
{
  const SdfTarget target = volume_ ? SdfTarget (*volume_) : SdfTarget (*field_);
  result_ = alignment_.align (points_, {}, target, expected.inverse ());
  return result_.converged && result_.inlier_share >= min_inlier_share_;
}

template <typename PointInT, typename StateT>
void
SdfTracker<PointInT, StateT>::computeTracking ()
{
  if (!volume_ && !field_)
  {
    PCL_ERROR ("[pcl::%s::compute] There is no signed distance of the object; setSignedDistance () gives one.\n",
               getClassName ().c_str ());
    return;
  }
  points_.clear ();
  for (const auto i : *indices_)
    points_.push_back ((*input_)[i].getVector3fMap ());

  const bool moving = motion_model_ == MotionModel::ConstantVelocity && motion_;
  const bool found = (moving && alignFrom (*motion_ * T_sensor_object_)) || alignFrom (T_sensor_object_);
  lost_ = !found;
  motion_.reset ();
  if (found)
  {
    const Eigen::Isometry3d T_sensor_object = result_.T_grid_sensor.inverse ();
    if (found_before_)
      motion_ = T_sensor_object * T_sensor_object_.inverse ();
    T_sensor_object_ = T_sensor_object;
  }
  found_before_ = found;
}

} // namespace pcl::cosection

#define PCL_INSTANTIATE_CosectionSdfTracker(T) template class pcl::cosection::SdfTracker<T>;
