// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "point_levels.h"

#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <vector>

namespace pcl::cosection {

/** \brief A volume as residuals see it. */
struct SampledVolume
{
  const float* values = nullptr;  ///< metres; NaN: unknown
  const float* weights = nullptr; ///< one per voxel; null: 1
  float weight_scale = 1.0f;      ///< what weights are multiplied by
  Eigen::Vector3i dims = Eigen::Vector3i::Zero ();
  double voxel_size_m = 1.0;
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero ();

  /** \brief What rotations are about, grid frame. */
  Eigen::Vector3d center () const
  {
    return origin_m + 0.5 * voxel_size_m * (dims.cast<double> () - Eigen::Vector3d::Ones ());
  }

  /** \brief Half the diagonal, metres: rotations are in units of 1 / radius (), so that all six parameters are metres.
   */
  double radius () const { return 0.5 * voxel_size_m * dims.cast<double> ().norm (); }
};

/** \brief What counts how much. */
struct RobustWeights
{
  float huber_m;
  float max_distance_m;
};

/** \brief Sums over points that have a distance d with gradient g, at p = T_grid_sensor * point, q = (p - center) /
 * radius. w: weight of the point and the voxel; h: Huber's weight of d. */
struct ResidualSums
{
  std::array<double, 21> squares{}; ///< w h J^T J, upper triangle by rows; J = (g, q x g)
  std::array<double, 6> gradient{}; ///< w h J^T d
  std::array<double, 3> lever{};    ///< w h q
  double squared_lever = 0.0;       ///< w h |q|^2
  double robust_weight = 0.0;       ///< w h
  double weight = 0.0;              ///< w
  double squared_distance = 0.0;    ///< w d^2
  double inlier_weight = 0.0;       ///< w where |d| is within Huber's bound
  double points = 0.0;              ///< 1
  // Over points that had a distance at the pose before, with the weight w that they had there:
  double common_weight = 0.0;
  double cost_before = 0.0; ///< Huber's function there
  double cost = 0.0;        ///< and here

  ResidualSums& operator+= (const ResidualSums& other);
};

/** \brief What is remembered of each point at a pose. */
struct PointCosts
{
  std::vector<float> weight; ///< w; 0: no distance
  std::vector<float> cost;   ///< Huber's function
};

/** \brief Sums over points, in parallel; the same for any number of threads. Keeps its memory. */
class SdfResiduals
{
public:
  /** \param[in] count of the points, the first
   * \param[in] before of the last pose, of as many points at least
   * \param[out] now of this one */
  ResidualSums evaluate (const PointLevels& points, std::size_t count, const SampledVolume& volume,
                         const Eigen::Isometry3d& T_grid_sensor, const RobustWeights& robust, int threads,
                         const PointCosts& before, PointCosts& now);

private:
  std::vector<ResidualSums> blocks_;
};

} // namespace pcl::cosection
