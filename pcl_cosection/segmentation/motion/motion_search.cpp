// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "motion_search.h"

#include "body_alignment.h"
#include "moving_patches.h"
#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/segmentation/geometry/surface_patches.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>

namespace pcl::cosection {
namespace {

constexpr double standard_pixels = 640.0 * 480.0;
constexpr int most_bodies = 16;
constexpr float most_sigmas = 3.0f; // a difference that is larger says no more than one of this size
constexpr float most_cost = 0.5f * most_sigmas * most_sigmas;
constexpr float least_new_share = 0.2f; // of a patch's pixels
constexpr int rings = 3; // of patches around those that begin a hypothesis, where their piece does not move as a whole
constexpr float else_cost = 1.5f; // of having moved otherwise, about 1.7 standard deviations
constexpr float near_m = 0.1f;    // parts of one body, which something in front divides
constexpr std::size_t points_of_part = 500;
constexpr int rounds = 2;               // of alignment and votes
constexpr double least_explained = 0.4; // of what is new in it, for a hypothesis to be right

class MotionSearch
{
public:
  MotionSearch (const MotionView& now, const std::vector<const MotionView*>& earlier,
                const MotionSegmentationOptions& options)
      : now_ (now)
      , options_ (options)
      , found_ (now.bodies)
  {
    const double share = static_cast<double> (now.points.size ()) / standard_pixels;
    min_pixels_ = std::max (1, static_cast<int> (std::lround (options.min_pixels * share)));
    for (const MotionView* view : earlier)
      lookAt (*view);
  }

  std::vector<std::uint32_t> run (std::uint32_t& next)
  {
    dividePatches ();
    std::vector<int> new_pixels = newPixels ();
    if (std::none_of (new_pixels.begin (), new_pixels.end (), [this] (int count) { return count >= min_pixels_; }))
      return found_;
    for (const auto& [body, T] : now_.T_world_body)
      for (const int i : pixelsMoving (motionOf (body), body))
        found_[i] = body;
    std::vector<char> tried (pieces_, 0);
    for (int n = 0; n < most_bodies; ++n)
    {
      new_pixels = newPixels ();
      int piece = -1;
      for (int k = 0; k < pieces_; ++k)
        if (!tried[k] && new_pixels[k] >= min_pixels_ && (piece < 0 || new_pixels[k] > new_pixels[piece]))
          piece = k;
      if (piece < 0)
        break;
      if (!tryBody (pixelsOf (piece, false), next) && !tryBody (pixelsOf (piece, true), next))
        tried[piece] = 1;
    }
    std::vector<char> left (found_.size ()); // what moves and belongs to no body
    for (int i = 0; i < static_cast<int> (left.size ()); ++i)
      left[i] = found_[i] == 0 && isNew (i);
    const std::vector<int> parts = connectedParts (now_.grid (), left, min_pixels_);
    for (std::size_t i = 0; i < parts.size (); ++i)
      if (parts[i] > 0)
        found_[i] = MotionSegments::unexplained;
    return found_;
  }

private:
  /** \brief An earlier view, and what it says if nothing moved. */
  struct Earlier
  {
    const MotionView* view;
    std::vector<Sighting> at_rest; ///< of the pixels now
    float scale;                   ///< of the noise
    std::vector<char> gone;        ///< its pixels that are seen through now
    std::vector<int> gone_pixels;
  };

  /** \brief A motion: one per earlier view; nothing where it is not known. */
  using Motion = std::vector<std::optional<Eigen::Isometry3d>>;

  void lookAt (const MotionView& view)
  {
    Earlier earlier;
    earlier.view = &view;
    const Eigen::Isometry3d T_then_now = view.T_world_sensor.inverse () * now_.T_world_sensor; // of what is at rest
    earlier.at_rest = compareViews (now_, view, T_then_now, options_.threads);
    earlier.scale = noiseScale (now_, earlier.at_rest);
    const std::vector<Sighting> now = compareViews (view, now_, T_then_now.inverse (), options_.threads);
    earlier.gone.resize (view.points.size ());
    for (std::size_t j = 0; j < earlier.gone.size (); ++j)
    {
      earlier.gone[j] = now[j].pixel >= 0 && view.hasNormal (static_cast<int> (j)) &&
                        now[j].ahead_m > options_.significance * earlier.scale * differenceSigma (view.points[j].z ());
      if (earlier.gone[j])
        earlier.gone_pixels.push_back (static_cast<int> (j));
    }
    earlier_.push_back (std::move (earlier));
  }

