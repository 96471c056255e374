// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "divided_pieces.h"

#include <set>

namespace pcl::cosection {
namespace {

constexpr int min_border_px = 8;        ///< along which the nearer thing hides each of the two
constexpr int min_patch_px = 20;        ///< smaller patches have no reliable normal
constexpr float same_direction = 0.91f; ///< cosine between the normals of two patches: 25 degrees
constexpr float offset_sigmas = 4.0f;   ///< of one patch from the surface of the other
constexpr float share_that_continues = 0.5f;

class Continuation
{
public:
  Continuation (const DepthGrid& grid, const PatchImage& patches, const std::vector<int>& piece_of_patch,
                float max_gap_m)
      : grid_ (grid)
      , patches_ (patches)
      , piece_of_patch_ (piece_of_patch)
      , max_gap_m_ (max_gap_m)
      , pixel_ (patches.patches.size ())
  {
    for (auto& pixel : pixel_)
      pixel.setZero ();
    for (std::size_t i = 0; i < patches.patch_of.size (); ++i)
      if (const int patch = patches.patch_of[i]; patch >= 0)
        pixel_[patch] += Eigen::Vector2f (static_cast<float> (i % grid.width), static_cast<float> (i / grid.width)) /
                         static_cast<float> (patches.patches[patch].pixels);
    for (std::size_t k = 0; k < piece_of_patch.size (); ++k)
    {
      if (piece_of_patch[k] >= static_cast<int> (members_.size ()))
        members_.resize (piece_of_patch[k] + 1);
      members_[piece_of_patch[k]].push_back (static_cast<int> (k));
    }
  }

  /** \brief Whether two pieces are parts of one surface. */
  bool joins (int first, int second) const
  {
    int all = 0, continued = 0;
    const bool swap = pixels (first) > pixels (second);
    for (const int a : members_[swap ? second : first])
    {
      if (!reliable (a))
        continue;
      all += patches_.patches[a].pixels;
      for (const int b : members_[swap ? first : second])
        if (reliable (b) && continues (a, b) && hiddenBetween (a, b))
        {
          continued += patches_.patches[a].pixels;
          break;
        }
    }
    return (all > 0 && static_cast<float> (continued) >= share_that_continues * static_cast<float> (all));
  }

private:
  int pixels (int piece) const
  {
    int sum = 0;
    for (const int k : members_[piece])
      sum += patches_.patches[k].pixels;
    return (sum);
  }

  bool reliable (int k) const
  {
    return (patches_.patches[k].pixels >= min_patch_px && patches_.patches[k].normal.squaredNorm () > 0.0f);
  }

  /** \brief On a plane and on a circle the chord is at right angles to the mean normal. */
  bool continues (int i, int j) const
  {
    const SurfacePatch& a = patches_.patches[i];
    const SurfacePatch& b = patches_.patches[j];
    const Eigen::Vector3f chord = b.centre - a.centre;
    if (a.normal.dot (b.normal) < same_direction || chord.squaredNorm () > max_gap_m_ * max_gap_m_)
      return (false);
    const auto sigma = static_cast<float> (depthNoiseSigma (std::max (a.centre.z (), b.centre.z ())));
    return (std::abs ((a.normal + b.normal).normalized ().dot (chord)) < offset_sigmas * sigma);
  }

  /** \brief Whether all that is seen on the way is nearer than the surface, or a part of the two pieces. */
  bool hiddenBetween (int i, int j) const
  {
    const float z_i = patches_.patches[i].centre.z (), z_j = patches_.patches[j].centre.z ();
    const int steps = static_cast<int> ((pixel_[j] - pixel_[i]).cwiseAbs ().maxCoeff ()) + 1;
    int hidden = 0;
    for (int k = 0; k <= steps; ++k)
    {
      const float t = static_cast<float> (k) / static_cast<float> (steps);
      const Eigen::Vector2f at = pixel_[i] + t * (pixel_[j] - pixel_[i]);
      const int pixel = static_cast<int> (at.y () + 0.5f) * grid_.width + static_cast<int> (at.x () + 0.5f);
      if (!grid_.valid (pixel))
        continue;
      const int patch = patches_.patch_of[pixel];
      const int piece = patch < 0 ? -1 : piece_of_patch_[patch];
      if (piece >= 0 && (piece == piece_of_patch_[i] || piece == piece_of_patch_[j]))
        continue;
      const float z = 1.0f / ((1.0f - t) / z_i + t / z_j);
      if (grid_.points[pixel].z () > z - offset_sigmas * grid_.sigma (pixel))
        return (false);
      ++hidden;
    }
    return (hidden > 0);
  }

  const DepthGrid& grid_;
  const PatchImage& patches_;
  const std::vector<int>& piece_of_patch_;
  const float max_gap_m_;
  std::vector<Eigen::Vector2f> pixel_;    ///< mean place of a patch in the image
  std::vector<std::vector<int>> members_; ///< patches of a piece
};

} // namespace

std::vector<std::pair<int, int>>
findDividedPieces (const DepthGrid& grid, const PatchImage& patches, const std::vector<int>& piece_of_patch,
                   const Borders& borders, float max_object_size_m)
{
  std::map<int, std::vector<int>> behind; // what a piece hides parts of
  for (const auto& [pair, border] : borders)
  {
    if (border.first_front >= min_border_px)
      behind[pair.first].push_back (pair.second);
    if (border.second_front >= min_border_px)
      behind[pair.second].push_back (pair.first);
  }
  std::set<std::pair<int, int>> candidates;
  for (const auto& [front, hidden] : behind)
    for (const int a : hidden)
      for (const int b : hidden)
        if (a < b)
          candidates.emplace (a, b);

  const Continuation continuation (grid, patches, piece_of_patch, 0.5f * max_object_size_m);
  std::vector<std::pair<int, int>> divided;
  for (const auto& [a, b] : candidates)
    if (continuation.joins (a, b))
      divided.emplace_back (a, b);
  return (divided);
}

} // namespace pcl::cosection
