// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/volume/tsdf_volume.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstddef>
#include <vector>

namespace pcl::cosection {

using Vector6d = Eigen::Matrix<double, 6, 1>; ///< a motion in a chart's coordinates
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/** \brief A reading near a model's surface, in any one frame. */
struct SurfaceSample
{
  Eigen::Vector3d position;
  Eigen::Vector3d normal;
  double points;   ///< how many it represents
  double weight;   ///< of all of them
  double distance; ///< signed, metres
  double facing;   ///< least share of its slope along a direction that it observes: more than noise makes
  bool settled;    ///< the model was often seen there
};

/** \brief How readings are compared with a model. */
struct SampleOptions
{
  std::size_t most_points = 5000;
  // Half length of the differences that give slopes, as young models are rough; 0: of the cell.
  double reach_vox = 0.0;
  /** \brief Take differences as long as noise in the model's distances calls for, so that no sample observes a
   * direction by noise alone. Otherwise surfaces that are far away, and rough in the model, observe motion along
   * themselves. */
  bool smooth_noise = false;
};

/** \brief The points at which a model knows a distance and its slope, model frame.
 * \param[in] points sensor frame, with \a weights; those of weight 0 are left out */
std::vector<SurfaceSample> sampleSurface (const std::vector<Eigen::Vector3f>& points, const std::vector<float>& weights,
                                          const TsdfVolume& volume, const Eigen::Isometry3d& T_model_sensor,
                                          const SampleOptions& options);

/** \brief Small motions as vectors in metres: a shift, and a turn about the samples' centre times their root mean
 * square distance from it, so that all six numbers say how far samples move. */
class MotionChart
{
public:
  explicit MotionChart (const std::vector<SurfaceSample>& samples);

  /** \brief Derivative of the sample's distance by the motion. */
  Vector6d slope (const SurfaceSample& sample) const { return slope (sample.position, sample.normal); }

  /** \brief Derivative by the motion of a quantity with a \a gradient at \a position. */
  Vector6d slope (const Eigen::Vector3d& position, const Eigen::Vector3d& gradient) const
  {
    Vector6d slope;
    slope << gradient, (position - centre_).cross (gradient) / radius_;
    return slope;
  }

  /** \brief A position relative to the samples' centre, in units of their root mean square distance from it. */
  Eigen::Vector3d place (const Eigen::Vector3d& position) const { return (position - centre_) / radius_; }

  Vector6d coordinates (const Eigen::Isometry3d& motion) const;

  Eigen::Isometry3d motion (const Vector6d& coordinates) const;

private:
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero ();
  double radius_ = 1e-6;
};

/** \brief How much of the samples' weight observes motion along a direction: of the samples that face it. */
struct DirectionSupport
{
  double all = 0.0;     ///< weight times the square of the distance's change
  double settled = 0.0; ///< the part of settled samples
};

DirectionSupport directionSupport (const std::vector<SurfaceSample>& samples, const MotionChart& chart,
                                   const Vector6d& direction);

/** \brief A principal direction of the samples' distances by the motion. */
struct PrincipalDirection
{
  Vector6d direction;
  double curvature; ///< of half the sum of squares
  double support;   ///< DirectionSupport::all
  bool observed;    ///< by enough of the samples' weight
};

/** \brief All six, by ascending curvature. */
std::vector<PrincipalDirection> principalDirections (const std::vector<SurfaceSample>& samples,
                                                     const MotionChart& chart);

/** \brief The part of a motion that the surface observes. */
struct ObservedMotion
{
  Eigen::Isometry3d T_model_camera = Eigen::Isometry3d::Identity ();
  int directions = 0; ///< of six, those that are observed
  /** \brief Along these, the inverse of the covariance of independent readings, in the coordinates of the samples'
   * chart, 1 / m^2. */
  Matrix6d precision = Matrix6d::Zero ();
};

/** \brief What is expected of a motion. */
struct MotionPrior
{
  double correlated = 0.0;    ///< points with the same error; 0: there are no errors, and every motion is significant
  double cost_of_turns = 1.0; ///< relative to shifts, where a surface observes only both together, as that of a ball
};

/** \brief Undo the part of a step along directions that the surface does not observe.
 *
 * Noise bends the distances before a bare wall, so that curvature alone claims that motion along the wall is observed.
 * A direction counts as observed only by points at which the distance changes along it at half its slope or more; fewer
 * are enough where the model has settled.
 *
 * A part that is not significant is undone, too: shorter than three of its standard deviations, by the spread of the
 * distances, it may be no motion at all. Otherwise weakly observed poses would follow noise and everything that moves.
 * \param[in] samples where the step ended, model frame
 * \param[in] guess T_model_camera where the step began
 * \param[in] found where it ended */
ObservedMotion observedMotion (const std::vector<SurfaceSample>& samples, const Eigen::Isometry3d& guess,
                               const Eigen::Isometry3d& found, const MotionPrior& prior);

} // namespace pcl::cosection