  void dividePatches ()
  {
    const DepthGrid grid = now_.grid ();
    std::vector<char> used (now_.points.size (), 0);
    for (int i = 0; i < static_cast<int> (used.size ()); ++i)
      used[i] = grid.valid (i) && (!now_.room[i] || now_.bodies[i] != 0 || isNew (i));
    patches_ = computeSurfacePatches (grid, used, options_.threads);
    borders_ = convexityEvidence (grid, patches_, static_cast<float> (options_.concave_angle_rad));
    piece_of_ = contractEdges (patches_.patches.size (), borders_);
    pieces_ = piece_of_.empty () ? 0 : 1 + *std::max_element (piece_of_.begin (), piece_of_.end ());
  }

  /** \brief In standard deviations; positive, where it was seen through. */
  float ahead (const Earlier& earlier, const Sighting& sighting, int pixel) const
  {
    return sighting.ahead_m / (earlier.scale * differenceSigma (now_.points[pixel].z ()));
  }

  /** \brief Whether a pixel is plainly where an earlier view has seen through. */
  bool isNew (const Earlier& earlier, int pixel) const
  {
    return earlier.at_rest[pixel].pixel >= 0 && now_.hasNormal (pixel) &&
           ahead (earlier, earlier.at_rest[pixel], pixel) > options_.significance;
  }

  bool isNew (int pixel) const
  {
    return std::any_of (earlier_.begin (), earlier_.end (),
                        [&] (const Earlier& earlier) { return isNew (earlier, pixel); });
  }

  /** \brief What a pixel says for the motion, and against rest: from -1 to 1. */
  float vote (int pixel, const Motion& motion) const
  {
    const auto costOf = [] (float sigmas) { return std::min (most_cost, 0.5f * sigmas * sigmas); };
    float sum = 0.0f;
    for (std::size_t k = 0; k < earlier_.size (); ++k)
    {
      const Earlier& earlier = earlier_[k];
      if (!motion[k] || earlier.at_rest[pixel].pixel < 0)
        continue;
      const Sighting moved = sightAt (*earlier.view, (*motion[k] * now_.points[pixel].cast<double> ()).cast<float> ());
      if (moved.pixel < 0)
        continue;
      const float resting = ahead (earlier, earlier.at_rest[pixel], pixel);
      const float moving = ahead (earlier, moved, pixel);
      if (moving < -most_sigmas) // hidden
        continue;
      if (resting < -most_sigmas) // where it would have been seen if it moved, something was that is not there any more
        sum += (earlier.gone[moved.pixel] ? else_cost : 0.0f) - costOf (moving);
      else
        sum += std::min (else_cost, costOf (resting)) - costOf (moving);
    }
    return std::max (-1.0f, std::min (1.0f, sum / else_cost));
  }

  /** \brief Where the pixels were. */
  Motion follow (const std::vector<int>& pixels) const
  {
    Motion motion;
    Eigen::Isometry3d W = Eigen::Isometry3d::Identity (); // world: where it was in the view before this one
    for (const Earlier& earlier : earlier_)
    {
      const Eigen::Isometry3d T_then_world = earlier.view->T_world_sensor.inverse ();
      const std::vector<Eigen::Isometry3d> guesses{T_then_world * W * W * now_.T_world_sensor,
                                                   T_then_world * W * now_.T_world_sensor};
      const Eigen::Isometry3d T_then_now = alignBody ({now_, pixels, *earlier.view, earlier.gone_pixels}, guesses);
      motion.emplace_back (T_then_now);
      W = earlier.view->T_world_sensor * T_then_now * now_.T_world_sensor.inverse ();
    }
    return motion;
  }

