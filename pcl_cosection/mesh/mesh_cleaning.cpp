// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "mesh_cleaning.h"
#include "mesh_checks.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <limits>
#include <numeric>
#include <unordered_map>

namespace pcl::cosection {
namespace {

using Triangle = TriangleMesh::Triangle;

/** \brief For each vertex of a triangle the first one of the same coordinates. */
std::vector<std::uint32_t>
firstOfEqualVertices (const TriangleMesh& mesh)
{
  const auto& vertices = mesh.vertices;
  std::vector<bool> used (vertices.size (), false); // others may hold no numbers
  for (const Triangle& triangle : mesh.triangles)
    for (const auto v : triangle)
      used[v] = true;
  std::vector<std::uint32_t> order;
  for (std::uint32_t v = 0; v < vertices.size (); ++v)
    if (used[v])
      order.push_back (v);
  const auto less = [&] (std::uint32_t a, std::uint32_t b) {
    const Eigen::Vector3f& u = vertices[a];
    const Eigen::Vector3f& v = vertices[b];
    return std::lexicographical_compare (u.data (), u.data () + 3, v.data (), v.data () + 3);
  };
  std::stable_sort (order.begin (), order.end (), less);
  std::vector<std::uint32_t> first (vertices.size ());
  for (std::size_t n = 0; n < order.size (); ++n)
    first[order[n]] = (n > 0 && vertices[order[n - 1]] == vertices[order[n]] ? first[order[n - 1]] : order[n]);
  return first;
}

/** \brief The corners turned so that the smallest comes first; the orientation stays. */
Triangle
canonical (Triangle triangle)
{
  std::rotate (triangle.begin (), std::min_element (triangle.begin (), triangle.end ()), triangle.end ());
  return triangle;
}

bool
isCollinear (const TriangleMesh& mesh, const Triangle& t)
{
  const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double> ();
  return (mesh.vertices[t[1]].cast<double> () - a).cross (mesh.vertices[t[2]].cast<double> () - a).isZero (0.0);
}

/** \brief Takes triangles of collinear corners a, b, c out of a mesh, b between a and c: with the triangle
 * (a, c, d) behind their longest side they are as much as (a, b, d) and (b, c, d). */
class CollinearTriangles
{
public:
  CollinearTriangles (TriangleMesh& mesh, std::vector<bool>& keep) : mesh_ (mesh), keep_ (keep) {}

  void remove ()
  {
    std::vector<std::uint32_t> left;
    for (std::uint32_t t = 0; t < mesh_.triangles.size (); ++t)
      if (keep_[t] && isCollinear (mesh_, mesh_.triangles[t]))
        left.push_back (t);
    if (left.empty ())
      return;
    for (std::uint32_t t = 0; t < mesh_.triangles.size (); ++t)
      if (keep_[t])
        insert (t);
    for (std::size_t before = left.size () + 1; left.size () < before;)
    {
      before = left.size ();
      left.erase (std::remove_if (left.begin (), left.end (), [this] (std::uint32_t t) { return resolve (t); }),
                  left.end ());
    }
    for (const std::uint32_t t : left)
      keep_[t] = false;
  }

private:
  static constexpr std::uint32_t several = std::numeric_limits<std::uint32_t>::max ();

  static std::uint64_t directed (std::uint32_t from, std::uint32_t to) { return std::uint64_t{from} << 32 | to; }

  void insert (std::uint32_t t)
  {
    const Triangle& corners = mesh_.triangles[t];
    for (int n = 0; n < 3; ++n)
    {
      const auto inserted = triangle_of_.emplace (directed (corners[n], corners[(n + 1) % 3]), t);
      if (!inserted.second)
        inserted.first->second = several;
    }
  }

  /** \brief The corners of \a t turned so that the longest side runs from the last to the first. */
  Triangle longestSideLast (std::uint32_t t) const
  {
    Triangle corners = mesh_.triangles[t];
    const auto length = [&] (int n) {
      return (mesh_.vertices[corners[n]] - mesh_.vertices[corners[(n + 1) % 3]]).cast<double> ().squaredNorm ();
    };
    int longest = 0;
    for (int n = 1; n < 3; ++n)
      if (length (n) > length (longest))
        longest = n;
    std::rotate (corners.begin (), corners.begin () + (longest + 1) % 3, corners.end ());
    return corners;
  }

