// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/triangle_mesh.h>

#include <cmath>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

namespace pcl::cosection::test {

/** \brief The box from \a lower to \a upper as 12 triangles. */
inline TriangleMesh
boxMesh (const Eigen::Vector3f& lower, const Eigen::Vector3f& upper)
{
  TriangleMesh mesh;
  for (int corner = 0; corner < 8; ++corner)
    mesh.vertices.emplace_back ((corner & 1) ? upper.x () : lower.x (), (corner & 2) ? upper.y () : lower.y (),
                                (corner & 4) ? upper.z () : lower.z ());
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

/** \brief A torus about the z axis of n x m quadrilaterals, with normals. */
inline TriangleMesh
torusMesh (double ring, double tube, std::uint32_t n, std::uint32_t m)
{
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t j = 0; j < m; ++j)
    {
      const double a = 2.0 * M_PI * i / n;
      const double b = 2.0 * M_PI * j / m;
      const Eigen::Vector3d normal (std::cos (a) * std::cos (b), std::sin (a) * std::cos (b), std::sin (b));
      const Eigen::Vector3d centre (ring * std::cos (a), ring * std::sin (a), 0.0);
      mesh.vertices.push_back ((centre + tube * normal).cast<float> ());
      mesh.normals.push_back (normal.cast<float> ());
      const auto at = [&] (std::uint32_t di, std::uint32_t dj) { return (i + di) % n * m + (j + dj) % m; };
      mesh.triangles.push_back ({at (0, 0), at (1, 0), at (1, 1)});
      mesh.triangles.push_back ({at (0, 0), at (1, 1), at (0, 1)});
    }
  return mesh;
}

/** \brief A sphere of n x 2n quadrilaterals about the origin, with normals; closed at the poles. */
inline TriangleMesh
sphereMesh (double radius, std::uint32_t n)
{
  TriangleMesh mesh;
  const auto add = [&] (double polar, double azimuth) {
    const Eigen::Vector3d d (std::sin (polar) * std::cos (azimuth), std::sin (polar) * std::sin (azimuth),
                             std::cos (polar));
    mesh.vertices.push_back ((radius * d).cast<float> ());
    mesh.normals.push_back (d.cast<float> ());
  };
  add (0.0, 0.0);
  for (std::uint32_t i = 1; i < n; ++i)
    for (std::uint32_t j = 0; j < 2 * n; ++j)
      add (M_PI * i / n, M_PI * j / n);
  add (M_PI, 0.0);
  const auto at = [n] (std::uint32_t i, std::uint32_t j) { return 1 + (i - 1) * 2 * n + j % (2 * n); };
  const std::uint32_t last = static_cast<std::uint32_t> (mesh.vertices.size ()) - 1;
  for (std::uint32_t j = 0; j < 2 * n; ++j)
  {
    mesh.triangles.push_back ({0, at (1, j), at (1, j + 1)});
    for (std::uint32_t i = 1; i + 1 < n; ++i)
    {
      mesh.triangles.push_back ({at (i, j), at (i + 1, j), at (i + 1, j + 1)});
      mesh.triangles.push_back ({at (i, j), at (i + 1, j + 1), at (i, j + 1)});
    }
    mesh.triangles.push_back ({at (n - 1, j), last, at (n - 1, j + 1)});
  }
  return mesh;
}

/** \brief The square [0, 1] x [0, 1] of n x n cells in the plane z = 0; only cells with \a inside (x, y) at their
 * centres exist. */
template <typename Inside>
TriangleMesh
sheetMesh (std::uint32_t n, Inside&& inside)
{
  TriangleMesh mesh;
  for (std::uint32_t j = 0; j <= n; ++j)
    for (std::uint32_t i = 0; i <= n; ++i)
      mesh.vertices.emplace_back (static_cast<float> (i) / n, static_cast<float> (j) / n, 0.0f);
  const auto at = [n] (std::uint32_t i, std::uint32_t j) { return j * (n + 1) + i; };
  for (std::uint32_t j = 0; j < n; ++j)
    for (std::uint32_t i = 0; i < n; ++i)
      if (inside ((i + 0.5) / n, (j + 0.5) / n))
      {
        mesh.triangles.push_back ({at (i, j), at (i + 1, j), at (i + 1, j + 1)});
        mesh.triangles.push_back ({at (i, j), at (i + 1, j + 1), at (i, j + 1)});
      }
  return mesh;
}

/** \brief A closed sheet, thin and bent like a bowl. */
inline TriangleMesh
shellMesh (double thickness)
{
  TriangleMesh mesh = sheetMesh (30, [] (double x, double y) { return std::hypot (x - 0.5, y - 0.5) < 0.5; });
  const auto count = static_cast<std::uint32_t> (mesh.vertices.size ());
  const std::vector<TriangleMesh::Triangle> top = mesh.triangles;
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const auto& t : top)
    for (int c = 0; c < 3; ++c)
      edges.insert ({t[c], t[(c + 1) % 3]});
  for (Eigen::Vector3f& v : mesh.vertices)
    v.z () = 2.0f * ((v.x () - 0.5f) * (v.x () - 0.5f) + (v.y () - 0.5f) * (v.y () - 0.5f));
  for (std::uint32_t v = 0; v < count; ++v)
    mesh.vertices.push_back (mesh.vertices[v] - static_cast<float> (thickness) * Eigen::Vector3f::UnitZ ());
  for (const auto& t : top)
    mesh.triangles.push_back ({t[0] + count, t[2] + count, t[1] + count});
  for (const auto& [a, b] : edges)
    if (edges.count ({b, a}) == 0)
    {
      mesh.triangles.push_back ({b, a, a + count});
      mesh.triangles.push_back ({b, a + count, b + count});
    }
  return mesh;
}

} // namespace pcl::cosection::test
