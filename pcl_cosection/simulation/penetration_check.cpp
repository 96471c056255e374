// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "penetration_check.h"

#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/mesh/triangle_shape.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr double chord_m = 5e-4;
constexpr int surface_points = 2000;        // on each part, evenly
constexpr std::size_t most_vertices = 2000; // of a part
constexpr std::size_t most_edges = 300;     // of a part, the longest
constexpr double sharp_cosine = 0.85;       // between the normals at an edge
constexpr double edge_step_m = 5e-4;        // least step along one
constexpr double mesh_tolerance = 0.012;    // of the size of a mesh: a voxel of its distance
constexpr double same_pose = 1e-9;

using Segment = std::pair<Eigen::Vector3d, Eigen::Vector3d>;

struct Probe
{
  std::vector<Eigen::Vector3d> points; // body frame
  std::vector<Segment> edges;          // body frame, sharp ones
  Eigen::AlignedBox3d box;             // of both
  double tolerance_m = 0.0;            // of its own distance
};

/** \brief Points on the triangles, as many on each as its share of the area; where in it is a low-discrepancy sequence
 * (M. Roberts' R2). */
void
addSurfacePoints (const std::vector<Eigen::Vector3d>& vertices, const std::vector<TriangleMesh::Triangle>& triangles,
                  Probe& probe)
{
  const auto areaOf = [&vertices] (const TriangleMesh::Triangle& t) {
    return 0.5 * areaVector (vertices[t[0]], vertices[t[1]], vertices[t[2]]).norm ();
  };
  double area = 0.0;
  for (const TriangleMesh::Triangle& t : triangles)
    area += areaOf (t);
  if (!(area > 0.0 && std::isfinite (area)))
    return;
  double passed = 0.0;
  int point = 0;
  for (const TriangleMesh::Triangle& t : triangles)
  {
    passed += areaOf (t);
    for (; point < surface_points && (point + 0.5) * area < passed * surface_points; ++point)
    {
      double u = std::fmod (0.7548776662466927 * (point + 1), 1.0),
             v = std::fmod (0.5698402909980532 * (point + 1), 1.0);
      if (u + v > 1.0)
      {
        u = 1.0 - u;
        v = 1.0 - v;
      }
      const Eigen::Vector3d& p = vertices[t[0]];
      probe.points.push_back (p + u * (vertices[t[1]] - p) + v * (vertices[t[2]] - p));
    }
  }
}

/** \brief Edges at which the surface bends sharply, or ends. */
void
addEdges (const std::vector<Eigen::Vector3d>& vertices, const std::vector<TriangleMesh::Triangle>& triangles,
          Probe& probe)
{
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<Eigen::Vector3d>>
      normals; // of the triangles at an edge
  for (const TriangleMesh::Triangle& t : triangles)
  {
    const Eigen::Vector3d n = areaVector (vertices[t[0]], vertices[t[1]], vertices[t[2]]).stableNormalized ();
    for (int k = 0; k < 3; ++k)
      normals[std::minmax (t[k], t[(k + 1) % 3])].push_back (n);
  }
  std::vector<Segment> sharp;
  for (const auto& [edge, sides] : normals)
    if (sides.size () != 2 || sides[0].dot (sides[1]) < sharp_cosine)
      sharp.emplace_back (vertices[edge.first], vertices[edge.second]);
  std::stable_sort (sharp.begin (), sharp.end (), [] (const Segment& a, const Segment& b) {
    return (a.second - a.first).squaredNorm () > (b.second - b.first).squaredNorm ();
  });
  if (sharp.size () > most_edges)
    sharp.resize (most_edges);
  probe.edges.insert (probe.edges.end (), sharp.begin (), sharp.end ());
}

Probe
probeOf (const SceneBody& body, double tolerance_m)
{
  Probe probe;
  probe.tolerance_m = tolerance_m;
  for (const BodyPart& part : body.parts)
  {
    const TriangleMesh mesh = part.shape->tessellate (chord_m);
    std::vector<Eigen::Vector3d> vertices;
    vertices.reserve (mesh.vertices.size ());
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3f& v : mesh.vertices)
      vertices.push_back (part.T_body_part * v.cast<double> ());
    for (const TriangleMesh::Triangle& t : mesh.triangles)
      for (const std::uint32_t v : t)
        box.extend (vertices[v]);
    if (!part.shape->isAnalytic ())
      probe.tolerance_m = std::max (probe.tolerance_m, mesh_tolerance * box.sizes ().maxCoeff ());
    const std::size_t step = std::max<std::size_t> (1, vertices.size () / most_vertices);
    for (std::size_t v = 0; v < vertices.size (); v += step)
      probe.points.push_back (vertices[v]);
    addSurfacePoints (vertices, mesh.triangles, probe);
    addEdges (vertices, mesh.triangles, probe);
    probe.box.extend (box);
  }
  return probe;
}

