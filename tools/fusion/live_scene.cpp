// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "live_scene.h"

#include <pcl/cosection/io/mesh_io.h>
#include <pcl/cosection/io/trajectory.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>

namespace fs = std::filesystem;
using namespace pcl::cosection;

namespace {

constexpr int columns = 64;           ///< of the background's mesh
constexpr double deepest_jump = 0.06; ///< between neighbours on one surface, of their depth
constexpr TriangleMesh::Colour no_colour = {200, 200, 200};
constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max ();

void
addNormals (TriangleMesh& mesh)
{
  mesh.normals.assign (mesh.vertices.size (), Eigen::Vector3f::Zero ());
  for (const TriangleMesh::Triangle& t : mesh.triangles)
  {
    const Eigen::Vector3f normal = (mesh.vertices[t[1]] - mesh.vertices[t[0]])
                                       .cross (mesh.vertices[t[2]] - mesh.vertices[t[0]]);
    for (const std::uint32_t vertex : t)
      mesh.normals[vertex] += normal;
  }
  for (Eigen::Vector3f& normal : mesh.normals)
    normal = normal.norm () > 0.0f ? Eigen::Vector3f (normal.normalized ()) : Eigen::Vector3f::UnitZ ();
}

} // namespace

TriangleMesh
backgroundOf (const FrameReport& report, const PinholeCamera& camera)
{
  TriangleMesh mesh;
  if (!report.instances)
    return (mesh);
  const Image<float>& depth = report.frame.depth;
  const int step = std::max (1, depth.width / columns);
  const int width = depth.width / step, height = depth.height / step;
  std::vector<std::uint32_t> vertex_of (static_cast<std::size_t> (width) * height, none);
  std::vector<float> z_of;
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u)
    {
      const float z = depth.at (u * step, v * step);
      if (!std::isfinite (z) || (!report.instances->pixels.empty () && report.instances->at (u * step, v * step) != 0))
        continue;
      vertex_of[static_cast<std::size_t> (v) * width + u] = static_cast<std::uint32_t> (mesh.vertices.size ());
      mesh.vertices.push_back ((report.T_world_camera * camera.unproject (u * step, v * step, z)).cast<float> ());
      mesh.colours.push_back (report.frame.colour.pixels.empty () ? no_colour
                                                                  : report.frame.colour.at (u * step, v * step));
      z_of.push_back (z);
    }
  const auto add = [&] (std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (a == none || b == none || c == none)
      return;
    const auto [least, most] = std::minmax ({z_of[a], z_of[b], z_of[c]});
    if (most - least < deepest_jump * most)
      mesh.triangles.push_back ({a, b, c});
  };
  for (int v = 0; v + 1 < height; ++v)
    for (int u = 0; u + 1 < width; ++u)
    {
      const std::size_t n = static_cast<std::size_t> (v) * width + u;
      add (vertex_of[n], vertex_of[n + width],
           vertex_of[n + 1]); // counter-clockwise for the camera, whose y points down
      add (vertex_of[n + 1], vertex_of[n + width], vertex_of[n + width + 1]);
    }
  addNormals (mesh);
  return (mesh);
}

void
writeLiveScene (const LiveScene& scene, const std::string& folder)
{
  const fs::path mesh = fs::path (folder) / "mesh", trajectory = fs::path (folder) / "trajectory";
  const auto write = [&mesh] (const TriangleMesh& surface, const std::string& name) {
    if (!surface.empty ())
      saveMesh (surface, (mesh / name).string ());
  };
  for (const int id : scene.changed_seen)
    write (scene.seen.at (id), "object_" + std::to_string (id) + "_tsdf.ply");
  for (const int id : scene.changed_completed)
    write (scene.completed.at (id), "object_" + std::to_string (id) + ".ply");
  if (scene.changed_background)
  {
    TriangleMesh all;
    for (const TriangleMesh& part : scene.background)
      if (all.vertices.empty ())
        all = part;
      else
        appendMesh (all, part);
    write (all, "background.ply");
  }
  for (const auto& [id, poses] : scene.objects)
    saveTrajectory (poses, (trajectory / ("object_" + std::to_string (id) + ".txt")).string ());
  if (!scene.camera.empty ())
    saveTrajectory (scene.camera,
                    (trajectory / "camera.txt").string ()); // last: its time shows that there is something new
}
