// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/triangle_mesh.h>

#include <cstddef>
#include <cstdint>
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
  CollapsibleMesh (std::vector<Triangle> triangles, std::size_t vertices);

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
  bool isBoundary (Vertex u, Vertex v) const;

  /** \brief Does the mesh keep its topology when the edge \a u \a v collapses? (The link condition) */
  bool mayCollapse (Vertex u, Vertex v);

  /** \brief Let \a v become \a u; the triangles between them vanish. */
  void collapse (Vertex u, Vertex v);

  /** \brief The triangles that are left, in their original order. */
  std::vector<Triangle> triangles () const;

private:
  using Corner = std::uint32_t; ///< corner n of triangle t: 3 t + n

  static constexpr Corner none = 0xffffffffu;

  bool vanished (std::size_t triangle) const { return triangles_[triangle][0] == none; }

  void unlinkVanished (Vertex v);

  std::vector<Triangle> triangles_;       ///< first corner none: vanished
  std::vector<Corner> first_;             ///< of a vertex
  std::vector<Corner> next_;              ///< of a corner
  std::vector<std::uint8_t> mark_;        ///< of a vertex; zero between calls
  std::vector<std::uint8_t> on_boundary_; ///< of a vertex
  std::size_t triangle_count_;
};

} // namespace pcl::cosection
