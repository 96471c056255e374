// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/point_types.h>
#include <pcl/cosection/tracking/sdf_alignment.h>

#include <pcl/common/transforms.h>
#include <pcl/registration/registration.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace pcl::cosection {

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
 * Without a source, a volume or a usable guess align () says so through PCL's console, and hasConverged () is false.
 *
 * Compiled for PCL_COSECTION_XYZ_POINT_TYPES, with the same type as source and target, and float; works for others. */
template <typename PointSource, typename PointTarget = PointSource, typename Scalar = float>
class PCL_COSECTION_EXPORT SdfRegistration : public Registration<PointSource, PointTarget, Scalar>,
                                             public SdfAlignmentBase
{
  using Base = Registration<PointSource, PointTarget, Scalar>;

public:
  /** \brief Shared pointer. */
  using Ptr = shared_ptr<SdfRegistration<PointSource, PointTarget, Scalar>>;
  /** \brief Shared pointer to what is constant. */
  using ConstPtr = shared_ptr<const SdfRegistration<PointSource, PointTarget, Scalar>>;
  /** \brief Homogeneous 4 x 4 matrix. */
  using Matrix4 = typename Base::Matrix4;
  /** \brief Cloud that is aligned. */
  using PointCloudSource = typename Base::PointCloudSource;
  /** \brief Cloud of points on the surface. */
  using PointCloudTarget = typename Base::PointCloudTarget;

  using Base::getClassName;

  SdfRegistration ();

  ~SdfRegistration () override = default;

  /** \brief Set the volume to align with. \return false if it is null or has no surface */
  bool setSignedDistance (const TsdfVolume::ConstPtr& volume) { return setTargetAndSurface (volume); }

  /** \brief Set another signed distance to align with: voxels that are not supported say nothing.
   * \return false if it is null, has not one value per voxel, or has no surface */
  bool setSignedDistance (const SignedDistanceField::ConstPtr& field) { return setTargetAndSurface (field); }

  /** \brief Set the weights of points.
   * \param[in] weights one per point of the input source, whatever the indices; empty: 1 */
  void setWeights (const std::vector<float>& weights) { weights_ = weights; }

  /** \brief Set all parameters at once; the base's setters, where they are used, have precedence. */
  bool setOptions (const SdfAlignmentOptions& options);

  /** \brief The information of the last align () on its pose, see SdfAlignmentResult::information. */
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

  /** \brief Align the source.
   * \param[out] output the transformed source \param[in] guess T_volume_source to begin with */
  void computeTransformation (PointCloudSource& output, const Matrix4& guess) override;

private:
  /** \brief Set the target, and points on its surface as the base's: Base::align () does nothing without these. */
  template <typename TargetPtr> bool setTargetAndSurface (const TargetPtr& target);

  /** \brief The options together with what was set in the base. */
  SdfAlignmentOptions effectiveOptions () const;

  /** \brief Fill result_. \return false, with a message, if that fails */
  bool compute (const Matrix4& guess);

  std::vector<float> weights_;

public:
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};

template <typename PointSource, typename PointTarget, typename Scalar>
SdfRegistration<PointSource, PointTarget, Scalar>::SdfRegistration () : SdfAlignmentBase ("cosection::SdfRegistration")
{
  reg_name_ = "cosection::SdfRegistration";
  max_iterations_ = getOptions ().max_iterations;
  // So that align () gets as far as to say what is missing.
  target_ = pcl::make_shared<PointCloudTarget> ();
  target_cloud_updated_ = false;
}

template <typename PointSource, typename PointTarget, typename Scalar>
template <typename TargetPtr>
bool
SdfRegistration<PointSource, PointTarget, Scalar>::setTargetAndSurface (const TargetPtr& target)
{
  std::vector<Eigen::Vector3f> surface;
  if (!setTarget (target, &surface))
    return false;
  auto cloud = pcl::make_shared<PointCloudTarget> ();
  cloud->reserve (surface.size ());
  for (const Eigen::Vector3f& p : surface)
  {
    PointTarget point;
    point.getVector3fMap () = p;
    cloud->push_back (point);
  }
  this->setInputTarget (cloud);
  return true;
}

template <typename PointSource, typename PointTarget, typename Scalar>
bool
SdfRegistration<PointSource, PointTarget, Scalar>::setOptions (const SdfAlignmentOptions& options)
{
  if (!SdfAlignmentBase::setOptions (options))
    return false;
  max_iterations_ = options.max_iterations;
  return true;
}

template <typename PointSource, typename PointTarget, typename Scalar>
SdfAlignmentOptions
SdfRegistration<PointSource, PointTarget, Scalar>::effectiveOptions () const
{
  SdfAlignmentOptions options = getOptions ();
  options.max_iterations = max_iterations_;
  if (corr_dist_threshold_ < std::sqrt (std::numeric_limits<double>::max ())) // which is the base's for any
    options.max_distance_m = corr_dist_threshold_;
  if (transformation_epsilon_ > 0.0 && hasTarget ())
    options.tolerance_vox = std::sqrt (transformation_epsilon_) / target ().field ().grid.voxel_size_m;
  return options;
}

template <typename PointSource, typename PointTarget, typename Scalar>
bool
SdfRegistration<PointSource, PointTarget, Scalar>::compute (const Matrix4& guess)
{
  result_ = SdfAlignmentResult ();
  if (!weights_.empty () && weights_.size () != input_->size ())
  {
    report ("align", "there are " + std::to_string (weights_.size ()) + " weights for " +
                         std::to_string (input_->size ()) + " points");
    return false;
  }
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
  Eigen::Isometry3d first;
  first.matrix () = guess.template cast<double> ();
  return alignPoints (effectiveOptions (), points, weights, first);
}

template <typename PointSource, typename PointTarget, typename Scalar>
void
SdfRegistration<PointSource, PointTarget, Scalar>::computeTransformation (PointCloudSource& output,
                                                                          const Matrix4& guess)
{
  if (compute (guess))
    final_transformation_ = result_.T_grid_sensor.matrix ().template cast<Scalar> ();
  else if (guess.allFinite ())
    final_transformation_ = guess;
  converged_ = result_.converged;
  nr_iterations_ = result_.iterations;
  transformation_ = final_transformation_;
  pcl::transformPointCloud (output, output, final_transformation_);
}

BOOST_PP_SEQ_FOR_EACH (PCL_COSECTION_EXTERN_TEMPLATE, SdfRegistration, PCL_COSECTION_XYZ_POINT_TYPES)

} // namespace pcl::cosection
