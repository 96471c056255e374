// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "object_assembly.h"

#include "object_pieces.h"

#include <set>

namespace pcl::cosection {
namespace {

constexpr int min_pixels_vga = 150;        ///< of an object in an image of 640 x 480
constexpr int edge_factor = 4;             ///< as many times more for what the image's border cuts
constexpr float above_noise_sigmas = 6.0f; ///< height of an object over its support
constexpr float standing_m = 0.015f;       ///< what comes so near to its support stands on it
constexpr float fragment_ratio = 0.1f;     ///< size of a cap or a knob relative to what it is on ...
constexpr float fragment_factor = 6.0f;    ///< ... and relative to the smallest object
constexpr float part_ratio = 0.5f;         ///< size of a part relative to what holds it
constexpr float standing_out = 0.2f;       ///< share of the outline, beside the room, at which something stands out ...
constexpr int standing_out_factor = 5;     ///< ... if it is smaller than so many of the smallest
constexpr float edge_share = 0.3f;         ///< of the outline of an edge of the room
constexpr float hollow_convexity = -0.5f;
constexpr float hollow_turning = 0.2f;
constexpr int min_border_px = 8;        ///< along which the nearer thing hides each of the two
constexpr int min_patch_px = 20;        ///< smaller patches have no reliable normal
constexpr float same_direction = 0.91f; ///< cosine between the normals of two patches: 25 degrees
constexpr float offset_sigmas = 4.0f;   ///< of one patch from the surface of the other
constexpr float share_that_continues = 0.5f;

/** \brief Whether two pieces are one surface behind something nearer: most patches of the smaller one continue a patch
 * of the other one, as a plane or a round surface does, and all that is seen on the way between the two is in front of
 * them. */
class Continuation
{
public:
  Continuation (const DepthGrid& grid, const PatchImage& patches, const std::vector<int>& piece_of_patch,
                const std::vector<Piece>& pieces, float max_gap_m)
      : grid_ (grid)
      , patches_ (patches)
      , piece_of_patch_ (piece_of_patch)
      , pieces_ (pieces)
      , max_gap_m_ (max_gap_m)
      , pixel_ (patches.patches.size (), Eigen::Vector2f::Zero ())
      , members_ (pieces.size ())
  {
    for (std::size_t i = 0; i < patches.patch_of.size (); ++i)
      if (const int patch = patches.patch_of[i]; patch >= 0)
        pixel_[patch] += Eigen::Vector2f (static_cast<float> (i % grid.width), static_cast<float> (i / grid.width)) /
                         static_cast<float> (patches.patches[patch].pixels);
    for (std::size_t k = 0; k < piece_of_patch.size (); ++k)
      members_[piece_of_patch[k]].push_back (static_cast<int> (k));
  }

  bool joins (int first, int second) const
  {
    int all = 0, continued = 0;
    const bool swap = pieces_[first].pixels > pieces_[second].pixels;
    const std::vector<int>& others = members_[swap ? first : second];
    for (const int a : members_[swap ? second : first])
    {
      if (!reliable (a))
        continue;
      all += patches_.patches[a].pixels;
      if (std::any_of (others.begin (), others.end (),
                       [&] (int b) { return reliable (b) && continues (a, b) && hiddenBetween (a, b); }))
        continued += patches_.patches[a].pixels;
    }
    return (all > 0 && static_cast<float> (continued) >= share_that_continues * static_cast<float> (all));
  }

private:
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
  const std::vector<Piece>& pieces_;
  const float max_gap_m_;
  std::vector<Eigen::Vector2f> pixel_;    ///< mean place of a patch in the image
  std::vector<std::vector<int>> members_; ///< patches of a piece
};

/** \brief The pieces while they are being joined. */
class Assembly
{
public:
  Assembly (const DepthGrid& grid, const Room& room, const PatchImage& patches, std::vector<int>& piece_of_patch)
      : grid_ (grid)
      , room_ (room)
      , patches_ (patches)
      , piece_of_patch_ (piece_of_patch)
  {
    measure ();
  }

  void joinFragments (float min_area_m2)
  {
    joinBest ([&] (int small, int large, const Border& border) {
      const float area = pieces_[small].area_m2, other = pieces_[large].area_m2;
      const bool fragment = (area < min_area_m2 && area <= other) ||
                            (area < fragment_factor * min_area_m2 && area < fragment_ratio * other);
      return (fragment ? border.touching : 0);
    });
  }

  /** \brief Handles and the like: what hangs in the air must be held by what it touches on its side. */
  void joinParts ()
  {
    joinBest ([&] (int part, int whole, const Border& border) {
      const Piece& p = pieces_[part];
      if (border.touching == 0 || p.lowest_m < standing_m || p.area_m2 > part_ratio * pieces_[whole].area_m2)
        return (0);
      const int hidden = part < whole ? border.second_front : border.first_front;
      const float held = border.touching_height_m / static_cast<float> (border.touching);
      return (hidden < border.touching && held - p.lowest_m > 0.4f * (p.highest_m - p.lowest_m) ? border.touching : 0);
    });
  }

  /** \brief The inside of a hollow thing, which bends towards the sensor, and the wall before it. Where the rim turns,
   * they meet; what only stands before it does not touch it. */
  void joinHollows ()
  {
    joinBest ([&] (int inside, int outside, const Border& border) {
      const Piece& p = pieces_[inside];
      if (p.convexity > hollow_convexity || p.turning < hollow_turning || border.touching == 0)
        return (0);
      const int before = inside < outside ? border.second_front : border.first_front;
      const bool wall = 4.0f * static_cast<float> (before + border.touching) >
                        std::sqrt (static_cast<float> (p.pixels));
      return (wall ? before + border.touching : 0);
    });
  }

