// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "moving_parts.h"

#include "pcl_cosection/common/quantile.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl::cosection
{

namespace
{

constexpr float none = std::numeric_limits<float>::quiet_NaN ();
constexpr int nodes_across = 160; // about
constexpr double model_sigma_voxels = 0.5;
constexpr float unknown_odds = 1.0f; // what is seen for the first time is rather at rest
constexpr float most_odds = 4.0f;
constexpr float moving_density = 0.05f; // per standard deviation, of distances of what moves
constexpr float most_for_rest = 0.25f;  // in a frame
constexpr float most_for_motion = 4.0f;
constexpr float free_sigmas = 6.0f;   // of a reading in free space
constexpr int window = 2;             // nodes; models err in patches, so that a mean of readings is no better than one
constexpr float same_surface = 0.03f; // of the depth
const float log_peak = std::log (0.39894f / moving_density);

/** \brief Standard deviation of a normal distribution of which three quarters are as small as those of these sizes. */
float
spreadOf (std::vector<float> sizes)
{
  return valueOfRank (sizes, 3 * sizes.size () / 4) / 1.1503f;
}

} // namespace

const Eigen::Vector3f&
MovingParts::pointAt (const FrameCloud& cloud, int i, int j) const
{
  return cloud.points[static_cast<std::size_t> (j * step_ + step_ / 2) * cloud.camera.width + i * step_ + step_ / 2];
}

void
MovingParts::begin (const FrameCloud& cloud, const Eigen::Isometry3d& T_world_camera)
{
  step_ = std::max (1, cloud.camera.width / nodes_across);
  const int width = cloud.camera.width / step_;
  const int height = cloud.camera.height / step_;
  carried_ = Image<float> (width, height, none);
  const Eigen::Isometry3f T_last_camera = (T_world_last_.inverse () * T_world_camera).cast<float> ();
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i)
    {
      const Eigen::Vector3f& p = pointAt (cloud, i, j);
      if (!std::isfinite (p.z ()))
        continue;
      float& odds = carried_.at (i, j);
      odds = unknown_odds;
      const Eigen::Vector3f q = T_last_camera * p;
      if (last_.pixels.empty () || q.z () <= 0.0f)
        continue;
      const Eigen::Vector2d pixel = cloud.camera.project (q.cast<double> ());
      const int ii = static_cast<int> (std::floor ((pixel.x () + 0.5) / step_));
      const int jj = static_cast<int> (std::floor ((pixel.y () + 0.5) / step_));
      if (ii < 0 || jj < 0 || ii >= width || jj >= height)
        continue;
      const auto of_same_surface = [&] (int a, int b) {
        return std::abs (last_depth_.at (a, b) - q.z ()) < same_surface * q.z ();
      };
      if (of_same_surface (ii, jj))
      {
        odds = last_.at (ii, jj);
        continue;
      }
      // Outlines fray: one node farther it may have been seen.
      for (int b = std::max (0, jj - 1); b <= std::min (height - 1, jj + 1); ++b)
        for (int a = std::max (0, ii - 1); a <= std::min (width - 1, ii + 1); ++a)
          if (of_same_surface (a, b))
            odds = std::min (odds, last_.at (a, b));
    }
  log_odds_ = carried_;
  any_ = std::any_of (carried_.pixels.begin (), carried_.pixels.end (), [] (float odds) { return odds < 0.0f; });
}

void
MovingParts::look (const FrameCloud& cloud, const std::vector<AssociatedModel>& models,
                   const DataAssociation& association, const Eigen::Isometry3d& T_world_camera)
{
  const int width = carried_.width;
  const int height = carried_.height;
  AssociatedModel background = models[0];
  background.T_model_sensor = T_world_camera;
  const double model_sigma = model_sigma_voxels * background.volume->grid ().voxel_size_m;
  Image<float> sigmas (width, height, none); // distances in units of their standard deviations
  std::vector<float> sizes;
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i)
    {
      const Eigen::Vector3f& p = pointAt (cloud, i, j);
      if (!std::isfinite (p.z ()) || !std::isfinite (cloud.reliable.at (i * step_ + step_ / 2, j * step_ + step_ / 2)))
        continue;
      const ModelEvidence evidence = association.evidence (background, p);
      if (!evidence.known)
        continue;
      bool of_object = false;
      for (std::size_t m = 1; m < models.size () && !of_object; ++m)
      {
        const ModelEvidence other = association.evidence (models[m], p);
        of_object = other.known && !other.free;
      }
      if (of_object)
        continue;
      const float z = evidence.free ? free_sigmas
                                    : static_cast<float> (evidence.distance_m /
                                                          std::hypot (model_sigma, depthNoiseSigma (p.z ())));
      sigmas.at (i, j) = std::min (free_sigmas, std::max (-free_sigmas, z));
      sizes.push_back (std::abs (z));
    }
  log_odds_ = carried_;
  any_ = false;
  if (sizes.empty ())
    return;
  const float scale = 1.0f / std::max (1.0f, spreadOf (std::move (sizes)));
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i)
    {
      const float depth = pointAt (cloud, i, j).z ();
      if (!std::isfinite (depth))
        continue;
      float sum = 0.0f;
      float count = 0.0f;
      for (int jj = std::max (0, j - window); jj <= std::min (height - 1, j + window); ++jj)
        for (int ii = std::max (0, i - window); ii <= std::min (width - 1, i + window); ++ii)
        {
          const float z = sigmas.at (ii, jj);
          if (!std::isfinite (z) || std::abs (pointAt (cloud, ii, jj).z () - depth) > same_surface * depth)
            continue;
          sum += z;
          count += 1.0f;
        }
      if (count == 0.0f)
        continue;
      const float mean = scale * sum / count;
      const float change = std::min (most_for_rest, std::max (-most_for_motion, log_peak - 0.5f * mean * mean));
      float& odds = log_odds_.at (i, j);
      odds = std::min (most_odds, std::max (-most_odds, odds + change));
      any_ = any_ || odds < 0.0f;
    }
}