  /** \brief True if \a t is collinear no more, or gone. */
  bool resolve (std::uint32_t t)
  {
    const Triangle abc = longestSideLast (t);
    const std::uint32_t a = abc[0], b = abc[1], c = abc[2];
    if (triangle_of_.at (directed (c, a)) == several)
      return false;
    const auto behind = triangle_of_.find (directed (a, c));
    if (behind == triangle_of_.end ())
    {
      // Nothing behind: what remains of the border is the same line.
      keep_[t] = false;
      for (int n = 0; n < 3; ++n)
        if (triangle_of_.at (directed (abc[n], abc[(n + 1) % 3])) == t)
          triangle_of_.erase (directed (abc[n], abc[(n + 1) % 3]));
      return true;
    }
    const std::uint32_t other = behind->second;
    if (other == several || isCollinear (mesh_, mesh_.triangles[other]))
      return false;
    std::uint32_t d = a;
    for (const std::uint32_t corner : mesh_.triangles[other])
      if (corner != a && corner != c)
        d = corner;
    if (d == b || // the same corners, of which rounding says in this order that they are not collinear
        triangle_of_.count (directed (b, d)) != 0 || triangle_of_.count (directed (d, b)) != 0)
      return false;
    mesh_.triangles[t] = {a, b, d};
    mesh_.triangles[other] = {b, c, d};
    triangle_of_.erase (directed (a, c));
    triangle_of_.erase (directed (c, a));
    for (const auto& moved : {std::make_pair (directed (b, c), other), std::make_pair (directed (d, a), t)})
      if (triangle_of_.at (moved.first) != several)
        triangle_of_.at (moved.first) = moved.second;
    triangle_of_[directed (b, d)] = t;
    triangle_of_[directed (d, b)] = other;
    return true;
  }

  TriangleMesh& mesh_;
  std::vector<bool>& keep_;
  std::unordered_map<std::uint64_t, std::uint32_t> triangle_of_; // of each side, by its direction
};

/** \brief Calls visit (a, b) for triangles of equal key, each with the next one. */
template <typename Key, typename Visit>
void
forEachRepetition (const std::vector<Triangle>& triangles, Key&& key, Visit&& visit)
{
  std::vector<std::uint32_t> order (triangles.size ());
  std::iota (order.begin (), order.end (), 0u);
  std::stable_sort (order.begin (), order.end (),
                    [&] (std::uint32_t a, std::uint32_t b) { return key (triangles[a]) < key (triangles[b]); });
  for (std::size_t n = 1; n < order.size (); ++n)
    if (key (triangles[order[n]]) == key (triangles[order[n - 1]]))
      visit (order[n - 1], order[n]);
}

} // namespace

TriangleMesh
cleanMesh (const TriangleMesh& mesh)
{
  checkMesh (mesh);
  TriangleMesh welded;
  welded.vertices = mesh.vertices;
  welded.triangles = mesh.triangles;
  const auto first = firstOfEqualVertices (mesh);
  std::vector<bool> keep (mesh.triangles.size (), true);
  for (std::size_t t = 0; t < keep.size (); ++t)
  {
    Triangle& corners = welded.triangles[t];
    for (auto& v : corners)
      v = first[v];
    keep[t] = corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0];
  }
  forEachRepetition (welded.triangles, canonical, [&] (std::uint32_t, std::uint32_t b) { keep[b] = false; });
  CollinearTriangles (welded, keep).remove ();
  return extractTriangles (welded, keep);
}

TriangleMesh
dropBackToBack (const TriangleMesh& mesh)
{
  const auto corners = [] (Triangle triangle) {
    std::sort (triangle.begin (), triangle.end ());
    return triangle;
  };
  std::vector<bool> keep (mesh.triangles.size (), true);
  forEachRepetition (mesh.triangles, corners, [&] (std::uint32_t a, std::uint32_t b) { keep[a] = keep[b] = false; });
  return extractTriangles (mesh, keep);
}

} // namespace pcl::cosection