  /** \brief The motion of a body that is known now. */
  Motion motionOf (std::uint32_t body) const
  {
    Motion motion (earlier_.size ());
    for (std::size_t k = 0; k < earlier_.size (); ++k)
    {
      const MotionView& view = *earlier_[k].view;
      if (const auto then = view.T_world_body.find (body); then != view.T_world_body.end ())
        motion[k] = view.T_world_sensor.inverse () * then->second * now_.T_world_body.at (body).inverse () *
                    now_.T_world_sensor;
    }
    return motion;
  }

  /** \brief Those that move so, without parts that show it nowhere. \param[in] body known, or 0 */
  std::vector<int> pixelsMoving (const Motion& motion, std::uint32_t body) const
  {
    std::vector<float> votes (now_.points.size (), 0.0f);
    parallelFor (0, static_cast<int> (votes.size ()), options_.threads, [&] (int i) {
      if (patches_.patch_of[i] < 0)
        return;
      if (found_[i] != 0)
        votes[i] = found_[i] == body ? 1.0f : -1.0f;
      else
        votes[i] = vote (i, motion);
    });
    const std::vector<char> moving = movingPatches (patches_, votes, borders_);
    std::vector<char> pixels (now_.points.size (), 0);
    for (std::size_t i = 0; i < pixels.size (); ++i)
      pixels[i] = patches_.patch_of[i] >= 0 && moving[patches_.patch_of[i]] && (found_[i] == 0 || found_[i] == body);
    return oneBody (connectedParts (now_.grid (), pixels, min_pixels_), body);
  }

  /** \brief The numbered part that shows most, and those near it that show something. */
  std::vector<int> oneBody (const std::vector<int>& parts, std::uint32_t body) const
  {
    const int count = parts.empty () ? 0 : *std::max_element (parts.begin (), parts.end ());
    std::vector<int> shown (count + 1, 0);
    std::vector<std::vector<Eigen::Vector3f>> points (count + 1);
    for (int i = 0; i < static_cast<int> (parts.size ()); ++i)
      if (parts[i] > 0)
      {
        shown[parts[i]] += (body != 0 && found_[i] == body) || isNew (i);
        points[parts[i]].push_back (now_.points[i]);
      }
    const auto main = static_cast<int> (std::max_element (shown.begin (), shown.end ()) - shown.begin ());
    const auto isNear = [&] (int part) {
      const std::size_t step = 1 + points[part].size () / points_of_part,
                        main_step = 1 + points[main].size () / points_of_part;
      for (std::size_t n = 0; n < points[part].size (); n += step)
        for (std::size_t m = 0; m < points[main].size (); m += main_step)
          if ((points[part][n] - points[main][m]).squaredNorm () < near_m * near_m)
            return true;
      return false;
    };
    std::vector<char> belongs (count + 1, 0);
    for (int part = 1; part <= count; ++part)
      belongs[part] = part == main || (shown[part] >= min_pixels_ / 4 && isNear (part));
    std::vector<int> pixels;
    for (int i = 0; i < static_cast<int> (parts.size ()); ++i)
      if (belongs[parts[i]])
        pixels.push_back (i);
    return pixels;
  }

  /** \brief Unexplained pixels of patches that are new in the earlier view in which most are; by piece. */
  std::vector<int> newPixels () const
  {
    std::vector<int> most (pieces_, 0);
    for (const Earlier& earlier : earlier_)
    {
      std::vector<int> count (pieces_, 0);
      for (int i = 0; i < static_cast<int> (found_.size ()); ++i)
        if (found_[i] == 0 && patches_.patch_of[i] >= 0 && isNew (earlier, i))
          ++count[piece_of_[patches_.patch_of[i]]];
      for (int piece = 0; piece < pieces_; ++piece)
        most[piece] = std::max (most[piece], count[piece]);
    }
    return most;
  }