void
MovingParts::keep (const FrameCloud& cloud, const Eigen::Isometry3d& T_world_camera)
{
  if (log_odds_.pixels.empty ())
    return;
  T_world_last_ = T_world_camera;
  last_ = log_odds_;
  last_depth_ = Image<float> (last_.width, last_.height, none);
  for (int j = 0; j < last_.height; ++j)
    for (int i = 0; i < last_.width; ++i)
      last_depth_.at (i, j) = pointAt (cloud, i, j).z ();
}

double
MovingParts::weigh (const PinholeCamera& camera, const std::vector<Eigen::Vector3f>& points,
                    std::vector<float>& weights) const
{
  double before = 0.0;
  double after = 0.0;
  for (std::size_t n = 0; n < points.size (); ++n)
  {
    if (!(weights[n] > 0.0f))
      continue;
    const Eigen::Vector2d pixel = camera.project (points[n].cast<double> ());
    const int i = std::min (log_odds_.width - 1, static_cast<int> (std::lround (pixel.x ())) / step_);
    const int j = std::min (log_odds_.height - 1, static_cast<int> (std::lround (pixel.y ())) / step_);
    const float odds = log_odds_.at (i, j);
    before += weights[n];
    if (std::isfinite (odds) && odds < unknown_odds)
      weights[n] *= odds > 0.0f ? odds / unknown_odds : 0.0f;
    after += weights[n];
  }
  return before > 0.0 ? 1.0 - after / before : 0.0;
}

void
MovingParts::ignore (const FrameCloud& cloud, const Image<std::uint16_t>& mask, std::uint16_t ignored,
                     const Eigen::Isometry3d& T_world_camera)
{
  if (std::find (mask.pixels.begin (), mask.pixels.end (), ignored) == mask.pixels.end ())
    return;
  if (log_odds_.pixels.empty ())
    begin (cloud, T_world_camera);
  for (int v = 0; v < log_odds_.height * step_; ++v)
    for (int u = 0; u < log_odds_.width * step_; ++u)
      if (float& odds = log_odds_.at (u / step_, v / step_); mask.at (u, v) == ignored && std::isfinite (odds))
        odds = -most_odds;
  any_ = true;
  keep (cloud, T_world_camera);
}

bool
MovingParts::moves (int u, int v) const
{
  return any_ &&
         log_odds_.at (std::min (log_odds_.width - 1, u / step_), std::min (log_odds_.height - 1, v / step_)) < 0.0f;
}

void
MovingParts::mark (const FrameCloud& cloud, Image<std::uint16_t>& labels, std::uint16_t moving) const
{
  if (!any_)
    return;
  for (int v = 0; v < labels.height; ++v)
    for (int u = 0; u < labels.width; ++u)
      if (labels.at (u, v) == 0 && std::isfinite (cloud.depth.at (u, v)) && moves (u, v))
        labels.at (u, v) = moving;
}

Image<std::uint8_t>
MovingParts::image (const FrameCloud& cloud, const Image<std::uint16_t>& labels, std::uint16_t unassigned) const
{
  Image<std::uint8_t> moving (labels.width, labels.height, 0);
  for (int v = 0; v < labels.height; ++v)
    for (int u = 0; u < labels.width; ++u)
    {
      const bool of_none = labels.at (u, v) == 0 || labels.at (u, v) == unassigned;
      moving.at (u, v) = of_none && std::isfinite (cloud.depth.at (u, v)) && moves (u, v);
    }
  return moving;
}

} // namespace pcl::cosection
