// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include <pcl/cosection/fusion/data_association.h>

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/common/parallel.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace pcl
{
namespace cosection
{

namespace
{

constexpr std::size_t max_models = 250;

void
check (bool good, const char* message)
{
  if (!good)
    throw InvalidArgument (std::string ("data association: ") + message);
}

} // namespace

void
AssociationOptions::validate () const
{
  check (sigma_m > 0.0 && std::isfinite (sigma_m), "sigma_m must be positive");
  check (inlier_share > 0.0 && inlier_share < 1.0, "inlier_share must be between 0 and 1");
  check (uniform > 0.0 && std::isfinite (uniform), "uniform must be positive");
  check (free_truncation > 0.0 && free_truncation <= 1.0, "free_truncation must be in (0, 1]");
  check (threads >= 0, "threads must not be negative");
}

DataAssociation::DataAssociation (const AssociationOptions& options) : options_ (options)
{
  options.validate ();
}

ModelEvidence
DataAssociation::evidence (const AssociatedModel& model, const Eigen::Vector3f& point) const
{
  ModelEvidence result;
  const Eigen::Vector3d p = model.T_model_sensor * point.cast<double> ();
  const auto cell = model.volume->sample<float> (p.cast<float> ());
  if (!cell)
    return result;
  result.known = true;
  result.distance_m = cell->value ();
  result.free = result.distance_m >= options_.free_truncation * model.volume->truncation ();
  if (result.free)
    return result;
  const double foreground =
      model.volume->options ().foreground ? model.volume->foregroundProbability (p).value_or (static_cast<float> (model.uncounted)) : 1.0;
  const double sigma = std::max (options_.sigma_m, depthNoiseSigma (point.z ()));
  result.likelihood = static_cast<float> (options_.inlier_share * foreground *
                                          std::exp (-std::abs (result.distance_m) / sigma) / (2.0 * sigma));
  return result;
}

std::vector<float>
DataAssociation::probabilities (const std::vector<Eigen::Vector3f>& points, const std::vector<AssociatedModel>& models,
                                std::size_t target) const
{
  std::vector<float> result (points.size (), 0.0f);
  const auto outlier = static_cast<float> ((1.0 - options_.inlier_share) * options_.uniform);
  parallelFor (0, static_cast<int> (points.size ()), threadsForVoxels (options_.threads, points.size ()), [&] (int n) {
    const Eigen::Vector3f& point = points[n];
    if (!std::isfinite (point.z ()))
      return;
    const ModelEvidence own = evidence (models[target], point);
    if (!(own.likelihood > 0.0f))
      return;
    float sum = own.likelihood + outlier;
    for (std::size_t m = 0; m < models.size (); ++m)
      if (m != target)
      {
        const ModelEvidence other = evidence (models[m], point);
        sum += other.known ? other.likelihood + outlier : 0.0f;
      }
    result[n] = own.likelihood / sum;
  });
  return result;
}

PointAssignment
DataAssociation::assign (const std::vector<Eigen::Vector3f>& points, const std::vector<AssociatedModel>& models) const
{
  check (models.size () <= max_models, "there are more than 250 models");
  PointAssignment result;
  result.model.assign (points.size (), PointAssignment::no_point);
  result.probability.assign (points.size (), 0.0f);
  result.first.assign (points.size (), 0);
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
      const ModelEvidence model = evidence (models[m], point);
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

} // namespace cosection
} // namespace pcl