  /** \brief Pieces of one surface behind something nearer. */
  void joinDivided (float max_object_size_m)
  {
    std::vector<std::vector<int>> behind (pieces_.size ()); // what a piece hides parts of
    for (const auto& [pair, border] : borders_)
    {
      if (border.first_front >= min_border_px)
        behind[pair.first].push_back (pair.second);
      if (border.second_front >= min_border_px)
        behind[pair.second].push_back (pair.first);
    }
    std::set<std::pair<int, int>> candidates;
    for (const std::vector<int>& hidden : behind)
      for (const int a : hidden)
        for (const int b : hidden)
          if (a < b)
            candidates.emplace (a, b);
    const Continuation continuation (grid_, patches_, piece_of_patch_, pieces_, 0.5f * max_object_size_m);
    DisjointSets sets (pieces_.size ());
    for (const auto& [a, b] : candidates)
      if (continuation.joins (a, b))
        sets.unite (static_cast<std::size_t> (a), static_cast<std::size_t> (b));
    join (sets);
  }

  /** \brief Keep the pieces that \a good says and that are not longer, by the number of pixels. \return how many */
  template <typename Good> int keep (float max_length_m, Good&& good)
  {
    const std::vector<PieceOutline> outlines = outlinePieces (grid_, room_, pieceImage (), pieces_.size ());
    std::vector<int> kept, number (pieces_.size (), no_object);
    for (int k = 0; k < static_cast<int> (pieces_.size ()); ++k)
      if (good (pieces_[k], outlines[k]))
      {
        // What the image's border cuts goes on, at least to where it stands.
        const float unseen_m = pieces_[k].edge_pixels > 0 ? pieces_[k].lowest_m : 0.0f;
        if (pieces_[k].length_m + unseen_m > max_length_m)
          number[k] = too_long_object;
        else
          kept.push_back (k);
      }
    std::stable_sort (kept.begin (), kept.end (),
                      [&] (int a, int b) { return (pieces_[a].pixels > pieces_[b].pixels); });
    for (int n = 0; n < static_cast<int> (kept.size ()); ++n)
      number[kept[n]] = n;
    for (int& piece : piece_of_patch_)
      piece = number[piece];
    return (static_cast<int> (kept.size ()));
  }

private:
  /** \brief One per pixel: its piece, or -1. */
  std::vector<int> pieceImage () const
  {
    std::vector<int> piece_of (patches_.patch_of.size (), -1);
    for (std::size_t i = 0; i < piece_of.size (); ++i)
      if (patches_.patch_of[i] >= 0)
        piece_of[i] = piece_of_patch_[patches_.patch_of[i]];
    return (piece_of);
  }

  void measure ()
  {
    const std::vector<int> piece_of = pieceImage ();
    pieces_ = describePieces (grid_, room_.surfaces, piece_of);
    borders_ = findBorders (grid_, room_.surfaces, piece_of);
  }

  /** \brief Join each piece with the one for which \a vote (piece, other, border) is largest, and not 0. */
  template <typename Vote> void joinBest (Vote&& vote)
  {
    std::vector<std::pair<int, int>> best (pieces_.size (), {0, -1});
    for (const auto& [pair, border] : borders_)
      for (const auto& [piece, other] : {pair, std::make_pair (pair.second, pair.first)})
        if (const int votes = vote (piece, other, border); votes > best[piece].first)
          best[piece] = {votes, other};
    DisjointSets sets (pieces_.size ());
    for (std::size_t k = 0; k < pieces_.size (); ++k)
      if (best[k].second >= 0)
        sets.unite (k, static_cast<std::size_t> (best[k].second));
    join (sets);
  }

  void join (DisjointSets& sets)
  {
    const std::vector<int> number = sets.numbers ();
    for (int& piece : piece_of_patch_)
      piece = number[piece];
    measure ();
  }

  const DepthGrid& grid_;
  const Room& room_;
  const PatchImage& patches_;
  std::vector<int>& piece_of_patch_;
  std::vector<Piece> pieces_;
  Borders borders_;
};

} // namespace

int
assembleObjects (const DepthGrid& grid, const Room& room, const PatchImage& patches,
                 const ObjectSegmentationOptions& options, std::vector<int>& piece_of_patch)
{
  const auto min_size = static_cast<float> (options.min_object_size_m);
  const auto max_size = static_cast<float> (options.max_object_size_m);
  Assembly assembly (grid, room, patches, piece_of_patch);
  assembly.joinFragments (min_size * min_size);
  assembly.joinHollows ();
  assembly.joinParts ();
  assembly.joinDivided (max_size);

  const int min_pixels = min_pixels_vga * grid.width / 640 * grid.height / 480;
  return (assembly.keep (max_size, [&] (const Piece& piece, const PieceOutline& outline) {
    const int around = outline.free + outline.held;
    const bool small = piece.pixels < standing_out_factor * min_pixels;
    return ((!small || outline.free >= standing_out * static_cast<float> (around)) &&
            outline.edge <= edge_share * static_cast<float> (around) &&
            piece.pixels >= (piece.edge_pixels > 0 ? edge_factor : 1) * min_pixels && piece.length_m >= min_size &&
            piece.carried >= 0.5f && piece.highest_m > above_noise_sigmas * piece.sigma_m && piece.lowest_m < max_size);
  }));
}

} // namespace pcl::cosection
