// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/volume/tsdf_volume.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstddef>
#include <vector>

namespace pcl::cosection
{

/** \brief A reading near a model's surface, in any one frame. */
struct SurfaceSample
{
  Eigen::Vector3d position;
  Eigen::Vector3d normal;
  double points;   ///< that it stands for
  double weight;   ///< of all of them
  double distance; ///< signed, metres
  double facing;   ///< share of its slope along a direction from which on it tells of it: more than noise makes
  bool settled;    ///< the model was seen there often
};

/** \brief How readings are compared with a model. */
struct SampleOptions
{
  std::size_t most_points = 5000; ///< that are asked
  double reach_vox = 0.0; ///< to either side, over which the slope of distances is taken; 0: that of the cell. Young
                          ///< models are rough
  /** \brief Take slopes as far as noise in the model's distances asks for, and no sample to tell of a direction by
   * noise alone. Otherwise what is far away, and rough in the model, tells of motion along itself. */
  bool smooth_noise = false;
};

/** \brief The points at which a model knows a distance and where it grows, model frame.
 * \param[in] points sensor frame, with \a weights; those without weight are left out */
std::vector<SurfaceSample> sampleSurface (const std::vector<Eigen::Vector3f>& points, const std::vector<float>& weights,
                                          const TsdfVolume& volume, const Eigen::Isometry3d& T_model_sensor,
                                          const SampleOptions& options);

/** \brief Small motions as vectors: a shift, and a turn about the samples' centre in units of their root mean square
 * distance from it, so that all six numbers say how far samples move. */
class MotionChart
{
public:
  using Vector6d = Eigen::Matrix<double, 6, 1>;

  explicit MotionChart (const std::vector<SurfaceSample>& samples);

  /** \brief Derivative of the sample's distance by the motion. */
  Vector6d slope (const SurfaceSample& sample) const { return slope (sample.position, sample.normal); }

  /** \brief Derivative by the motion of what has a \a gradient at \a position. */
  Vector6d slope (const Eigen::Vector3d& position, const Eigen::Vector3d& gradient) const
  {
    Vector6d slope;
    slope << gradient, (position - centre_).cross (gradient) / radius_;
    return slope;
  }

  /** \brief Where a position is among the samples: from their centre, in units of their root mean square distance from
   * it. */
  Eigen::Vector3d place (const Eigen::Vector3d& position) const { return (position - centre_) / radius_; }

  Vector6d coordinates (const Eigen::Isometry3d& motion) const;

  Eigen::Isometry3d motion (const Vector6d& coordinates) const;

private:
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero ();
  double radius_ = 1e-6;
};

/** \brief How much of the samples' weight tells of motion along a direction: of those that face it. */
struct Telling
{
  double all = 0.0;     ///< weight times the square of that change
  double settled = 0.0; ///< the same where the model has settled

  /** \brief Whether the direction counts as told. \param[in] total weight of all samples */
  bool isEnough (double total) const { return all >= least_share * total || settled >= least_settled_share * total; }

  static constexpr double least_share = 0.005;
  static constexpr double least_settled_share = 0.001; ///< less noise there, which bends distances
};

Telling tellingOf (const std::vector<SurfaceSample>& samples, const MotionChart& chart,
                   const MotionChart::Vector6d& direction);

} // namespace pcl::cosection
