// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "camera_at_rest.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace pcl::cosection {
namespace {

constexpr int nodes_across = 160;
constexpr int blocks_across = 16;
constexpr int blocks_of_sector = 4;      // along a side
constexpr float brightness_sigma = 4.0f; // of 256, of a smoothed picture
constexpr float most_sigmas = 3.0f;      // differences count no more
// In a block's sums of squares, the difference that one good edge makes.
constexpr double plain_difference = 20.0;
// The right pose leaves a block's noise; a motion that is known roughly leaves less than twice as much.
constexpr double plain_ratio = 2.2;
constexpr float most_of_better = 1.5f;
// Where no block votes, the motion explains the whole image's sums so much worse.
constexpr double least_ratio_to_stay = 1.03;
// Rest may explain the image so much worse: what moves by itself is a part of it.
constexpr double most_ratio_to_rest = 1.25;
constexpr double growth_of_unexplained = 1.05; // from frame to frame, at most
constexpr std::ptrdiff_t least_sectors = 2;
constexpr std::ptrdiff_t least_to_start = 3; // for a camera that rested: a thing that passes by is in two
constexpr std::ptrdiff_t majority = 2;       // for a camera that moved
// Sectors with motion, up to which a camera that rested goes on resting.
constexpr std::ptrdiff_t majority_to_stay = 3;
constexpr std::ptrdiff_t majority_to_start = 4; // of sectors with motion, above which it moves
constexpr double largest_unseen_shift_px = 3.0; // where nothing in the image votes

/** \brief Whether a block is explained up to the noise where the sum of squares is \a smaller, and not where it is \a
 * larger. */
bool
isPlain (double smaller, double larger)
{
  return larger - smaller > plain_difference && larger > plain_ratio * smaller;
}

/** \brief The votes of a sector of the image. */
struct Sector
{
  bool rests = false;
  bool moves = false;
};

/** \brief Sums of squares of differences, in standard deviations, if the camera has not moved and if it has. */
struct Comparison
{
  double at_rest = 0.0;
  double moved = 0.0;

  void add (float rest_sigmas, float motion_sigmas)
  {
    if (std::min (std::abs (rest_sigmas), std::abs (motion_sigmas)) > most_of_better)
      return; // something else is seen there now
    at_rest += std::min (most_sigmas * most_sigmas, rest_sigmas * rest_sigmas);
    moved += std::min (most_sigmas * most_sigmas, motion_sigmas * motion_sigmas);
  }
};

/** \brief The comparison of a block of the image. */
struct Ballot
{
  Comparison brightness, depth;
  int of_background = 0; // pixels, less those that move by themselves
};

bool
areColoured (const RestReference& reference, const FrameCloud& cloud)
{
  return !reference.brightness.pixels.empty () && !cloud.brightness.empty ();
}

/** \brief Compare all blocks, row by row. \param[out] mean_shift_px of pixels, by the motion */
std::vector<Ballot>
compareBlocks (const RestReference& reference, const FrameCloud& cloud, const Eigen::Isometry3d& T_now_then,
               const MovingParts& moving, double& mean_shift_px)
{
  const PinholeCamera& camera = cloud.camera;
  const bool coloured = areColoured (reference, cloud);
  const int step = std::max (1, camera.width / nodes_across);
  const int block = std::max (step, (camera.width + blocks_across - 1) / blocks_across);
  std::vector<Ballot> ballots (static_cast<std::size_t> (blocks_across) * (camera.height / block + 1));
  double shifts = 0.0; // pixels
  int compared = 0;
  for (int v = step / 2; v < camera.height; v += step)
    for (int u = step / 2; u < camera.width; u += step)
    {
      const float z = reference.depth.at (u, v);
      if (!std::isfinite (z))
        continue;
      const Eigen::Vector3d p = T_now_then * camera.unproject (u, v, z);
      if (p.z () <= 0.0)
        continue;
      const Eigen::Vector2d pixel = camera.project (p);
      if (!isWithin (cloud.depth, pixel))
        continue;
      shifts += (pixel - Eigen::Vector2d (u, v)).norm ();
      ++compared;
      Ballot& ballot = ballots[static_cast<std::size_t> (v / block) * blocks_across + u / block];
      ballot.of_background += moving.moves (u, v) ? -1 : 1;
      if (coloured)
      {
        const float then = reference.brightness.at (u, v);
        ballot.brightness.add ((cloud.brightness[0].at (u, v) - then) / brightness_sigma,
                               (readBrightness (cloud.brightness[0], pixel).value - then) / brightness_sigma);
      }
      const float at_rest = cloud.depth.at (u, v);
      const float moved = cloud.depth.at (static_cast<int> (std::lround (pixel.x ())),
                                          static_cast<int> (std::lround (pixel.y ())));
      if (std::isfinite (at_rest) && std::isfinite (moved))
      {
        const auto sigma = static_cast<float> (std::sqrt (2.0) * depthNoiseSigma (z));
        ballot.depth.add ((at_rest - z) / sigma, (moved - static_cast<float> (p.z ())) / sigma);
      }
    }
  mean_shift_px = compared > 0 ? shifts / compared : 0.0;
  return ballots;
}

} // namespace

