// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include <pcl/cosection/simulation/penetration_check.h>

#include <pcl/cosection/common/parallel.h>

#include <algorithm>
#include <cmath>

namespace pcl
{
namespace cosection
{

namespace
{

constexpr double chord_m = 5e-4;
constexpr std::size_t least_points = 2000; // on a part's surface, where it is larger than its vertices are dense
constexpr std::size_t most_vertices = 2000; // of a part
constexpr double mesh_tolerance = 0.012;   // of the size of a mesh: a voxel of its distance
constexpr double same_pose = 1e-9;

struct Probe
{
  std::vector<Eigen::Vector3d> points; // body frame
  Eigen::AlignedBox3d box;             // of the points
  double tolerance_m = 0.0;            // of its own distance
};

/** \brief Points of a body's surface: vertices, and points in its triangles as evenly as they are large. */
Probe
probeOf (const SceneBody& body, double tolerance_m)
{
  Probe probe;
  probe.tolerance_m = tolerance_m;
  for (const BodyPart& part : body.parts)
  {
    const TriangleMesh mesh = part.shape->tessellate (chord_m);
    const auto at = [&] (std::uint32_t v) -> Eigen::Vector3d { return part.T_body_part * mesh.vertices[v].cast<double> (); };
    Eigen::AlignedBox3d box;
    double area = 0.0;
    for (const auto& [a, b, c] : mesh.triangles)
    {
      area += 0.5 * (at (b) - at (a)).cross (at (c) - at (a)).norm ();
      for (const std::uint32_t v : {a, b, c})
        box.extend (at (v));
    }
    if (!part.shape->isAnalytic ())
      probe.tolerance_m = std::max (probe.tolerance_m, mesh_tolerance * box.sizes ().maxCoeff ());
    const std::size_t step = std::max<std::size_t> (1, mesh.vertices.size () / most_vertices);
    for (std::size_t v = 0; v < mesh.vertices.size (); v += step)
      probe.points.push_back (at (static_cast<std::uint32_t> (v)));
    const double spacing = std::sqrt (area / least_points);
    for (const auto& [a, b, c] : mesh.triangles)
    {
      const Eigen::Vector3d p = at (a), u = at (b) - p, v = at (c) - p;
      const auto steps = std::min (1000, static_cast<int> (std::max (u.norm (), v.norm ()) / spacing));
      for (int i = 0; i <= steps; ++i)
        for (int j = 0; i + j <= steps && steps > 1; ++j)
          probe.points.push_back (p + (i + 1.0 / 3.0) / (steps + 1) * u + (j + 1.0 / 3.0) / (steps + 1) * v);
    }
  }
  for (const Eigen::Vector3d& p : probe.points)
    probe.box.extend (p);
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
  if (!probe.points.empty () && body.distance (T_body_probe * probe.box.center ()) > 0.5 * probe.box.diagonal ().norm ())
    return 0.0; // too far away
  for (const Eigen::Vector3d& q : probe.points)
  {
    const Eigen::Vector3d p = T_body_probe * q;
    if (finite && !box.contains (p))
      continue;
    const double depth = -body.distance (p);
    if (depth > deepest && body.isSupported (p))
      deepest = depth;
  }
  return deepest > std::max (own.tolerance_m, probe.tolerance_m) ? deepest : 0.0;
}

} // namespace

std::vector<ScenePenetration>
findPenetrations (const SimulatedScene& scene, double tolerance_m, int threads)
{
  std::vector<Probe> probes (scene.bodies.size ());
  parallelFor (0, static_cast<int> (probes.size ()), threads,
               [&] (int b) { probes[b] = probeOf (scene.bodies[b], tolerance_m); });
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t a = 0; a < scene.bodies.size (); ++a)
    for (std::size_t b = a + 1; b < scene.bodies.size (); ++b)
      pairs.emplace_back (a, b);
  std::vector<ScenePenetration> found (pairs.size ());
  parallelFor (0, static_cast<int> (pairs.size ()), threads, [&] (int n) {
    const auto [a, b] = pairs[n];
    ScenePenetration& result = found[n];
    result.first = scene.bodies[a].name;
    result.second = scene.bodies[b].name;
    Eigen::Isometry3d before = Eigen::Isometry3d::Identity ();
    double depth = 0.0;
    for (int frame = 0; frame < scene.frames; ++frame)
    {
      const double time = scene.timeOf (frame);
      const Eigen::Isometry3d T_ab = scene.bodies[a].motion.at (time).inverse () * scene.bodies[b].motion.at (time);
      if (frame == 0 || !T_ab.isApprox (before, same_pose))
        depth = std::max (depthIn (scene.bodies[a], probes[a], probes[b], T_ab),
                          depthIn (scene.bodies[b], probes[b], probes[a], T_ab.inverse ()));
      before = T_ab;
      result.frames += depth > 0.0;
      if (depth > result.depth_m)
      {
        result.depth_m = depth;
        result.frame = frame;
      }
    }
  });
  found.erase (std::remove_if (found.begin (), found.end (), [] (const ScenePenetration& p) { return p.frames == 0; }),
               found.end ());
  return found;
}

} // namespace cosection
} // namespace pcl
