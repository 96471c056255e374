// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/simulation/simulated_scene.h>

#include "pcl_cosection/common/require.h"
#include "pcl_cosection/simulation/shapes/sine_table.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace pcl::cosection {
namespace {

constexpr float missing = std::numeric_limits<float>::quiet_NaN ();
// A share of the depth: what is so much farther than what the projector lights is in its shadow.
constexpr double shadow_margin = 0.01;

/** \brief Random numbers that belong to a pixel of a frame, whoever draws them (splitmix64). */
class PixelRandom
{
public:
  PixelRandom (std::uint64_t seed, std::uint64_t frame, std::uint64_t pixel)
      : state_ (mix (seed + mix (frame + mix (pixel))))
  {}

  /** \brief In (0, 1). */
  double uniform ()
  {
    state_ += 0x9e3779b97f4a7c15ull;
    return (static_cast<double> (mix (state_) >> 11) + 0.5) * 0x1p-53;
  }

  /** \brief Two independent numbers of the standard normal distribution (Box and Muller). */
  Eigen::Vector2d normal ()
  {
    const double radius = std::sqrt (-2.0 * std::log (uniform ()));
    const double turns = uniform ();
    return {radius * sineTable ().cosine (turns), radius * sineTable ().sine (turns)};
  }

private:
  static std::uint64_t mix (std::uint64_t x)
  {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
    return x ^ (x >> 31);
  }

  std::uint64_t state_;
};

/** \brief Which pixels of row \a v the projector does not light: another pixel of the row is in front, in its picture.
 */
void
findShadows (const Image<float>& depth, int v, double disparity_m_px, std::vector<float>& lit,
             std::vector<bool>& shadow)
{
  const int width = depth.width;
  // The nearest depth in each column of the projector's picture.
  lit.assign (width, std::numeric_limits<float>::infinity ());
  const auto column = [&] (int u) {
    return static_cast<int> (std::max (std::floor (u - disparity_m_px / depth.at (u, v) + 0.5), -2.0));
  };
  const auto spread = [&] (int from, int to, float z) {
    for (int c = std::max (0, from); c <= std::min (width - 1, to); ++c)
      lit[c] = std::min (lit[c], z);
  };
  for (int u = 0; u < width; ++u)
  {
    const float z = depth.at (u, v);
    if (!std::isfinite (z))
      continue;
    const int here = column (u);
    spread (here, here, z);
    if (u + 1 < width && std::abs (depth.at (u + 1, v) - z) < shadow_margin * z) // one surface has no gaps
      spread (std::min (here, column (u + 1)), std::max (here, column (u + 1)), std::max (z, depth.at (u + 1, v)));
  }
  for (int u = 0; u < width; ++u)
  {
    const float z = depth.at (u, v);
    const int c = std::isfinite (z) ? column (u) : -1;
    shadow[u] = c >= 0 && c < width && z > lit[c] * (1.0 + shadow_margin);
  }
}

/** \brief Whether the depth around a pixel has a step. */
bool
isEdge (const Image<float>& depth, int u, int v, double step)
{
  float nearest = std::numeric_limits<float>::infinity (), farthest = 0.0f;
  for (int y = std::max (0, v - 1); y <= std::min (depth.height - 1, v + 1); ++y)
    for (int x = std::max (0, u - 1); x <= std::min (depth.width - 1, u + 1); ++x)
    {
      const float z = depth.at (x, y);
      if (!std::isfinite (z))
        return true;
      nearest = std::min (nearest, z);
      farthest = std::max (farthest, z);
    }
  return farthest - nearest > step * nearest;
}

/** \brief The depth at a place between pixels: interpolated on a surface, the nearest pixel's across its edges. */
float
readBetween (const Image<float>& depth, double u, double v, double step)
{
  u = std::clamp (u, 0.0, depth.width - 1.0);
  v = std::clamp (v, 0.0, depth.height - 1.0);
  const int i = std::min (static_cast<int> (u), std::max (0, depth.width - 2));
  const int j = std::min (static_cast<int> (v), std::max (0, depth.height - 2));
  const int i1 = std::min (i + 1, depth.width - 1), j1 = std::min (j + 1, depth.height - 1);
  const float a = depth.at (i, j), b = depth.at (i1, j), c = depth.at (i, j1), d = depth.at (i1, j1);
  const float low = std::min ({a, b, c, d}), high = std::max ({a, b, c, d});
  if (!(std::isfinite (a + b + c + d) && high - low <= step * low))
    return depth.at (static_cast<int> (std::lround (u)), static_cast<int> (std::lround (v)));
  const double s = u - i, t = v - j;
  // The reciprocal of the depth is linear on a plane.
  return static_cast<float> (1.0 / ((1.0 - t) * ((1.0 - s) / a + s / b) + t * ((1.0 - s) / c + s / d)));
}

} // namespace