RestDecision
decideRest (const RestReference& reference, const Eigen::Isometry3d& T_world_camera, const FrameCloud& cloud,
            const MovingParts& moving)
{
  RestDecision decision;
  decision.rests = reference.rested;
  if (reference.depth.pixels.empty ())
    return decision;
  const bool coloured = areColoured (reference, cloud);
  double shift_px = 0.0;
  const std::vector<Ballot> ballots = compareBlocks (
      reference, cloud, T_world_camera.inverse () * reference.T_world_camera, moving, shift_px);
  constexpr int sectors_across = blocks_across / blocks_of_sector;
  std::vector<Sector> sectors (sectors_across * (ballots.size () / blocks_across / blocks_of_sector + 1));
  Comparison all;
  for (std::size_t n = 0; n < ballots.size (); ++n)
  {
    const Ballot& ballot = ballots[n];
    all.at_rest += ballot.brightness.at_rest + ballot.depth.at_rest;
    all.moved += ballot.brightness.moved + ballot.depth.moved;
    Sector&
        sector = sectors[n / blocks_across / blocks_of_sector * sectors_across + n % blocks_across / blocks_of_sector];
    const Comparison& for_rest = coloured ? ballot.brightness : ballot.depth;
    sector.rests |= isPlain (for_rest.at_rest, for_rest.moved);
    sector.moves |= ballot.of_background > 0 && isPlain (ballot.brightness.moved + ballot.depth.moved,
                                                         ballot.brightness.at_rest + ballot.depth.at_rest);
  }
  const auto rest = std::count_if (sectors.begin (), sectors.end (),
                                   [] (const Sector& sector) { return sector.rests; });
  const auto motion = std::count_if (sectors.begin (), sectors.end (),
                                     [] (const Sector& sector) { return sector.moves; });
  // Depth alone says less for rest.
  const std::ptrdiff_t to_stay = coloured ? majority_to_stay : 1, to_start = coloured ? majority_to_start : 1;
  const bool may_rest = rest >= least_sectors && all.at_rest < most_ratio_to_rest * all.moved;
  bool& at_rest = decision.at_rest;
  bool in_motion = false;
  if (reference.rested)
  {
    const bool nothing_starts = motion < least_to_start && all.moved > least_ratio_to_stay * all.at_rest;
    at_rest = nothing_starts || (may_rest && motion <= to_stay * rest);
    in_motion = !at_rest && motion >= least_to_start && motion > to_start * rest;
  }
  else
  {
    at_rest = may_rest && rest > majority * motion && all.at_rest < most_ratio_to_rest * reference.unexplained;
    in_motion = !at_rest && motion >= least_sectors && motion > majority * rest;
  }
  decision.unexplained = at_rest ? all.at_rest : all.moved;
  decision.rests = at_rest || (reference.rested && !in_motion);
  decision.moved = in_motion || (!at_rest && shift_px > largest_unseen_shift_px);
  return decision;
}

RestReference
nextReference (RestReference reference, const RestDecision& decision, const FrameCloud& cloud,
               const Eigen::Isometry3d& T_world_camera)
{
  reference.rested = decision.rests;
  reference.unexplained = reference.unexplained > 0.0
                              ? std::min (decision.unexplained, growth_of_unexplained * reference.unexplained)
                              : decision.unexplained;
  if (decision.moved)
  {
    reference.depth = cloud.depth;
    reference.brightness = cloud.brightness.empty () ? Image<float> () : cloud.brightness[0];
    reference.T_world_camera = T_world_camera;
  }
  return reference;
}

} // namespace pcl::cosection