/** \brief How deep the points of a probe lie in a body, beyond what counts as contact. */
double
depthIn (const SceneBody& body, const Probe& own, const Probe& probe, const Eigen::Isometry3d& T_body_probe)
{
  // A body that is finite holds nothing outside the box of its surface.
  Eigen::AlignedBox3d box = own.box;
  const bool finite = body.id != 0;
  double deepest = 0.0;
  if (probe.points.empty () ||
      body.distance (T_body_probe * probe.box.center ()) > 0.5 * probe.box.diagonal ().norm ()) // too far away
    return 0.0;
  const auto look = [&] (const Eigen::Vector3d& p) {
    const double distance = body.distance (p);
    if (-distance > deepest && body.isSupported (p))
      deepest = -distance;
    return std::abs (distance);
  };
  for (const Eigen::Vector3d& q : probe.points)
  {
    const Eigen::Vector3d p = T_body_probe * q;
    if (!finite || box.contains (p))
      look (p);
  }
  for (const auto& [from, to] : probe.edges)
  {
    const Eigen::Vector3d begin = T_body_probe * from, along = T_body_probe * to - begin;
    const double length = along.norm ();
    for (double at = 0.0; at < length;) // the surface is no nearer than the distance
      at += std::max (edge_step_m, look (begin + at / length * along));
  }
  return deepest > std::max (own.tolerance_m, probe.tolerance_m) ? deepest : 0.0;
}

} // namespace

std::vector<ScenePenetration>
findPenetrations (const SimulatedScene& scene, const PenetrationCheckOptions& options, const ProgressCallback& progress)
{
  std::vector<Probe> probes (scene.bodies.size ());
  parallelFor (0, static_cast<int> (probes.size ()), options.threads,
               [&] (int b) { probes[b] = probeOf (scene.bodies[b], options.tolerance_m); });
  struct Pair
  {
    std::size_t a, b;
    Eigen::Isometry3d T_ab; // of the frame before
    double depth_m = 0.0;   // then
    ScenePenetration found;
  };
  std::vector<Pair> pairs;
  for (std::size_t a = 0; a < scene.bodies.size (); ++a)
    for (std::size_t b = a + 1; b < scene.bodies.size (); ++b)
      pairs.push_back ({a, b, Eigen::Isometry3d::Identity (), 0.0, {scene.bodies[a].name, scene.bodies[b].name}});
  const int last = options.last < 0 ? scene.frames : std::min (options.last, scene.frames);
  for (int frame = options.first; frame < last; ++frame)
  {
    if (progress && !progress ("penetration", static_cast<double> (frame - options.first) / (last - options.first)))
      throw Cancelled ("cancelled");
    const double time = scene.timeOf (frame);
    parallelFor (0, static_cast<int> (pairs.size ()), options.threads, [&] (int n) {
      Pair& pair = pairs[n];
      const Eigen::Isometry3d T_ab = scene.bodies[pair.a].motion.at (time).inverse () *
                                     scene.bodies[pair.b].motion.at (time);
      if (frame == options.first || !T_ab.isApprox (pair.T_ab, same_pose))
        pair.depth_m = std::max (depthIn (scene.bodies[pair.a], probes[pair.a], probes[pair.b], T_ab),
                                 depthIn (scene.bodies[pair.b], probes[pair.b], probes[pair.a], T_ab.inverse ()));
      pair.T_ab = T_ab;
      pair.found.frames += pair.depth_m > 0.0;
      if (pair.depth_m > pair.found.depth_m)
      {
        pair.found.depth_m = pair.depth_m;
        pair.found.frame = frame;
      }
    });
  }
  std::vector<ScenePenetration> found;
  for (const Pair& pair : pairs)
    if (pair.found.frames > 0)
      found.push_back (pair.found);
  return found;
}

} // namespace pcl::cosection
