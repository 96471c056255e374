// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "pcl_cosection/physics/convex_hull_mesh.h"

#include "pcl_cosection/common/plane_height.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <map>
#include <memory>

extern "C"
{
#include <libqhull_r/qhull_ra.h>
}

namespace pcl::cosection {

namespace {

/** \brief Qhull's state, which is freed however a function ends. */
class Quickhull
{
public:
  explicit Quickhull (std::vector<Eigen::Vector3d> points)
      : points_ (std::move (points))
      , sink_ (fmemopen (nullptr, 4096, "w"))
  {
    if (sink_ == nullptr)
      return;
    qh_zero (&state_, sink_);
    char command[] = "qhull Qt Pp"; // triangles; no warnings
    failed_ = qh_new_qhull (&state_, 3, static_cast<int> (points_.size ()), points_.front ().data (), False, command,
                            nullptr, sink_) != 0;
  }

  Quickhull (const Quickhull&) = delete;
  Quickhull& operator= (const Quickhull&) = delete;

  ~Quickhull ()
  {
    if (sink_ == nullptr)
      return;
    int current = 0, total = 0;
    qh_freeqhull (&state_, !qh_ALL);
    qh_memfreeshort (&state_, &current, &total);
    std::fclose (sink_);
  }

  ConvexHull result ()
  {
    ConvexHull hull;
    if (failed_)
      return hull;
    qhT* const qh = &state_; // Qhull's macros want this name
    std::map<int, std::uint32_t> numbers;
    facetT* facet;
    FORALLfacets
    {
      setT* const corners = qh_facet3vertex (qh, facet);
      TriangleMesh::Triangle triangle{};
      int n = 0;
      vertexT *vertex, **vertexp;
      FOREACHvertex_ (corners)
      {
        const auto [entry, is_new] = numbers.emplace (qh_pointid (qh, vertex->point), hull.corners.size ());
        if (is_new)
          hull.corners.push_back (points_[entry->first]);
        if (n < 3)
          triangle[n++] = entry->second;
      }
      qh_settempfree (qh, const_cast<setT**> (&corners));
      if (n < 3)
        continue;
      hull.triangles.push_back (triangle);
      hull.planes.emplace_back (facet->normal[0], facet->normal[1], facet->normal[2], facet->offset);
    }
    return hull;
  }

private:
  std::vector<Eigen::Vector3d> points_;
  std::FILE* const sink_; ///< of messages
  qhT state_{};
  bool failed_ = true;
};

double
signedVolume (const ConvexHull& hull)
{
  double volume = 0.0;
  for (const auto& t : hull.triangles)
  {
    const Eigen::Vector3d& origin = hull.corners[hull.triangles[0][0]];
    const Eigen::Vector3d a = hull.corners[t[0]] - origin, b = hull.corners[t[1]] - origin;
    volume += a.dot (b.cross (hull.corners[t[2]] - origin)) / 6.0;
  }
  return volume;
}

} // namespace

TriangleMesh
ConvexHull::mesh () const
{
  TriangleMesh result;
  result.vertices.reserve (corners.size ());
  for (const Eigen::Vector3d& corner : corners)
    result.vertices.push_back (corner.cast<float> ());
  result.triangles = triangles;
  return result;
}

double
ConvexHull::depthOf (const Eigen::Vector3d& point) const
{
  double outside = -std::numeric_limits<double>::infinity ();
  for (const Eigen::Vector4d& plane : planes)
    outside = std::max (outside, heightOver (plane, point));
  return -outside;
}

ConvexHull
convexHullOf (const std::vector<Eigen::Vector3d>& points)
{
  if (points.size () < 4)
    return {};
  ConvexHull hull = Quickhull (points).result ();
  if (hull.empty ())
    return {};
  hull.volume_m3 = signedVolume (hull);
  if (hull.volume_m3 < 0.0) // the order of a facet's vertices is a setting of Qhull
  {
    hull.volume_m3 = -hull.volume_m3;
    for (TriangleMesh::Triangle& triangle : hull.triangles)
      std::swap (triangle[1], triangle[2]);
  }
  return hull;
}

bool
isSolid (const TriangleMesh& part)
{
  std::vector<Eigen::Vector3d> points;
  points.reserve (part.vertices.size ());
  for (const Eigen::Vector3f& vertex : part.vertices)
    points.push_back (vertex.cast<double> ());
  return !convexHullOf (points).empty ();
}

} // namespace pcl::cosection
