// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "moving_parts.h"

#include "pcl_cosection/common/quantile.h"
#include <pcl/cosection/fusion/dynamic_fusion.h>
#include <pcl/cosection/fusion/frame_segmenter.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl::cosection {
namespace {

constexpr float none = std::numeric_limits<float>::quiet_NaN ();
constexpr int nodes_across = 160; // about, of a grid
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

/** \brief The point of a node, sensor frame. */
const Eigen::Vector3f&
pointAt (const FrameCloud& cloud, int step, int i, int j)
{
  return cloud.points[static_cast<std::size_t> (j * step + step / 2) * cloud.camera.width + i * step + step / 2];
}

/** \brief Signed distance of each node to the background in standard deviations; NaN: not known, or an object's.
 * \param[out] sizes of these distances, before they are cut off */
Image<float>
backgroundDistances (const MovingParts& grid, const FrameCloud& cloud, const std::vector<AssociatedModel>& models,
                     const DataAssociation& association, const Eigen::Isometry3d& T_world_camera,
                     std::vector<float>& sizes)
{
  const int step = grid.step;
  AssociatedModel background = models[0];
  background.T_model_sensor = T_world_camera;
  const double model_sigma = model_sigma_voxels * background.volume->grid ().voxel_size_m;
  Image<float> sigmas (grid.log_odds.width, grid.log_odds.height, none);
  for (int j = 0; j < sigmas.height; ++j)
    for (int i = 0; i < sigmas.width; ++i)
    {
      const Eigen::Vector3f& p = pointAt (cloud, step, i, j);
      if (!std::isfinite (p.z ()) || !std::isfinite (cloud.reliable.at (i * step + step / 2, j * step + step / 2)))
        continue;
      const ModelEvidence evidence = association.evidence (background, p);
      const auto is_seen_there = [&] (const AssociatedModel& object) {
        const ModelEvidence of_object = association.evidence (object, p);
        return of_object.known && !of_object.free;
      };
      if (!evidence.known || std::any_of (models.begin () + 1, models.end (), is_seen_there))
        continue;
      const float z = evidence.free ? free_sigmas
                                    : static_cast<float> (evidence.distance_m /
                                                          std::hypot (model_sigma, depthNoiseSigma (p.z ())));
      sigmas.at (i, j) = std::min (free_sigmas, std::max (-free_sigmas, z));
      sizes.push_back (std::abs (z));
    }
  return sigmas;
}

} // namespace

bool
MovingParts::moves (int u, int v) const
{
  return any && log_odds.at (std::min (log_odds.width - 1, u / step), std::min (log_odds.height - 1, v / step)) < 0.0f;
}

MovingParts
carryOver (const MovingParts& before, const FrameCloud& cloud, const Eigen::Isometry3d& T_world_camera)
{
  MovingParts carried;
  carried.step = std::max (1, cloud.camera.width / nodes_across);
  carried.T_world_camera = T_world_camera;
  const int step = carried.step;
  const int width = cloud.camera.width / step;
  const int height = cloud.camera.height / step;
  carried.log_odds = Image<float> (width, height, none);
  carried.depth = Image<float> (width, height, none);
  const Eigen::Isometry3f T_before_camera = (before.T_world_camera.inverse () * T_world_camera).cast<float> ();
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i)
    {
      const Eigen::Vector3f& p = pointAt (cloud, step, i, j);
      carried.depth.at (i, j) = p.z ();
      if (!std::isfinite (p.z ()))
        continue;
      float& odds = carried.log_odds.at (i, j);
      odds = unknown_odds;
      const Eigen::Vector3f q = T_before_camera * p;
      if (before.log_odds.pixels.empty () || q.z () <= 0.0f)
        continue;
      const Eigen::Vector2d pixel = cloud.camera.project (q.cast<double> ());
      const int ii = static_cast<int> (std::floor ((pixel.x () + 0.5) / step));
      const int jj = static_cast<int> (std::floor ((pixel.y () + 0.5) / step));
      if (ii < 0 || jj < 0 || ii >= width || jj >= height)
        continue;
      const auto of_same_surface = [&] (int a, int b) {
        return std::abs (before.depth.at (a, b) - q.z ()) < same_surface * q.z ();
      };
      if (of_same_surface (ii, jj))
      {
        odds = before.log_odds.at (ii, jj);
        continue;
      }
      // Outlines are noisy: the surface may have been one node farther.
      for (int b = std::max (0, jj - 1); b <= std::min (height - 1, jj + 1); ++b)
        for (int a = std::max (0, ii - 1); a <= std::min (width - 1, ii + 1); ++a)
          if (of_same_surface (a, b))
            odds = std::min (odds, before.log_odds.at (a, b));
    }
  carried.any = std::any_of (carried.log_odds.pixels.begin (), carried.log_odds.pixels.end (),
                             [] (float odds) { return odds < 0.0f; });
  return carried;
}

