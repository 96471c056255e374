// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "frustum_clip.h"

namespace pcl::cosection {

FrustumClip::FrustumClip (const PinholeCamera& camera, double near_m)
{
  // Pixel column u = fx x/z + cx >= -g becomes fx x + (cx + g) z >= 0; likewise at the other sides.
  const double g = guard_band_px;
  normals_ = {Eigen::Vector3d (0, 0, 1), Eigen::Vector3d (camera.fx, 0, camera.cx + g),
              Eigen::Vector3d (-camera.fx, 0, camera.width + g - camera.cx),
              Eigen::Vector3d (0, camera.fy, camera.cy + g),
              Eigen::Vector3d (0, -camera.fy, camera.height + g - camera.cy)};
  offsets_ = {near_m, 0, 0, 0, 0};
}

bool
FrustumClip::contains (const Eigen::Vector3d& p) const
{
  for (int plane = 0; plane < plane_count; ++plane)
    if (!(distance (plane, p) >= 0.0))
      return false;
  return true;
}

ClippedPolygon
FrustumClip::clip (const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) const
{
  ClippedPolygon polygon;
  polygon.corners[0] = a;
  polygon.corners[1] = b;
  polygon.corners[2] = c;
  polygon.count = 3;
  for (int plane = 0; plane < plane_count && polygon.count > 0; ++plane)
  {
    ClippedPolygon cut;
    for (int n = 0; n < polygon.count; ++n)
    {
      const Eigen::Vector3d& p = polygon.corners[n];
      const Eigen::Vector3d& q = polygon.corners[(n + 1) % polygon.count];
      const double dp = distance (plane, p);
      const double dq = distance (plane, q);
      if (dp >= 0.0 && cut.count < ClippedPolygon::max_corners)
        cut.corners[cut.count++] = p;
      if ((dp >= 0.0) != (dq >= 0.0) && cut.count < ClippedPolygon::max_corners)
      {
        // from the end inside, whichever comes first here: the neighbour goes the other way round
        const bool p_inside = dp >= 0.0;
        const Eigen::Vector3d& from = p_inside ? p : q;
        const Eigen::Vector3d& to = p_inside ? q : p;
        const double d_from = p_inside ? dp : dq;
        const double d_to = p_inside ? dq : dp;
        cut.corners[cut.count++] = from + d_from / (d_from - d_to) * (to - from);
      }
    }
    polygon = cut;
  }
  return polygon;
}

} // namespace pcl::cosection
