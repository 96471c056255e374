// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "camera_at_rest.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace pcl
{
namespace cosection
{

namespace
{

constexpr int nodes_across = 160;
constexpr int blocks_across = 16;
constexpr int blocks_of_sector = 4;      // along a side
constexpr float brightness_sigma = 4.0f; // of 256, of a smoothed picture
constexpr float most_sigmas = 3.0f;      // differences count no more
constexpr double plain_difference = 20.0; // of a block's sums of squares: that of one good edge
constexpr double plain_share = 0.5;       // of its differences' sizes: chance has both signs
constexpr float most_of_better = 1.5f;
constexpr double least_majority = 2.0;
constexpr double majority_to_stay = 1.5; // of votes for motion over those for rest, up to which a camera that rested goes on resting
constexpr int least_votes = 2;
constexpr double largest_unseen_shift_px = 3.0; // where there is nothing to be seen that tells

/** \brief Brightness without the noise of single pixels, so that it may be read between them. */
Image<float>
smoothedBrightness (const Picture& colour)
{
  Image<float> result (colour.width, colour.height);
  for (std::size_t n = 0; n < colour.pixels.size (); ++n)
  {
    const auto& rgb = colour.pixels[n];
    result.pixels[n] = 0.299f * rgb[0] + 0.587f * rgb[1] + 0.114f * rgb[2];
  }
  cv::Mat view (result.height, result.width, CV_32F, result.pixels.data ());
  cv::GaussianBlur (view, view, cv::Size (5, 5), 1.0);
  return result;
}

float
between (const Image<float>& image, double u, double v)
{
  const int i = std::min (image.width - 2, static_cast<int> (u));
  const int j = std::min (image.height - 2, static_cast<int> (v));
  const auto a = static_cast<float> (u - i);
  const auto b = static_cast<float> (v - j);
  return (1.0f - b) * ((1.0f - a) * image.at (i, j) + a * image.at (i + 1, j)) +
         b * ((1.0f - a) * image.at (i, j + 1) + a * image.at (i + 1, j + 1));
}

/** \brief What a block of the image says. */
struct Ballot
{
  double difference = 0.0; // of squares, at rest - moved
  double size = 0.0;       // sum of those differences' sizes

  /** \brief \param[in] at_rest difference of a pixel if the camera has not moved, in standard deviations
   * \param[in] moved and if it has */
  void
  compare (float at_rest, float moved)
  {
    if (std::min (std::abs (at_rest), std::abs (moved)) > most_of_better)
      return; // something else is seen there now
    const float d = std::min (most_sigmas * most_sigmas, at_rest * at_rest) - std::min (most_sigmas * most_sigmas, moved * moved);
    difference += d;
    size += std::abs (d);
  }

  bool
  isPlain () const
  {
    return std::abs (difference) > std::max (plain_difference, plain_share * size);
  }
};

} // namespace

void
CameraAtRest::begin (const FrameCloud& cloud, const Picture& colour)
{
  now_ = colour.pixels.size () == cloud.points.size () ? smoothedBrightness (colour) : Image<float> ();
  rests_ = rested_;
  moved_ = true;
}

void
CameraAtRest::keep (const FrameCloud& cloud, const Eigen::Isometry3d& T_world_camera)
{
  rested_ = rests_;
  if (!moved_)
    return;
  depth_ = cloud.depth;
  brightness_ = std::move (now_);
  T_world_camera_ = T_world_camera;
}

bool
CameraAtRest::isPreferredTo (const Eigen::Isometry3d& T_world_camera, const FrameCloud& cloud)
{
  if (depth_.pixels.empty ())
    return false;
  const bool coloured = !brightness_.pixels.empty () && !now_.pixels.empty ();
  const PinholeCamera& camera = cloud.camera;
  const Eigen::Isometry3d T_now_then = T_world_camera.inverse () * T_world_camera_;
  const int step = std::max (1, camera.width / nodes_across);
  const int block = std::max (step, camera.width / blocks_across);
  const int columns = camera.width / block + 1;
  std::vector<Ballot> ballots (static_cast<std::size_t> (columns) * (camera.height / block + 1));
  double shifts = 0.0; // pixels
  int compared = 0;
  for (int v = step / 2; v < camera.height; v += step)
    for (int u = step / 2; u < camera.width; u += step)
    {
      const float z = depth_.at (u, v);
      if (!std::isfinite (z))
        continue;
      const Eigen::Vector3d p = T_now_then * camera.unproject (u, v, z);
      if (p.z () <= 0.0)
        continue;
      const Eigen::Vector2d pixel = camera.project (p);
      if (!(pixel.x () >= 0.0 && pixel.y () >= 0.0 && pixel.x () <= camera.width - 1.0 && pixel.y () <= camera.height - 1.0))
        continue;
      shifts += (pixel - Eigen::Vector2d (u, v)).norm ();
      ++compared;
      Ballot& ballot = ballots[static_cast<std::size_t> (v / block) * columns + u / block];
      if (coloured)
      {
        const float then = brightness_.at (u, v);
        ballot.compare ((now_.at (u, v) - then) / brightness_sigma,
                        (between (now_, pixel.x (), pixel.y ()) - then) / brightness_sigma);
      }
      const float at_rest = cloud.depth.at (u, v);
      const float moved = cloud.depth.at (static_cast<int> (std::lround (pixel.x ())), static_cast<int> (std::lround (pixel.y ())));
      if (std::isfinite (at_rest) && std::isfinite (moved))
      {
        const auto sigma = static_cast<float> (std::sqrt (2.0) * depthNoiseSigma (z));
        ballot.compare ((at_rest - z) / sigma, (moved - static_cast<float> (p.z ())) / sigma);
      }
    }
  std::vector<int> sectors (static_cast<std::size_t> (columns / blocks_of_sector + 1) * (ballots.size () / columns / blocks_of_sector + 1), 0);
  for (std::size_t n = 0; n < ballots.size (); ++n)
    if (ballots[n].isPlain ())
      sectors[n / columns / blocks_of_sector * (columns / blocks_of_sector + 1) + n % columns / blocks_of_sector] +=
          ballots[n].difference < 0.0 ? 1 : -1;
  const auto rest = std::count_if (sectors.begin (), sectors.end (), [] (int votes) { return votes > 0; });
  const auto motion = std::count_if (sectors.begin (), sectors.end (), [] (int votes) { return votes < 0; });
  // It goes on as it did, unless most say otherwise.
  const double majority = rested_ ? 1.0 / majority_to_stay : least_majority;
  const bool at_rest = rest >= least_votes && static_cast<double> (rest) > majority * static_cast<double> (motion);
  const bool in_motion =
      !at_rest && motion >= least_votes && static_cast<double> (motion) > least_majority * static_cast<double> (rest);
  rests_ = at_rest || (rested_ && !in_motion);
  moved_ = in_motion || (!at_rest && shifts > largest_unseen_shift_px * compared);
  return at_rest;
}

} // namespace cosection
} // namespace pcl
