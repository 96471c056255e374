// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/tracking/sdf_alignment.h>

#include <pcl/tracking/tracker.h>
#include <pcl/tracking/tracking.h>

#include <Eigen/Geometry>

#include <optional>
#include <vector>

namespace pcl::cosection
{

/** \brief Where SdfTracker expects the object in the next frame. */
enum class MotionModel
{
  ConstantPose,     ///< where it was
  ConstantVelocity, ///< moved on as from the frame before to the last, and where it was if that leads nowhere
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
 * Without a cloud or a volume compute () says so through PCL's console, and the object is lost; setters throw
 * InvalidArgument.
 *
 * Instantiated for pcl::PointXYZ, PointXYZI, PointXYZRGB, PointXYZRGBA, PointNormal and PointXYZRGBNormal, with the
 * state pcl::tracking::ParticleXYZRPY; for others define PCL_NO_PRECOMPILE before the include. */
template <typename PointInT, typename StateT = pcl::tracking::ParticleXYZRPY>
class PCL_COSECTION_EXPORT SdfTracker : public pcl::tracking::Tracker<PointInT, StateT>
{
  using Base = pcl::tracking::Tracker<PointInT, StateT>;

public:
  using Ptr = shared_ptr<SdfTracker<PointInT, StateT>>;
  using ConstPtr = shared_ptr<const SdfTracker<PointInT, StateT>>;

  SdfTracker ();
  ~SdfTracker () override = default;

  /** \brief The object. \throws InvalidArgument if it is null */
  void setSignedDistance (const TsdfVolume::ConstPtr& volume);

  /** \brief The same for other fields. \throws InvalidArgument if it is null or not valid */
  void setSignedDistance (const SignedDistanceField::ConstPtr& field);

  /** \brief T_sensor_object of the next frame; forgets the velocity. \throws InvalidArgument if it is not a finite
   * rigid motion */
  void setTrans (const Eigen::Affine3f& T_sensor_object);

  /** \brief Default: constant velocity. */
  void setMotionModel (MotionModel model) { motion_model_ = model; }

  /** \brief Least SdfAlignmentResult::inlier_share of a frame in which the object is not lost; default 0.5.
   * \throws InvalidArgument if it is not in [0, 1] */
  void setMinimumInlierShare (float share);

  /** \throws InvalidArgument */
  void setOptions (const SdfAlignmentOptions& options);

  const SdfAlignmentOptions& getOptions () const { return alignment_.options (); }

  /** \brief T_sensor_object; its weight is the share of inliers, 0 where the object is lost. */
  StateT getResult () const override;

  /** \brief The same in double precision. */
  const Eigen::Isometry3d& getPose () const { return T_sensor_object_; }

  Eigen::Affine3f toEigenMatrix (const StateT& state) const { return state.toEigenMatrix (); }

  /** \brief In the last compute (), or because there was none. */
  bool isLost () const { return lost_; }

  /** \brief Of the last compute (). */
  const SdfAlignmentResult& getAlignment () const { return result_; }

protected:
  using Base::getClassName;
  using Base::indices_;
  using Base::input_;
  using Base::tracker_name_;

  bool initCompute () override;

private:
  void computeTracking () override;

  /** \brief Fill result_ from an expected T_sensor_object; whether the object was found. */
  bool alignFrom (const Eigen::Isometry3d& expected);

  SdfAlignment alignment_;
  TsdfVolume::ConstPtr volume_;
  SignedDistanceField::ConstPtr field_;
  MotionModel motion_model_ = MotionModel::ConstantVelocity;
  float min_inlier_share_ = 0.5f;
  Eigen::Isometry3d T_sensor_object_ = Eigen::Isometry3d::Identity ();
  std::optional<Eigen::Isometry3d> motion_; // in the sensor's frame, from a frame to the next
  bool found_before_ = false;               // in the frame before
  bool lost_ = true;
  std::vector<Eigen::Vector3f> points_;
  SdfAlignmentResult result_;

public:
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};

} // namespace pcl::cosection

#ifdef PCL_NO_PRECOMPILE
#include <pcl/cosection/tracking/impl/sdf_tracker.hpp>
#else
namespace pcl
{
struct PointXYZ;
struct PointXYZI;
struct PointXYZRGB;
struct PointXYZRGBA;
struct PointNormal;
struct PointXYZRGBNormal;
namespace cosection
{
extern template class PCL_COSECTION_EXPORT SdfTracker<pcl::PointXYZ>;
extern template class PCL_COSECTION_EXPORT SdfTracker<pcl::PointXYZI>;
extern template class PCL_COSECTION_EXPORT SdfTracker<pcl::PointXYZRGB>;
extern template class PCL_COSECTION_EXPORT SdfTracker<pcl::PointXYZRGBA>;
extern template class PCL_COSECTION_EXPORT SdfTracker<pcl::PointNormal>;
extern template class PCL_COSECTION_EXPORT SdfTracker<pcl::PointXYZRGBNormal>;
} // namespace cosection
} // namespace pcl
#endif
