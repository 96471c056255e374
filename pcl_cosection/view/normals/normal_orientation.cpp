// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/surface/normals.h>

#include "estimated_normals.h"
#include "normal_agreement.h"
#include "pcl_cosection/common/directions.h"
#include "pcl_cosection/common/disjoint_sets.h"

#include <pcl/cosection/common/error.h>

#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <tuple>

namespace pcl::cosection {
namespace {

constexpr int directions = 64;
constexpr float crease_cosine = 0.5f; // of normals that differ more
constexpr std::size_t judged_points = 20000;
constexpr double outermost_share = 0.005; // of the points, in each direction

/** \brief How well the normals of neighbours agree, in [-1, 1]; negative: one of them is flipped. Across a crease that
 * is asked of the first normal reflected at the plane halfway between the points, as along an arc from one to the
 * other. */
float
agreement (const Eigen::Vector3f& p, const Eigen::Vector3f& p_normal, const Eigen::Vector3f& q,
           const Eigen::Vector3f& q_normal)
{
  const float plain = p_normal.dot (q_normal);
  if (std::abs (plain) >= crease_cosine)
    return plain;
  const Eigen::Vector3f d = (q - p).normalized ();
  return crease_cosine * (p_normal - 2.0f * p_normal.dot (d) * d).dot (q_normal);
}

void
checkSizes (const std::vector<Eigen::Vector3f>& points, const std::vector<Eigen::Vector3f>& normals)
{
  if (points.size () != normals.size ())
    throw InvalidArgument ("there are " + std::to_string (normals.size ()) + " normals for " +
                           std::to_string (points.size ()) + " points");
}

struct Edge
{
  float cost;
  std::uint32_t a, b;
};

/** \brief Neighbours in a forest, in compressed rows. */
struct Forest
{
  std::vector<std::uint32_t> begin;
  std::vector<std::uint32_t> neighbours;
};

std::vector<Edge>
neighbourGraph (const std::vector<Eigen::Vector3f>& points, const std::vector<Eigen::Vector3f>& normals, int neighbours)
{
  search::KdTree<PointXYZ> tree;
  tree.setInputCloud (asCloud (points));
  std::vector<Edge> edges;
  pcl::Indices indices;
  std::vector<float> squared;
  const int k = std::min (neighbours + 1, static_cast<int> (points.size ()));
  for (std::uint32_t a = 0; a < points.size (); ++a)
  {
    if (!normals[a].allFinite ())
      continue;
    tree.nearestKSearch (static_cast<int> (a), k, indices, squared);
    for (const auto index : indices)
    {
      const auto b = static_cast<std::uint32_t> (index);
      if (b != a && normals[b].allFinite ())
        edges.push_back ({1.0f - std::abs (agreement (points[a], normals[a], points[b], normals[b])), std::min (a, b),
                          std::max (a, b)});
    }
  }
  return edges;
}

Forest
minimumSpanningForest (std::vector<Edge> edges, std::size_t size)
{
  std::sort (edges.begin (), edges.end (),
             [] (const Edge& x, const Edge& y) { return std::tie (x.cost, x.a, x.b) < std::tie (y.cost, y.a, y.b); });
  DisjointSets sets (size);
  std::vector<Edge> tree;
  for (const Edge& edge : edges)
    if (sets.find (edge.a) != sets.find (edge.b))
    {
      sets.unite (edge.a, edge.b);
      tree.push_back (edge);
    }
  Forest forest;
  forest.begin.assign (size + 1, 0);
  for (const Edge& edge : tree)
  {
    ++forest.begin[edge.a + 1];
    ++forest.begin[edge.b + 1];
  }
  for (std::size_t n = 0; n < size; ++n)
    forest.begin[n + 1] += forest.begin[n];
  forest.neighbours.resize (forest.begin.back ());
  std::vector<std::uint32_t> next (forest.begin.begin (), forest.begin.end () - 1);
  for (const Edge& edge : tree)
  {
    forest.neighbours[next[edge.a]++] = edge.b;
    forest.neighbours[next[edge.b]++] = edge.a;
  }
  return forest;
}

} // namespace

double
outwardShare (const std::vector<Eigen::Vector3f>& points, const std::vector<Eigen::Vector3f>& normals)
{
  checkSizes (points, normals);
  std::vector<std::uint32_t> usable;
  const std::size_t step = std::max<std::size_t> (1, points.size () / judged_points);
  for (std::size_t n = 0; n < points.size (); n += step)
    if (points[n].allFinite () && normals[n].allFinite ())
      usable.push_back (static_cast<std::uint32_t> (n));
  if (usable.empty ())
    return 0.5;
  const std::size_t count = std::max<std::size_t> (
      1, static_cast<std::size_t> (outermost_share * static_cast<double> (usable.size ())));
  double outward = 0.0;
  double all = 0.0;
  for (int n = 0; n < directions; ++n)
  {
    const Eigen::Vector3f d = sphereDirection (n, directions);
    std::nth_element (usable.begin (), usable.begin () + static_cast<std::ptrdiff_t> (count - 1), usable.end (),
                      [&] (std::uint32_t a, std::uint32_t b) {
                        const float along_a = d.dot (points[a]);
                        const float along_b = d.dot (points[b]);
                        return along_a != along_b ? along_a > along_b : a < b;
                      });
    double sum = 0.0;
    std::vector<std::uint32_t> outermost (usable.begin (), usable.begin () + static_cast<std::ptrdiff_t> (count));
    std::sort (outermost.begin (), outermost.end ()); // the sum must not depend on the order before
    for (const std::uint32_t p : outermost)
      sum += d.dot (normals[p]);
    outward += std::max (0.0, sum);
    all += std::abs (sum);
  }
  return all > 0.0 ? outward / all : 0.5;
}

double
contradictingShare (const std::vector<Eigen::Vector3f>& points, const std::vector<Eigen::Vector3f>& normals,
                    int neighbours)
{
  checkSizes (points, normals);
  std::size_t opposed = 0, behind = 0, before = 0;
  const std::vector<Edge> edges = neighbourGraph (points, normals, neighbours);
  for (const auto& [cost, a, b] : edges)
  {
    if (agreement (points[a], normals[a], points[b], normals[b]) >= 0.0f)
      continue;
    ++opposed;
    const Eigen::Vector3f d = points[b] - points[a];
    const bool b_behind = d.dot (normals[a]) < 0.0f;
    const bool a_behind = d.dot (normals[b]) > 0.0f;
    behind += b_behind && a_behind;
    before += !b_behind && !a_behind;
  }
  const std::size_t unexplained = opposed - std::max (behind, before);
  return 2 * unexplained < opposed || edges.empty ()
             ? 0.0
             : static_cast<double> (unexplained) / static_cast<double> (edges.size ());
}

void
orientConsistently (
    const std::vector<Eigen::Vector3f>& points, std::vector<Eigen::Vector3f>& normals,
    const std::function<double (const std::vector<Eigen::Vector3f>&, const std::vector<Eigen::Vector3f>&)>& rightShare,
    int neighbours)
{
  checkSizes (points, normals);
  if (points.size () < 2)
    return;
  const Forest forest = minimumSpanningForest (neighbourGraph (points, normals, neighbours), points.size ());
  std::vector<bool> done (points.size (), false);
  std::vector<std::uint32_t> piece;
  for (std::uint32_t start = 0; start < points.size (); ++start)
  {
    if (done[start] || !normals[start].allFinite ())
      continue;
    piece.assign (1, start);
    done[start] = true;
    for (std::size_t head = 0; head < piece.size (); ++head)
    {
      const std::uint32_t a = piece[head];
      for (std::uint32_t e = forest.begin[a]; e < forest.begin[a + 1]; ++e)
      {
        const std::uint32_t b = forest.neighbours[e];
        if (done[b])
          continue;
        done[b] = true;
        if (agreement (points[a], normals[a], points[b], normals[b]) < 0.0f)
          normals[b] = -normals[b];
        piece.push_back (b);
      }
    }
    std::vector<Eigen::Vector3f> piece_points, piece_normals;
    for (const std::uint32_t n : piece)
    {
      piece_points.push_back (points[n]);
      piece_normals.push_back (normals[n]);
    }
    if (rightShare (piece_points, piece_normals) < 0.5)
      for (const std::uint32_t n : piece)
        normals[n] = -normals[n];
  }
}

} // namespace pcl::cosection
