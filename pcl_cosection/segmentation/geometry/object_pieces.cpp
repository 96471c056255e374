// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "object_pieces.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>

namespace pcl::cosection {
namespace {

constexpr int bridge_px = 4;              ///< pixels of no piece that may lie between two that touch
constexpr int edge_share = 128;           ///< share of the image's width in which what is seen ends raggedly
constexpr float outline_margin_m = 0.02f; ///< how far beyond the seen part of a surface it still carries something
constexpr float contact_sigmas = 3.0f;    ///< height over a surface of what touches it ...
constexpr float contact_px = 1.5f;        ///< ... and the width of so many pixels
constexpr int least_run_px = 3;           ///< readings of both in a row; where they alternate there is no outline

/** \brief Sums over the places and normals of a piece. */
struct Bend
{
  int n = 0;
  double products = 0.0, squares = 0.0;
  Eigen::Vector3d place = Eigen::Vector3d::Zero (), normal = Eigen::Vector3d::Zero ();

  void add (const Eigen::Vector3f& p, const Eigen::Vector3f& direction)
  {
    ++n;
    products += p.dot (direction);
    squares += p.squaredNorm ();
    place += p.cast<double> ();
    normal += direction.cast<double> ();
  }

  void describe (Piece& piece) const
  {
    if (n == 0)
      return;
    const double turning = std::max (0.0, 1.0 - normal.squaredNorm () / n / n);
    const double spread = std::max (1e-12, squares / n - place.squaredNorm () / n / n);
    piece.turning = static_cast<float> (std::sqrt (turning));
    piece.convexity = static_cast<float> ((products / n - place.dot (normal) / n / n) /
                                          std::sqrt (spread * (turning + 1e-12)));
  }
};

/** \brief The part of the image that has readings: where the colour camera's view is wider, there is a frame without.
 */
struct SeenBox
{
  int left, top, margin, right = -1, bottom = -1;

  explicit SeenBox (const DepthGrid& grid) : left (grid.width), top (grid.height), margin (grid.width / edge_share)
  {
    for (int v = 0; v < grid.height; ++v)
      for (int u = 0; u < grid.width; ++u)
        if (grid.valid (v * grid.width + u))
        {
          left = std::min (left, u);
          right = std::max (right, u);
          top = std::min (top, v);
          bottom = v;
        }
  }