MovingParts
observeMotion (const MovingParts& carried, const FrameCloud& cloud, const std::vector<AssociatedModel>& models,
               const DataAssociation& association, const Eigen::Isometry3d& T_world_camera)
{
  MovingParts observed = carried;
  observed.any = false;
  const int width = carried.log_odds.width;
  const int height = carried.log_odds.height;
  std::vector<float> sizes;
  const Image<float> sigmas = backgroundDistances (carried, cloud, models, association, T_world_camera, sizes);
  if (sizes.empty ())
    return observed;
  const float scale = 1.0f / std::max (1.0f, spreadOf (std::move (sizes)));
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i)
    {
      const float depth = carried.depth.at (i, j);
      if (!std::isfinite (depth))
        continue;
      float sum = 0.0f;
      float count = 0.0f;
      for (int jj = std::max (0, j - window); jj <= std::min (height - 1, j + window); ++jj)
        for (int ii = std::max (0, i - window); ii <= std::min (width - 1, i + window); ++ii)
        {
          const float z = sigmas.at (ii, jj);
          if (!std::isfinite (z) || std::abs (carried.depth.at (ii, jj) - depth) > same_surface * depth)
            continue;
          sum += z;
          count += 1.0f;
        }
      if (count == 0.0f)
        continue;
      const float mean = scale * sum / count;
      const float change = std::min (most_for_rest, std::max (-most_for_motion, log_peak - 0.5f * mean * mean));
      float& odds = observed.log_odds.at (i, j);
      odds = std::min (most_odds, std::max (-most_odds, odds + change));
      observed.any = observed.any || odds < 0.0f;
    }
  return observed;
}

MovingParts
withIgnored (MovingParts moving, const FrameCloud& cloud, const Image<std::uint16_t>& mask,
             const Eigen::Isometry3d& T_world_camera)
{
  constexpr std::uint16_t ignored = FrameSegmenter::ignored;
  if (std::find (mask.pixels.begin (), mask.pixels.end (), ignored) == mask.pixels.end ())
    return moving;
  if (moving.log_odds.pixels.empty ())
    moving = carryOver (moving, cloud, T_world_camera);
  for (int v = 0; v < moving.log_odds.height * moving.step; ++v)
    for (int u = 0; u < moving.log_odds.width * moving.step; ++u)
      if (float& odds = moving.log_odds.at (u / moving.step, v / moving.step);
          mask.at (u, v) == ignored && std::isfinite (odds))
        odds = -most_odds;
  moving.any = true;
  return moving;
}

RestingWeights
restingWeights (const MovingParts& moving, const PinholeCamera& camera, const std::vector<Eigen::Vector3f>& points,
                std::vector<float> weights)
{
  double before = 0.0;
  double after = 0.0;
  for (std::size_t n = 0; n < points.size (); ++n)
  {
    if (!(weights[n] > 0.0f))
      continue;
    const Eigen::Vector2d pixel = camera.project (points[n].cast<double> ());
    const int i = std::min (moving.log_odds.width - 1, static_cast<int> (std::lround (pixel.x ())) / moving.step);
    const int j = std::min (moving.log_odds.height - 1, static_cast<int> (std::lround (pixel.y ())) / moving.step);
    const float odds = moving.log_odds.at (i, j);
    before += weights[n];
    if (std::isfinite (odds) && odds < unknown_odds)
      weights[n] *= odds > 0.0f ? odds / unknown_odds : 0.0f;
    after += weights[n];
  }
  return {std::move (weights), before > 0.0 ? 1.0 - after / before : 0.0};
}

Image<std::uint8_t>
movingPixels (const MovingParts& moving, const FrameCloud& cloud, const Image<std::uint16_t>& labels)
{
  Image<std::uint8_t> pixels (labels.width, labels.height, 0);
  for (int v = 0; v < labels.height; ++v)
    for (int u = 0; u < labels.width; ++u)
    {
      const bool of_none = labels.at (u, v) == 0 || labels.at (u, v) == TrackedFrame::unassigned;
      pixels.at (u, v) = of_none && std::isfinite (cloud.depth.at (u, v)) && moving.moves (u, v);
    }
  return pixels;
}

} // namespace pcl::cosection