  /** \brief Those of a piece that belong to no body yet. \param[in] beside_new only those on and around patches that
   * are new */
  std::vector<int> pixelsOf (int piece, bool beside_new) const
  {
    std::vector<char> taken (patches_.patches.size (), !beside_new);
    if (beside_new)
    {
      std::vector<int> count (patches_.patches.size (), 0);
      for (int i = 0; i < static_cast<int> (found_.size ()); ++i)
        if (patches_.patch_of[i] >= 0)
          count[patches_.patch_of[i]] += isNew (i);
      for (std::size_t k = 0; k < taken.size (); ++k)
        taken[k] = count[k] > least_new_share * patches_.patches[k].pixels;
      for (int ring = 0; ring < rings; ++ring)
      {
        const std::vector<char> inner = taken;
        for (const auto& [pair, evidence] : borders_)
          if (evidence > 0.0f && (inner[pair.first] || inner[pair.second]))
            taken[pair.first] = taken[pair.second] = 1;
      }
    }
    std::vector<int> pixels;
    for (int i = 0; i < static_cast<int> (found_.size ()); ++i)
    {
      const int patch = patches_.patch_of[i];
      if (patch >= 0 && found_[i] == 0 && taken[patch] && piece_of_[patch] == piece)
        pixels.push_back (i);
    }
    return pixels;
  }

  /** \brief Try whether pixels move as a whole, and give them a number if they do. */
  bool tryBody (std::vector<int> pixels, std::uint32_t& next)
  {
    Motion motion;
    for (int round = 0; round < rounds; ++round)
    {
      motion = follow (pixels);
      pixels = pixelsMoving (motion, 0);
      if (static_cast<int> (pixels.size ()) < min_pixels_)
        return false;
    }
    int most_new = 0, most_explained = 0; // in the earlier view in which most are
    for (std::size_t k = 0; k < earlier_.size (); ++k)
    {
      int count = 0, explained = 0;
      for (const int i : pixels)
        if (isNew (earlier_[k], i))
        {
          const Sighting moved = sightAt (*earlier_[k].view,
                                          (*motion[k] * now_.points[i].cast<double> ()).cast<float> ());
          ++count;
          explained += moved.pixel >= 0 && std::abs (ahead (earlier_[k], moved, i)) < options_.significance;
        }
      most_new = std::max (most_new, count);
      most_explained = std::max (most_explained, explained);
    }
    if (most_explained < min_pixels_ || most_explained < least_explained * most_new)
      return false;
    const std::uint32_t before = numberBefore (pixels, motion), number = before == 0 ? next++ : before;
    for (const int i : pixels)
      found_[i] = number;
    return true;
  }

  /** \brief The number that most of the pixels had in the youngest view for which bodies were searched. */
  std::uint32_t numberBefore (const std::vector<int>& pixels, const Motion& motion) const
  {
    const auto last = std::find_if (earlier_.begin (), earlier_.end (),
                                    [] (const Earlier& earlier) { return !earlier.view->found.empty (); });
    if (last == earlier_.end ())
      return 0;
    const MotionView& view = *last->view;
    const Eigen::Isometry3d& T_then_now = *motion[last - earlier_.begin ()];
    std::map<std::uint32_t, int> counts;
    for (const int i : pixels)
      if (const Sighting moved = sightAt (view, (T_then_now * now_.points[i].cast<double> ()).cast<float> ());
          moved.pixel >= 0 && view.found[moved.pixel] != MotionSegments::unexplained)
        ++counts[view.found[moved.pixel]];
    counts.erase (0);
    for (const auto& [number, count] : counts)
      if (2 * count > static_cast<int> (pixels.size ()) &&
          std::find (found_.begin (), found_.end (), number) == found_.end ())
        return number;
    return 0;
  }

  const MotionView& now_;
  const MotionSegmentationOptions& options_;
  int min_pixels_;
  std::vector<Earlier> earlier_;
  PatchImage patches_;
  PatchEvidence borders_;
  std::vector<int> piece_of_; ///< by patch
  int pieces_ = 0;
  std::vector<std::uint32_t> found_;
};

} // namespace

std::vector<std::uint32_t>
findMovingBodies (const MotionView& now, const std::vector<const MotionView*>& earlier,
                  const MotionSegmentationOptions& options, std::uint32_t& next)
{
  return MotionSearch (now, earlier, options).run (next);
}

} // namespace pcl::cosection
