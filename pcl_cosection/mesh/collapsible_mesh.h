// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/triangle_mesh.h>

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace pcl::cosection {

/** \brief Connectivity of a manifold triangle mesh, with or without boundary, whose edges can collapse.
 *
 * The triangles around a vertex (its star) are a linked list of their corners at the vertex, in no
 * geometric order; so two stars unite without moving anything, and boundaries need no special case. */
class CollapsibleMesh
{
public:
  using Vertex = std::uint32_t;
  using Triangle = TriangleMesh::Triangle;

  /** \brief More than these cannot be numbered by 32-bit indices of their corners. */
  static constexpr std::size_t max_triangles = 0xffffffffu / 3 - 1;

  /** \brief \a triangles must form a manifold: computeTopology () counts nothing non-manifold. */
  CollapsibleMesh (std::vector<Triangle> triangles, std::size_t vertices)
      : triangles_ (std::move (triangles))
      , first_ (vertices, none)
      , next_ (3 * triangles_.size (), none)
      , mark_ (vertices, 0)
      , on_boundary_ (vertices, 0)
      , triangle_count_ (triangles_.size ())
  {
    for (std::size_t corner = 3 * triangles_.size (); corner-- > 0;)
    {
      const Vertex v = triangles_[corner / 3][corner % 3];
      next_[corner] = first_[v];
      first_[v] = static_cast<Corner> (corner);
    }
    for (Vertex v = 0; v < vertices; ++v)
      forEachEdgeAt (v, [&] (Vertex, bool boundary) { on_boundary_[v] |= static_cast<std::uint8_t> (boundary); });
  }

  std::size_t triangleCount () const { return triangle_count_; }

  /** \brief Call visit (next, previous) for each triangle at \a v: its other corners, in its direction. */
  template <typename Visit> void forEachTriangleAt (Vertex v, Visit&& visit) const
  {
    for (Corner c = first_[v]; c != none; c = next_[c])
    {
      const Triangle& triangle = triangles_[c / 3];
      visit (triangle[(c + 1) % 3], triangle[(c + 2) % 3]);
    }
  }

  /** \brief Call visit (w, boundary) for each edge from \a v to another vertex w. */
  template <typename Visit> void forEachEdgeAt (Vertex v, Visit&& visit)
  {
    forEachTriangleAt (v, [this] (Vertex p, Vertex q) {
      ++mark_[p];
      ++mark_[q];
    });
    const auto once = [&] (Vertex w) {
      if (mark_[w] == 0)
        return;
      const bool boundary = mark_[w] == 1;
      mark_[w] = 0;
      visit (w, boundary);
    };
    forEachTriangleAt (v, [&] (Vertex p, Vertex q) {
      once (p);
      once (q);
    });
  }

  /** \brief Does the edge \a u \a v belong to a single triangle? */
  bool isBoundary (Vertex u, Vertex v) const
  {
    if (!on_boundary_[u] || !on_boundary_[v])
      return false;
    int shared_triangles = 0;
    forEachTriangleAt (u, [&] (Vertex p, Vertex q) { shared_triangles += (p == v || q == v); });
    return shared_triangles == 1;
  }

  /** \brief Does the mesh keep its topology when the edge \a u \a v collapses? (The link condition) */
  bool mayCollapse (Vertex u, Vertex v)
  {
    // Lk (u) and Lk (v) may have nothing in common but Lk (uv). A boundary counts as if one more vertex
    // were connected to all of it.
    int triangles_of_u = 0;
    int triangles_of_v = 0;
    int shared_triangles = 0;
    int common_neighbours = 0;
    forEachTriangleAt (u, [&] (Vertex p, Vertex q) {
      ++triangles_of_u;
      mark_[p] = mark_[q] = 1;
    });
    const auto count = [&] (Vertex w) {
      if (mark_[w] == 1)
      {
        mark_[w] = 2;
        ++common_neighbours;
      }
    };
    forEachTriangleAt (v, [&] (Vertex p, Vertex q) {
      ++triangles_of_v;
      shared_triangles += (p == u || q == u);
      count (p);
      count (q);
    });
    forEachTriangleAt (u, [&] (Vertex p, Vertex q) { mark_[p] = mark_[q] = 0; });

    if (common_neighbours != shared_triangles)
      return false;
    if (shared_triangles == 1)
      return triangles_of_u > 1 || triangles_of_v > 1; // else all of a component
    if (on_boundary_[u] && on_boundary_[v])
      return false; // would pinch the surface
    const bool tetrahedron = triangles_of_u == 3 && triangles_of_v == 3 && !on_boundary_[u] && !on_boundary_[v];
    return !tetrahedron;
  }

  /** \brief Let \a v become \a u; the triangles between them vanish. */
  void collapse (Vertex u, Vertex v)
  {
    Vertex opposite[2] = {u, u};
    int shared = 0;
    Corner last = none;
    for (Corner c = first_[v]; c != none; c = next_[c])
    {
      Triangle& triangle = triangles_[c / 3];
      const Vertex p = triangle[(c + 1) % 3];
      const Vertex q = triangle[(c + 2) % 3];
      if (p == u || q == u)
      {
        opposite[shared++] = (p == u ? q : p);
        triangle[0] = none;
        --triangle_count_;
      }
      else
        triangle[c % 3] = u;
      last = c;
    }
    next_[last] = first_[u];
    first_[u] = first_[v];
    first_[v] = none;
    on_boundary_[u] |= on_boundary_[v];
    unlinkVanished (u);
    for (int n = 0; n < shared; ++n)
      unlinkVanished (opposite[n]);
  }

  /** \brief The triangles that are left, in their original order. */
  std::vector<Triangle> triangles () const
  {
    std::vector<Triangle> left;
    left.reserve (triangle_count_);
    for (std::size_t t = 0; t < triangles_.size (); ++t)
      if (!vanished (t))
        left.push_back (triangles_[t]);
    return left;
  }

private:
  using Corner = std::uint32_t; ///< corner n of triangle t: 3 t + n

  static constexpr Corner none = 0xffffffffu;

  bool vanished (std::size_t triangle) const { return triangles_[triangle][0] == none; }

  void unlinkVanished (Vertex v)
  {
    Corner* link = &first_[v];
    while (*link != none)
      if (vanished (*link / 3))
        *link = next_[*link];
      else
        link = &next_[*link];
  }

  std::vector<Triangle> triangles_;       ///< first corner none: vanished
  std::vector<Corner> first_;             ///< of a vertex
  std::vector<Corner> next_;              ///< of a corner
  std::vector<std::uint8_t> mark_;        ///< of a vertex; zero between calls
  std::vector<std::uint8_t> on_boundary_; ///< of a vertex
  std::size_t triangle_count_;
};

} // namespace pcl::cosection
