// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "object_pieces.h"

#include <Eigen/Eigenvalues>

namespace pcl::cosection {
namespace {

constexpr int bridge_px = 4;              ///< pixels of no piece that may lie between two that touch
constexpr int shadow_share = 16;          ///< share of the image's width that the shadow beside a thing may have
constexpr int edge_share = 128;           ///< share of the image's width in which what is seen ends raggedly
constexpr float outline_margin_m = 0.02f; ///< how far beyond the seen part of a surface it still carries something

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

int
countPieces (const std::vector<int>& piece_of)
{
  int count = 0;
  for (const int piece : piece_of)
    count = std::max (count, piece + 1);
  return (count);
}

} // namespace

std::vector<Piece>
describePieces (const DepthGrid& grid, const std::vector<SupportSurface>& surfaces, const std::vector<int>& piece_of)
{
  const std::size_t count = static_cast<std::size_t> (countPieces (piece_of));
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
  std::vector<Eigen::Vector3f> low (count, Eigen::Vector3f::Constant (1e9f)),
      high (count, Eigen::Vector3f::Constant (-1e9f));
  for (int i = 0; i < static_cast<int> (piece_of.size ()); ++i)
    if (const int k = piece_of[i]; k >= 0)
    {
      const Eigen::Vector3f p = axes[k].transpose () * grid.points[i];
      low[k] = low[k].cwiseMin (p);
      high[k] = high[k].cwiseMax (p);
    }
  for (std::size_t k = 0; k < count; ++k)
    if (pieces[k].pixels > 0)
      pieces[k].length_m = (high[k] - low[k]).maxCoeff ();
  return (pieces);
}

Borders
findBorders (const DepthGrid& grid, const std::vector<SupportSurface>& surfaces, const std::vector<int>& piece_of)
{
  Borders borders;
  const auto follow = [&] (int first, int stride, int steps, int) {
    int last = -1, last_step = 0, last_other = -1;
    for (int k = 0; k < steps; ++k)
    {
      const int i = first + k * stride;
      if (piece_of[i] < 0)
      {
        last_other = grid.valid (i) ? k : last_other;
        continue;
      }
      const int bridge = last_other < last_step ? grid.width / shadow_share : bridge_px;
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
  };
  forEachLine (grid, follow);
  return (borders);
}

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

} // namespace pcl::cosection
