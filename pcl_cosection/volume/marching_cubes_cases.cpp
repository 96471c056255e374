// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "marching_cubes_cases.h"

#include <Eigen/Core>

#include <cassert>
#include <limits>
#include <vector>

namespace pcl::cosection::marching_cubes {
namespace {

using Loop = std::vector<int>; // edges in cyclic order

/** \brief The edge between two neighbouring corners. */
int
edgeBetween (int a, int b)
{
  const int bit = a ^ b;
  const int axis = (bit == 1 ? 0 : bit == 2 ? 1 : 2);
  const int begin = a & b;
  return 4 * axis + ((begin >> ((axis + 1) % 3)) & 1) + 2 * ((begin >> ((axis + 2) % 3)) & 1);
}

/** \brief The four corners of face (axis, side), counter-clockwise as seen from outside the cell. */
std::array<int, 4>
faceCorners (int axis, int side)
{
  const int u = 1 << ((axis + 1) % 3);
  const int v = 1 << ((axis + 2) % 3);
  const int base = side << axis;
  if (side == 1)
    return {base, base | u, base | u | v, base | v};
  return {base, base | v, base | u | v, base | u};
}

/** \brief For each cut edge, the next one along the contour; -1 for edges that are not cut. */
std::array<int, 12>
contourSuccessors (unsigned inside)
{
  std::array<int, 12> next;
  next.fill (-1);
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side)
    {
      const auto corners = faceCorners (axis, side);
      const auto is_inside = [&] (int n) { return ((inside >> corners[n % 4]) & 1u) != 0; };
      for (int n = 0; n < 4; ++n)
      {
        if (is_inside (n) || !is_inside (n + 1))
          continue;
        int last = n + 1; // the run of inside corners that begins behind corner n
        while (is_inside (last + 1))
          ++last;
        next[edgeBetween (corners[n], corners[(n + 1) % 4])] = edgeBetween (corners[last % 4], corners[(last + 1) % 4]);
      }
    }
  return next;
}

std::vector<Loop>
traceLoops (unsigned inside)
{
  const auto next = contourSuccessors (inside);
  std::array<bool, 12> visited{};
  std::vector<Loop> loops;
  for (int start = 0; start < 12; ++start)
  {
    if (next[start] < 0 || visited[start])
      continue;
    Loop loop;
    for (int e = start; !visited[e]; e = next[e])
    {
      visited[e] = true;
      loop.push_back (e);
    }
    loops.push_back (loop);
  }
  return loops;
}

Eigen::Vector3d
edgeMidpoint (int edge)
{
  const int corner = edgeBegin (edge);
  Eigen::Vector3d p (corner & 1, (corner >> 1) & 1, (corner >> 2) & 1);
  p[edge / 4] += 0.5;
  return p;
}

/** \brief Do two edges lie in one face of the cell? */
bool
shareFace (int a, int b)
{
  for (int axis = 0; axis < 3; ++axis)
    if (a / 4 != axis && b / 4 != axis && ((edgeBegin (a) >> axis) & 1) == ((edgeBegin (b) >> axis) & 1))
      return true;
  return false;
}

/** \brief Triangulation of a loop with the shortest diagonals, none of them in a face of the cell
 * (dynamic programming over sub-polygons). */
class LoopTriangulation
{
public:
  explicit LoopTriangulation (const Loop& loop)
      : loop_ (loop)
      , n_ (static_cast<int> (loop.size ()))
      , cost_ (n_ * n_, 0.0)
      , apex_ (n_ * n_, -1)
  {
    for (int length = 2; length < n_; ++length)
      for (int i = 0; i + length < n_; ++i)
        solve (i, i + length);
  }

  void append (Case& out) const
  {
    assert (cost_[n_ - 1] < std::numeric_limits<double>::infinity ()); // holds for each of the 256 cases
    append (0, n_ - 1, out);
  }

private:
  /** \brief Cost of the chord from i to j; none for the loop's own sides. */
  double chord (int i, int j) const
  {
    if (j - i == 1 || j - i == n_ - 1)
      return 0.0;
    if (shareFace (loop_[i], loop_[j]))
      return std::numeric_limits<double>::infinity ();
    return (edgeMidpoint (loop_[i]) - edgeMidpoint (loop_[j])).squaredNorm ();
  }

  void solve (int i, int j)
  {
    double best = std::numeric_limits<double>::infinity ();
    for (int k = i + 1; k < j; ++k)
    {
      const double cost = cost_[i * n_ + k] + cost_[k * n_ + j] + chord (i, k) + chord (k, j);
      if (cost < best)
      {
        best = cost;
        apex_[i * n_ + j] = k;
      }
    }
    cost_[i * n_ + j] = best;
  }

  void append (int i, int j, Case& out) const
  {
    if (j - i < 2)
      return;
    const int k = apex_[i * n_ + j];
    append (i, k, out);
    out.triangles[out.triangle_count++] = {static_cast<std::uint8_t> (loop_[i]), static_cast<std::uint8_t> (loop_[k]),
                                           static_cast<std::uint8_t> (loop_[j])};
    append (k, j, out);
  }

  Loop loop_;
  int n_;
  std::vector<double> cost_; // of the polygon i ... j
  std::vector<int> apex_;    // third corner of the triangle at its chord
};

CaseTable
buildTable ()
{
  CaseTable table{};
  for (unsigned inside = 0; inside < 256; ++inside)
    for (const Loop& loop : traceLoops (inside))
      LoopTriangulation (loop).append (table[inside]);
  return table;
}

} // namespace

const CaseTable&
caseTable ()
{
  static const CaseTable table = buildTable ();
  return table;
}

} // namespace pcl::cosection::marching_cubes
