// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/triangle_mesh.h>

#include <Eigen/Geometry>

#include <cmath>
#include <vector>

/** \brief Box of the given edges, centred at the origin, without normals. */
inline pcl::cosection::TriangleMesh
makeBox (const Eigen::Vector3f& size)
{
  pcl::cosection::TriangleMesh mesh;
  for (int corner = 0; corner < 8; ++corner)
    mesh.vertices.push_back (
        0.5f * size.cwiseProduct (Eigen::Vector3f ((corner & 1) ? 1.0f : -1.0f, (corner & 2) ? 1.0f : -1.0f,
                                                   (corner & 4) ? 1.0f : -1.0f)));
  mesh.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  return (mesh);
}

/** \brief Surface of revolution about z.
 * \param[in] profile (radius, z) from the bottom to the top, metres; starts and ends on the axis
 * \param[in] segments around the axis */
inline pcl::cosection::TriangleMesh
revolve (const std::vector<Eigen::Vector2f>& profile, std::uint32_t segments = 96)
{
  pcl::cosection::TriangleMesh mesh;
  for (const Eigen::Vector2f& point : profile)
    for (std::uint32_t s = 0; s < segments; ++s)
    {
      const float angle = static_cast<float> (2.0 * M_PI * s / segments);
      mesh.vertices.emplace_back (point.x () * std::cos (angle), point.x () * std::sin (angle), point.y ());
    }
  const auto rings = static_cast<std::uint32_t> (profile.size ());
  for (std::uint32_t ring = 0; ring + 1 < rings; ++ring)
    for (std::uint32_t s = 0; s < segments; ++s)
    {
      const std::uint32_t below = ring * segments + s;
      const std::uint32_t below_next = ring * segments + (s + 1) % segments;
      mesh.triangles.push_back ({below, below_next, below_next + segments});
      mesh.triangles.push_back ({below, below_next + segments, below + segments});
    }
  return (mesh);
}

/** \brief Ball around the origin. */
inline pcl::cosection::TriangleMesh
makeBall (float radius, int rings = 48)
{
  std::vector<Eigen::Vector2f> profile;
  for (int ring = 0; ring <= rings; ++ring)
  {
    const auto angle = static_cast<float> (M_PI * ring / rings);
    profile.emplace_back (radius * std::sin (angle), -radius * std::cos (angle));
  }
  return (revolve (profile));
}
