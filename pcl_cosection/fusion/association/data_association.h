// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/fusion/dynamic_fusion.h>
#include <pcl/cosection/volume/tsdf_volume.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl::cosection {

/** \brief A model that may explain points; it refers to the volume, which must live as long. */
struct AssociatedModel
{
  const TsdfVolume* volume = nullptr;
  Eigen::Isometry3d T_model_sensor = Eigen::Isometry3d::Identity ();
  double uncounted = 1.0; ///< foreground probability where nothing was counted
};

/** \brief What one model says of a point. */
struct ModelEvidence
{
  float likelihood = 0.0f; ///< alpha L (d) p_foreground, 1 / m; 0 unless it is known and not free
  float distance_m = 0.0f; ///< signed; 0 if not known
  bool known = false;      ///< the model has seen this place
  bool free = false;       ///< and nothing there
};

/** \brief To which model each point belongs. */
struct PointAssignment
{
  static constexpr std::uint8_t no_point = 255; ///< there is no reading
  static constexpr std::uint8_t none = 254;     ///< no model explains the point

  std::vector<std::uint8_t> model; ///< one per point: the most likely of the models, or one of the above
  std::vector<float> probability;  ///< of that model, of being the point's rather than another's or none's
  std::vector<std::uint8_t> first; ///< what the first model says: 0 unknown, 1 surface, 2 free
};

/** \brief Association likelihoods: the probability that a reading shows a model.
 *
 * For a model m with distance d at the point, foreground probability p, and Laplace's density L,
 *
 *     a_m = alpha L (d) p,   P (m) = a_m / sum_k (a_k + (1 - alpha) u)
 *
 * where the sum runs over the models that know the place. Where a model has seen space free it is refused: a = 0.
 *
 * M. Strecke, J. Stueckler, "EM-Fusion: Dynamic Object-Level SLAM with Probabilistic Data Association", ICCV 2019,
 * Section 3.2. */
class DataAssociation
{
public:
  /** \throws InvalidArgument as AssociationOptions::validate () */
  explicit DataAssociation (const AssociationOptions& options = {});

  /** \brief \param[in] point metres, sensor frame */
  ModelEvidence evidence (const AssociatedModel& model, const Eigen::Vector3f& point) const;

  /** \brief P (m) of each point for the model of number \a target; 0 for points that are not finite. */
  std::vector<float> probabilities (const std::vector<Eigen::Vector3f>& points,
                                    const std::vector<AssociatedModel>& models, std::size_t target) const;

  /** \brief The most likely model of each point. \throws InvalidArgument if there are more than 250 models */
  PointAssignment assign (const std::vector<Eigen::Vector3f>& points, const std::vector<AssociatedModel>& models) const;

private:
  AssociationOptions options_;
};

} // namespace pcl::cosection
