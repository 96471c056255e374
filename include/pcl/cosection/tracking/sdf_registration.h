// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/tracking/sdf_alignment.h>

#include <pcl/registration/registration.h>

#include <vector>

namespace pcl::cosection
{

/** \brief Aligns a cloud with the surface of a signed distance volume (SdfAlignment), as a pcl::Registration: in place
 * of pcl::IterativeClosestPoint where the target is not a cloud but a model, such as what TsdfVolume has averaged, what
 * HessianIMLS has completed, or a mesh (sampleSignedDistance ()). Neither normals nor a search tree are needed.
 *
 * \code
 * pcl::cosection::SdfRegistration<pcl::PointXYZ> registration;
 * registration.setSignedDistance (volume);   // or imls.getSignedDistance ()
 * registration.setInputSource (cloud);       // sensor frame, metres
 * pcl::PointCloud<pcl::PointXYZ> aligned;
 * registration.align (aligned, guess);       // T_volume_sensor, roughly
 * if (registration.hasConverged ())
 *   std::cout << registration.getFinalTransformation ();
 * \endcode
 *
 * What the base class offers means here:
 * - setInputSource (), setIndices (): points that are not finite are left out; \a output keeps them.
 * - setInputTarget (): has no part in the alignment. setSignedDistance () sets points on the surface as the target,
 * about a voxel apart; a cloud set after it replaces them.
 * - getFitnessScore (): as in PCL the mean squared distance from the source to the nearest point of the target, so not
 * less than the spacing of those points allows. getAlignment () has the root mean square of the exact distances.
 * - setMaximumIterations (): steps tried, 40 unless set. setMaxCorrespondenceDistance (): as
 * SdfAlignmentOptions::max_distance_m. setTransformationEpsilon (): the square of the movement of points at which it
 * ends, m^2; 0 (default): that of the options.
 * - Correspondences, their rejectors, RANSAC, the other epsilons and the visualisation callback have no effect.
 *
 * Without a source, a volume or a usable guess align () says so through PCL's console, and hasConverged () is false;
 * setters throw InvalidArgument.
 *
 * Instantiated for pcl::PointXYZ, PointXYZI, PointXYZRGB, PointXYZRGBA, PointNormal, PointXYZRGBNormal and
 * PointXYZINormal, with the same type as source and target, and float; for others define PCL_NO_PRECOMPILE before the
 * include. */
template <typename PointSource, typename PointTarget = PointSource, typename Scalar = float>
class PCL_COSECTION_EXPORT SdfRegistration : public Registration<PointSource, PointTarget, Scalar>
{
  using Base = Registration<PointSource, PointTarget, Scalar>;

public:
  using Ptr = shared_ptr<SdfRegistration<PointSource, PointTarget, Scalar>>;
  using ConstPtr = shared_ptr<const SdfRegistration<PointSource, PointTarget, Scalar>>;
  using Matrix4 = typename Base::Matrix4;
  using PointCloudSource = typename Base::PointCloudSource;
  using PointCloudTarget = typename Base::PointCloudTarget;

  using Base::getClassName;

  SdfRegistration ();
  ~SdfRegistration () override = default;

  /** \brief What to align with. \throws InvalidArgument if it is null or has no surface */
  void setSignedDistance (const TsdfVolume::ConstPtr& volume);

  /** \brief The same for other fields. \throws InvalidArgument if it is null, not valid or has no surface */
  void setSignedDistance (const SignedDistanceField::ConstPtr& field);

  /** \brief One per point of the input source, whatever the indices; empty: 1. */
  void setWeights (const std::vector<float>& weights);

  /** \brief All parameters; the base's setters, where they are used, have precedence. \throws InvalidArgument */
  void setOptions (const SdfAlignmentOptions& options);

  const SdfAlignmentOptions& getOptions () const { return options_; }

  /** \brief Of the last align (): why it ended, how well points fit, which directions they determine. */
  const SdfAlignmentResult& getAlignment () const { return result_; }

  /** \brief Of the last align (), see SdfAlignmentResult::information. */
  const SdfAlignmentResult::Matrix6d& getInformationMatrix () const { return result_.information; }

protected:
  using Base::converged_;
  using Base::corr_dist_threshold_;
  using Base::final_transformation_;
  using Base::indices_;
  using Base::input_;
  using Base::max_iterations_;
  using Base::nr_iterations_;
  using Base::reg_name_;
  using Base::target_;
  using Base::target_cloud_updated_;
  using Base::transformation_;
  using Base::transformation_epsilon_;

  void computeTransformation (PointCloudSource& output, const Matrix4& guess) override;

private:
  /** \brief Base::align () does nothing without a target. */
  void publishSurface (const SignedDistanceField& field);

  /** \brief The options together with what was set in the base. */
  SdfAlignmentOptions effectiveOptions (double voxel_size_m) const;

  /** \brief Fill result_. \throws Error */
  void compute (const Matrix4& guess);

  SdfAlignmentOptions options_;
  TsdfVolume::ConstPtr volume_;
  SignedDistanceField::ConstPtr field_;
  std::vector<float> weights_;
  SdfAlignmentResult result_;

public:
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};

} // namespace pcl::cosection

#ifdef PCL_NO_PRECOMPILE
#include <pcl/cosection/tracking/impl/sdf_registration.hpp>
#else
namespace pcl
{
struct PointXYZ;
struct PointXYZI;
struct PointXYZRGB;
struct PointXYZRGBA;
struct PointNormal;
struct PointXYZRGBNormal;
struct PointXYZINormal;
namespace cosection
{
extern template class PCL_COSECTION_EXPORT SdfRegistration<pcl::PointXYZ>;
extern template class PCL_COSECTION_EXPORT SdfRegistration<pcl::PointXYZI>;
extern template class PCL_COSECTION_EXPORT SdfRegistration<pcl::PointXYZRGB>;
extern template class PCL_COSECTION_EXPORT SdfRegistration<pcl::PointXYZRGBA>;
extern template class PCL_COSECTION_EXPORT SdfRegistration<pcl::PointNormal>;
extern template class PCL_COSECTION_EXPORT SdfRegistration<pcl::PointXYZRGBNormal>;
extern template class PCL_COSECTION_EXPORT SdfRegistration<pcl::PointXYZINormal>;
} // namespace cosection
} // namespace pcl
#endif
