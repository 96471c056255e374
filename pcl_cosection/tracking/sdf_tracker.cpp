// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/tracking/sdf_tracker.h>

#include <pcl/point_types.h>

namespace pcl::cosection {

bool
SdfTrackerBase::setTrans (const Eigen::Affine3f& T_sensor_object)
{
  const Eigen::Matrix3d linear = T_sensor_object.linear ().cast<double> ();
  if (!T_sensor_object.matrix ().allFinite () || !linear.isUnitary (1e-3) || !(linear.determinant () > 0.0))
  {
    report ("setTrans", "the pose of the object must be a finite rigid motion");
    return false;
  }
  T_sensor_object_.setIdentity ();
  T_sensor_object_.linear () = Eigen::Quaterniond (linear).normalized ().toRotationMatrix ();
  T_sensor_object_.translation () = T_sensor_object.translation ().cast<double> ();
  motion_.reset ();
  found_before_ = false;
  return true;
}

bool
SdfTrackerBase::setMinimumInlierShare (float share)
{
  if (!(share >= 0.0f && share <= 1.0f))
  {
    report ("setMinimumInlierShare", "the least share of inliers must be in [0, 1]");
    return false;
  }
  min_inlier_share_ = share;
  return true;
}

void
SdfTrackerBase::beginFrame ()
{
  result_ = SdfAlignmentResult ();
  lost_ = true;
}

bool
SdfTrackerBase::alignFrom (const std::vector<Eigen::Vector3f>& points, const Eigen::Isometry3d& expected)
{
  return alignPoints (getOptions (), points, {}, expected.inverse ()) && result_.converged &&
         result_.inlier_share >= min_inlier_share_;
}

void
SdfTrackerBase::trackPoints (const std::vector<Eigen::Vector3f>& points)
{
  if (!hasTarget ())
  {
    report ("compute", "There is no signed distance of the object; setSignedDistance () gives one");
    return;
  }
  const bool moving = motion_model_ == MotionModel::ConstantVelocity && motion_;
  const bool found = (moving && alignFrom (points, *motion_ * T_sensor_object_)) ||
                     alignFrom (points, T_sensor_object_);
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

BOOST_PP_SEQ_FOR_EACH (PCL_COSECTION_TEMPLATE, pcl::cosection::SdfTracker, PCL_COSECTION_XYZ_POINT_TYPES)