  bool isOnEdge (int u, int v) const
  {
    return (u <= left + margin || v <= top + margin || u >= right - margin || v >= bottom - margin);
  }
};

/** \brief Height of a pixel above the nearest support surface below it that carries it; negative if there is none. */
float
heightAboveSupport (const DepthGrid& grid, const std::vector<SupportSurface>& surfaces, int pixel)
{
  float height = -1.0f;
  for (const SupportSurface& surface : surfaces)
  {
    const float h = surface.height (grid.points[pixel]);
    if (h >= 0.0f && (height < 0.0f || h < height) && surface.carries (grid, pixel, outline_margin_m))
      height = h;
  }
  return (height);
}

} // namespace

std::vector<Piece>
describePieces (const DepthGrid& grid, const std::vector<SupportSurface>& surfaces, const std::vector<int>& piece_of)
{
  const std::size_t count = piece_of.empty () ? 0 : *std::max_element (piece_of.begin (), piece_of.end ()) + 1;
  std::vector<Piece> pieces (count);
  std::vector<Eigen::Vector3d> sum (count, Eigen::Vector3d::Zero ());
  std::vector<Eigen::Matrix3d> products (count, Eigen::Matrix3d::Zero ());
  std::vector<Bend> bends (count);
  const SeenBox seen (grid);
  for (int i = 0; i < static_cast<int> (piece_of.size ()); ++i)
  {
    if (piece_of[i] < 0)
      continue;
    Piece& piece = pieces[piece_of[i]];
    const Eigen::Vector3f& p = grid.points[i];
    ++piece.pixels;
    piece.area_m2 += grid.pitch * p.z () * grid.pitch * p.z ();
    sum[piece_of[i]] += p.cast<double> ();
    products[piece_of[i]] += p.cast<double> () * p.cast<double> ().transpose ();
    piece.edge_pixels += seen.isOnEdge (i % grid.width, i / grid.width);
    piece.sigma_m = std::max (piece.sigma_m, grid.sigma (i));
    if (const float height = heightAboveSupport (grid, surfaces, i); height >= 0.0f)
    {
      piece.carried += 1.0f;
      piece.lowest_m = std::min (piece.lowest_m, height);
      piece.highest_m = std::max (piece.highest_m, height);
    }
    if (grid.hasNormal (i))
      bends[piece_of[i]].add (p, grid.normals[i]);
  }
  std::vector<Eigen::Matrix3f> axes (count);
  for (std::size_t k = 0; k < count; ++k)
  {
    const double n = std::max (1, pieces[k].pixels);
    const Eigen::Vector3d mean = sum[k] / n;
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
    eigen.computeDirect (products[k] / n - mean * mean.transpose ());
    axes[k] = eigen.eigenvectors ().cast<float> ();
    pieces[k].carried /= static_cast<float> (n);
    bends[k].describe (pieces[k]);
  }
  std::vector<Eigen::AlignedBox3f> boxes (count);
  for (std::size_t i = 0; i < piece_of.size (); ++i)
    if (const int k = piece_of[i]; k >= 0)
      boxes[k].extend (axes[k].transpose () * grid.points[i]);
  for (std::size_t k = 0; k < count; ++k)
    if (pieces[k].pixels > 0)
      pieces[k].length_m = boxes[k].sizes ().maxCoeff ();
  return (pieces);
}

Borders
findBorders (const DepthGrid& grid, const std::vector<SupportSurface>& surfaces, const std::vector<int>& piece_of)
{
  Borders borders;
  forEachLine (grid, [&] (int first, int stride, int steps, int) {
    int last = -1, last_step = 0, last_other = -1;
    for (int k = 0; k < steps; ++k)
    {
      const int i = first + k * stride;
      if (piece_of[i] < 0)
      {
        last_other = grid.valid (i) ? k : last_other;
        continue;
      }
      const int bridge = last_other < last_step ? grid.shadowWidth () : bridge_px;
      if (last >= 0 && k - last_step <= std::max (bridge, bridge_px) && piece_of[i] != piece_of[last])
      {
        const bool swapped = piece_of[i] > piece_of[last];
        Border& border = borders[std::minmax (piece_of[i], piece_of[last])];
        if (k - last_step <= bridge_px && grid.continuous (i, last, k - last_step))
        {
          ++border.touching;
          border.touching_height_m += heightAboveSupport (grid, surfaces, i);
        }
        else if ((grid.points[i].z () < grid.points[last].z ()) != swapped)
          ++border.first_front;
        else
          ++border.second_front;
      }
      last = i;
      last_step = k;
    }
  });
  return (borders);
}

std::vector<PieceOutline>
outlinePieces (const DepthGrid& grid, const Room& room, const std::vector<int>& piece_of, std::size_t pieces)
{
  std::vector<PieceOutline> outlines (pieces);
  const auto meet = [&] (int i, int j) {
    if (piece_of[i] < 0 || piece_of[j] >= 0)
      return;
    PieceOutline& outline = outlines[piece_of[i]];
    const float z = grid.points[i].z ();
    const float contact_m = contact_sigmas * grid.sigma (i) + contact_px * grid.pitch * z;
    if (room.surface_of[j] < 0)
      outline.free += grid.points[j].z () - z > contact_m;
    else
    {
      const float height = room.surfaces[room.surface_of[j]].height (grid.points[i]);
      if (height > contact_m)
        ++outline.free;
      else if (std::abs (grid.points[j].z () - z) < 4.0f * contact_m)
      {
        ++outline.held;
        outline.edge += height < -0.3f * contact_m;
      }
    }
  };
  const auto sideOf = [&] (int i) { return (std::make_pair (piece_of[i], piece_of[i] < 0 ? room.surface_of[i] : -1)); };
  forEachLine (grid, [&] (int first, int stride, int steps, int) {
    int begin = -1, last = -1, length = 0, before = -1; // of the run; last of the run before, if it is long enough
    for (int k = 0; k < steps; ++k)
    {
      const int i = first + k * stride;
      if (!grid.valid (i))
        continue;
      if (last < 0 || sideOf (i) != sideOf (first + last * stride))
      {
        before = length >= least_run_px ? last : -1;
        begin = k;
        length = 0;
      }
      last = k;
      if (++length == least_run_px && before >= 0 && begin - before <= grid.shadowWidth ())
      {
        meet (first + begin * stride, first + before * stride);
        meet (first + before * stride, first + begin * stride);
      }
    }
  });
  return (outlines);
}

} // namespace pcl::cosection
