// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "data_association.h"

#include "pcl_cosection/common/boxes.h"
#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/common/require.h"
#include <pcl/cosection/common/camera.h>

#include <algorithm>
#include <cmath>

namespace pcl::cosection {
namespace {

/** \brief A model prepared for many points. */
class ModelLookup
{
public:
  ModelLookup (const AssociatedModel& model, const AssociationOptions& options)
      : model_ (model)
      , options_ (options)
      , R_ (model.T_model_sensor.linear ().cast<float> ())
      , t_ (model.T_model_sensor.translation ().cast<float> ())
      , box_ (boxOf (model.volume->grid ()).cast<float> ())
      , free_m_ (static_cast<float> (options.free_truncation * model.volume->truncation ()))
      , counted_ (model.volume->options ().foreground)
  {}

  ModelEvidence evidence (const Eigen::Vector3f& point) const
  {
    ModelEvidence result;
    const Eigen::Vector3f p = R_ * point + t_;
    if (!box_.contains (p)) // most points of most objects
      return result;
    const auto cell = model_.volume->sample<float> (p);
    if (!cell)
      return result;
    result.known = true;
    result.distance_m = cell->value ();
    result.free = result.distance_m >= free_m_;
    if (result.free)
      return result;
    const float foreground = counted_ ? model_.volume->foregroundProbability (p.cast<double> ())
                                            .value_or (static_cast<float> (model_.uncounted))
                                      : 1.0f;
    const auto sigma = static_cast<float> (std::max (options_.sigma_m, depthNoiseSigma (point.z ())));
    result.likelihood = static_cast<float> (options_.inlier_share) * foreground *
                        std::exp (-std::abs (result.distance_m) / sigma) / (2.0f * sigma);
    return result;
  }

private:
  const AssociatedModel& model_;
  const AssociationOptions& options_;
  Eigen::Matrix3f R_;
  Eigen::Vector3f t_;
  Eigen::AlignedBox3f box_; // of the voxels' centres
  float free_m_;
  bool counted_;
};

std::vector<ModelLookup>
lookups (const std::vector<AssociatedModel>& models, const AssociationOptions& options)
{
  std::vector<ModelLookup> result;
  for (const AssociatedModel& model : models)
    result.emplace_back (model, options);
  return result;
}

} // namespace

void
AssociationOptions::validate () const
{
  require (isPositive (sigma_m), "data association: sigma_m must be positive");
  require (inlier_share > 0.0 && inlier_share < 1.0, "data association: inlier_share must be between 0 and 1");
  require (isPositive (uniform), "data association: uniform must be positive");
  require (free_truncation > 0.0 && free_truncation <= 1.0, "data association: free_truncation must be in (0, 1]");
  require (threads >= 0, "data association: threads must not be negative");
}

DataAssociation::DataAssociation (const AssociationOptions& options) : options_ (options)
{
  options.validate ();
}

ModelEvidence
DataAssociation::evidence (const AssociatedModel& model, const Eigen::Vector3f& point) const
{
  return ModelLookup (model, options_).evidence (point);
}

std::vector<float>
DataAssociation::probabilities (const std::vector<Eigen::Vector3f>& points, const std::vector<AssociatedModel>& models,
                                std::size_t target) const
{
  std::vector<float> result (points.size (), 0.0f);
  const std::vector<ModelLookup> known = lookups (models, options_);
  const auto outlier = static_cast<float> ((1.0 - options_.inlier_share) * options_.uniform);
  parallelFor (0, static_cast<int> (points.size ()), threadsForVoxels (options_.threads, points.size ()), [&] (int n) {
    const Eigen::Vector3f& point = points[n];
    if (!std::isfinite (point.z ()))
      return;
    const ModelEvidence own = known[target].evidence (point);
    if (!(own.likelihood > 0.0f))
      return;
    float sum = own.likelihood + outlier;
    for (std::size_t m = 0; m < models.size (); ++m)
      if (m != target)
      {
        const ModelEvidence other = known[m].evidence (point);
        sum += other.known ? other.likelihood + outlier : 0.0f;
      }
    result[n] = own.likelihood / sum;
  });
  return result;
}

PointAssignment
DataAssociation::assign (const std::vector<Eigen::Vector3f>& points, const std::vector<AssociatedModel>& models) const
{
  require (models.size () <= 250, "data association: there are more than 250 models");
  PointAssignment result;
  result.model.assign (points.size (), PointAssignment::no_point);
  result.probability.assign (points.size (), 0.0f);
  result.first.assign (points.size (), 0);
  const std::vector<ModelLookup> known = lookups (models, options_);
  const auto outlier = static_cast<float> ((1.0 - options_.inlier_share) * options_.uniform);
  parallelFor (0, static_cast<int> (points.size ()), threadsForVoxels (options_.threads, points.size ()), [&] (int n) {
    const Eigen::Vector3f& point = points[n];
    if (!std::isfinite (point.z ()))
      return;
    result.model[n] = PointAssignment::none;
    float best = 0.0f;
    float sum = 0.0f;
    for (std::size_t m = 0; m < models.size (); ++m)
    {
      const ModelEvidence model = known[m].evidence (point);
      if (m == 0 && model.known)
        result.first[n] = model.free ? 2 : 1;
      if (!model.known)
        continue;
      sum += model.likelihood + outlier;
      if (model.likelihood > best)
      {
        best = model.likelihood;
        result.model[n] = static_cast<std::uint8_t> (m);
      }
    }
    if (best > 0.0f)
      result.probability[n] = best / sum;
  });
  return result;
}

} // namespace pcl::cosection
