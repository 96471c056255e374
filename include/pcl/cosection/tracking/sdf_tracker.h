// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/point_types.h>
#include <pcl/cosection/tracking/sdf_alignment.h>

#include <pcl/tracking/tracker.h>
#include <pcl/tracking/tracking.h>

#include <Eigen/Geometry>

#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief Where SdfTracker expects the object in the next frame. */
enum class MotionModel
{
  ConstantPose,     ///< where it was
  ConstantVelocity, ///< moved on as from the frame before to the last, and where it was if that leads nowhere
};

/** \brief The pose and parameters of SdfTracker, which do not depend on the types of its points and state. */
class PCL_COSECTION_EXPORT SdfTrackerBase : public SdfAlignmentBase
{
public:
  /** \brief Set the object. \return false if it is null */
  bool setSignedDistance (const TsdfVolume::ConstPtr& volume) { return setTarget (volume); }

  /** \brief Set the object as another signed distance: voxels that are not supported say nothing.
   * \return false if it is null or has not one value per voxel */
  bool setSignedDistance (const SignedDistanceField::ConstPtr& field) { return setTarget (field); }

  /** \brief Set the pose of the object in the next frame; forgets its velocity.
   * \param[in] T_sensor_object takes points of the object to the sensor's frame, metres
   * \return false if it is not a finite rigid motion */
  bool setTrans (const Eigen::Affine3f& T_sensor_object);

  /** \brief Set where the object is expected in the next frame; default: moved on with constant velocity. */
  void setMotionModel (MotionModel model) { motion_model_ = model; }

  /** \brief Set the least SdfAlignmentResult::inlier_share of a frame in which the object is not lost, in [0, 1];
   * default 0.5. */
  bool setMinimumInlierShare (float share);

  /** \brief T_sensor_object in double precision. */
  const Eigen::Isometry3d& getPose () const { return T_sensor_object_; }

  /** \brief Whether the object was not found in the last compute (), or there was none. */
  bool isLost () const { return lost_; }

protected:
  SdfTrackerBase () : SdfAlignmentBase ("cosection::SdfTracker") {}

  ~SdfTrackerBase () = default;

  /** \brief Forget the last result. */
  void beginFrame ();

  /** \brief Find the object among the points of a frame, sensor frame, metres. */
  void trackPoints (const std::vector<Eigen::Vector3f>& points);

private:
  /** \brief Fill the result from an expected T_sensor_object; whether the object was found. */
  bool alignFrom (const std::vector<Eigen::Vector3f>& points, const Eigen::Isometry3d& expected);

  MotionModel motion_model_ = MotionModel::ConstantVelocity;
  float min_inlier_share_ = 0.5f;
  Eigen::Isometry3d T_sensor_object_ = Eigen::Isometry3d::Identity ();
  std::optional<Eigen::Isometry3d> motion_; // in the sensor's frame, from a frame to the next
  bool found_before_ = false;               // in the frame before
  bool lost_ = true;
};

/** \brief Follows an object of known shape through depth images, as a pcl::tracking::Tracker: each frame's points are
 * aligned with the object's signed distance (SdfAlignment), from where the object is expected.
 *
 * \code
 * pcl::cosection::SdfTracker<pcl::PointXYZ> tracker;
 * tracker.setSignedDistance (volume);           // object frame
 * tracker.setTrans (T_sensor_object);           // in the first frame, roughly
 * for (const auto& cloud : frames)              // sensor frame, metres
 * {
 *   tracker.setInputCloud (cloud);
 *   tracker.compute ();
 *   if (!tracker.isLost ())
 *     std::cout << tracker.toEigenMatrix (tracker.getResult ()).matrix ();
 * }
 * \endcode
 *
 * The state is T_sensor_object, as that of PCL's particle filters. Points of the rest of the scene pull at the object
 * where the volume says how far they are from it: give the object's own points (setIndices ()), or set max_distance_m
 * in the options.
 *
 * The object is lost in a frame in which the alignment does not converge, or fewer than the least share of the points
 * fit. The state is then that of the last frame in which it was not, and so is the next expectation.
 *
 * Without a cloud or a volume compute () says so through PCL's console, and the object is lost.
 *
 * Compiled for PCL_COSECTION_XYZ_POINT_TYPES, with the state pcl::tracking::ParticleXYZRPY; works for others. */
template <typename PointInT, typename StateT = pcl::tracking::ParticleXYZRPY>
class PCL_COSECTION_EXPORT SdfTracker : public pcl::tracking::Tracker<PointInT, StateT>, public SdfTrackerBase
{
  using Base = pcl::tracking::Tracker<PointInT, StateT>;

public:
  /** \brief Shared pointer. */
  using Ptr = shared_ptr<SdfTracker<PointInT, StateT>>;
  /** \brief Shared pointer to what is constant. */
  using ConstPtr = shared_ptr<const SdfTracker<PointInT, StateT>>;

  SdfTracker () { tracker_name_ = "cosection::SdfTracker"; }

  ~SdfTracker () override = default;

  /** \brief The state: T_sensor_object, with the share of inliers as its weight, 0 where the object is lost. */
  StateT getResult () const override;

  /** \brief The pose that a state stands for. */
  Eigen::Affine3f toEigenMatrix (const StateT& state) const { return state.toEigenMatrix (); }

protected:
  using Base::getClassName;
  using Base::indices_;
  using Base::input_;
  using Base::tracker_name_;

  /** \brief Begin a frame. \return false without a cloud */
  bool initCompute () override;

private:
  void computeTracking () override;

public:
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};

template <typename PointInT, typename StateT>
StateT
SdfTracker<PointInT, StateT>::getResult () const
{
  StateT state = StateT::toState (Eigen::Affine3f (getPose ().matrix ().template cast<float> ()));
  state.weight = isLost () ? 0.0f : static_cast<float> (result_.inlier_share);
  return state;
}

template <typename PointInT, typename StateT>
bool
SdfTracker<PointInT, StateT>::initCompute ()
{
  beginFrame ();
  return Base::initCompute ();
}

template <typename PointInT, typename StateT>
void
SdfTracker<PointInT, StateT>::computeTracking ()
{
  std::vector<Eigen::Vector3f> points;
  points.reserve (indices_->size ());
  for (const auto i : *indices_)
    points.push_back ((*input_)[i].getVector3fMap ());
  trackPoints (points);
}

BOOST_PP_SEQ_FOR_EACH (PCL_COSECTION_EXTERN_TEMPLATE, SdfTracker, PCL_COSECTION_XYZ_POINT_TYPES)

} // namespace pcl::cosection