void
DepthNoise::validate () const
{
  const auto length = [] (double x) { return std::isfinite (x) && x >= 0.0; };
  const auto probability = [] (double x) { return x >= 0.0 && x <= 1.0; };
  require (length (baseline_m) && baseline_m > 0.0 && baseline_m <= 10.0,
           "baseline must be a positive number of metres, 10 at most");
  require (length (disparity_sigma_px), "disparity_sigma must be a number of pixels, not negative");
  require (length (disparity_step_px), "disparity_step must be a number of pixels, not negative");
  require (length (lateral_sigma_px) && lateral_sigma_px <= 10.0, "lateral_sigma must be a number of pixels, 0 to 10");
  require (grazing_begin_rad >= 0.0 && grazing_begin_rad <= grazing_end_rad && grazing_end_rad <= M_PI_2 + 1e-9,
           "grazing_begin_deg, grazing_end_deg must be ascending angles of 0 to 90 degrees");
  require (probability (edge_dropout), "edge_dropout must be a probability");
  require (length (edge_step) && edge_step > 0.0, "edge_step must be a positive fraction");
  require (probability (dropout), "dropout must be a probability");
  require (length (min_m) && max_m > min_m, "range must be two ascending numbers of metres");
}

Image<float>
measureDepth (const Image<float>& depth, const std::vector<Eigen::Vector3f>& normals, const PinholeCamera& camera,
              const DepthNoise& noise, std::uint64_t seed, std::uint64_t frame)
{
  noise.validate ();
  if (depth.width != camera.width || depth.height != camera.height || normals.size () != depth.pixels.size ())
    throw InvalidArgument ("depth and normals must have the camera's size");
  const double disparity_m_px = camera.fx * noise.baseline_m;
  const double surely_read = std::cos (noise.grazing_begin_rad);
  Image<float> measured (depth.width, depth.height, missing);
  std::vector<float> lit;
  std::vector<bool> shadow (depth.width, false);
  for (int v = 0; v < depth.height; ++v)
  {
    if (noise.shadows)
      findShadows (depth, v, disparity_m_px, lit, shadow);
    for (int u = 0; u < depth.width; ++u)
    {
      const std::size_t pixel = static_cast<std::size_t> (v) * depth.width + u;
      PixelRandom random (seed, frame, pixel);
      const Eigen::Vector2d jitter = noise.lateral_sigma_px * random.normal ();
      const double error_px = noise.disparity_sigma_px * random.normal ().x ();
      const double any = random.uniform (), edge = random.uniform (), grazing = random.uniform ();
      if (shadow[u] || any < noise.dropout || !std::isfinite (depth.pixels[pixel]))
        continue;
      const Eigen::Vector3d ray = camera.unproject (u, v, 1.0);
      const double cosine = -ray.dot (normals[pixel].cast<double> ()) / ray.norm ();
      if (cosine < surely_read && // at flatter angles it depends
          cosine < std::cos (noise.grazing_begin_rad + grazing * (noise.grazing_end_rad - noise.grazing_begin_rad)))
        continue;
      if (edge < noise.edge_dropout && isEdge (depth, u, v, noise.edge_step))
        continue;
      const float z = readBetween (depth, u + jitter.x (), v + jitter.y (), noise.edge_step);
      if (!std::isfinite (z))
        continue;
      double disparity = disparity_m_px / z + error_px;
      if (noise.disparity_step_px > 0.0)
        disparity = noise.disparity_step_px * std::round (disparity / noise.disparity_step_px);
      const double read = disparity_m_px / disparity;
      if (disparity > 0.0 && read >= noise.min_m && read <= noise.max_m)
        measured.pixels[pixel] = static_cast<float> (read);
    }
  }
  return measured;
}

} // namespace pcl::cosection
