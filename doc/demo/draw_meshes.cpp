// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// draw_meshes UP FRONT OUTPUT.png FILE...: each file, a mesh (.ply) or a cloud (.pcd), from two sides, all with the
// camera that fits the first one: from the direction FRONT in the upper row, turned about UP in the lower one. UP and
// FRONT are vectors such as 0,1,0. Vertices of known provenance are coloured by it.

#include "pcl_cosection/rendering/picture.h"
#include "pcl_cosection/view/look_at.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/mesh_io.h>
#include <pcl/cosection/rendering/rasterizer.h>

#include <pcl/common/point_tests.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <array>
#include <cmath>
#include <exception>
#include <filesystem>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

using namespace pcl::cosection;

namespace {

constexpr int panel_px = 360;
constexpr double turn_rad = 2.4; ///< between the rows
constexpr double distance = 4.0; ///< of the camera, in radii
constexpr double margin = 1.15;
constexpr TriangleMesh::Colour point_colour = {60, 90, 160};

/** \brief A mesh, or points alone. */
struct Item
{
  TriangleMesh mesh;
  std::vector<TriangleMesh::Colour> colours; ///< of points
};

Item
load (const std::string& path)
{
  Item item;
  if (std::filesystem::path (path).extension () != ".pcd")
  {
    item.mesh = loadPlyMesh (path);
    if (!item.mesh.provenance.empty ())
      item.mesh.colours = provenanceColours (item.mesh);
    return (item);
  }
  pcl::PointCloud<pcl::PointXYZ> cloud;
  if (pcl::io::loadPCDFile (path, cloud) != 0)
    throw IoError ("cannot read " + path);
  for (const pcl::PointXYZ& point : cloud)
    if (pcl::isFinite (point))
      item.mesh.vertices.push_back (point.getVector3fMap ());
  item.colours.assign (item.mesh.vertices.size (), point_colour);
  return (item);
}

Eigen::Vector3d
parseVector (const std::string& text)
{
  std::istringstream in (text);
  Eigen::Vector3d v;
  char comma = 0;
  if (!(in >> v.x () >> comma >> v.y () >> comma >> v.z ()) || !(v.norm () > 0.0))
    throw InvalidArgument (text + " is not a direction such as 0,1,0");
  return (v.normalized ());
}

Picture
draw (const Item& item, const Eigen::Isometry3d& T_world_camera)
{
  const double focal_length = 0.5 * panel_px * distance / margin;
  const double middle = 0.5 * (panel_px - 1);
  const PinholeCamera camera{panel_px, panel_px, focal_length, focal_length, middle, middle};
  Rasterizer rasterizer (camera, T_world_camera, 1e-6);
  if (item.mesh.triangles.empty ())
    rasterizer.drawPoints (item.mesh.vertices, item.colours, 0, 3);
  else
    rasterizer.draw (item.mesh, 1);
  return (shade (rasterizer.image (), camera));
}

Picture
above (const Picture& upper, const Picture& lower)
{
  Picture both = upper;
  both.height += lower.height;
  both.pixels.insert (both.pixels.end (), lower.pixels.begin (), lower.pixels.end ());
  return (both);
}

void
run (const std::vector<std::string>& arguments)
{
  const Eigen::Vector3d up = parseVector (arguments[0]);
  const Eigen::Vector3d front = parseVector (arguments[1]);
  std::vector<Item> items;
  for (std::size_t i = 3; i < arguments.size (); ++i)
    items.push_back (load (arguments[i]));
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& v : items.front ().mesh.vertices)
    box.extend (v.cast<double> ());
  if (box.isEmpty ())
    throw DegenerateInput (arguments[3] + " is empty");
  const double radius = 0.5 * box.diagonal ().norm ();
  std::vector<Picture> panels;
  for (const Item& item : items)
  {
    const auto from = [&] (double angle) {
      return (draw (item, lookAt (box.center () + distance * radius * (Eigen::AngleAxisd (angle, up) * front),
                                  box.center (), up)));
    };
    panels.push_back (above (from (0.0), from (turn_rad)));
  }
  writePng (beside (panels), arguments[2]);
}

} // namespace

int
main (int argc, char** argv)
{
  if (argc < 5)
  {
    std::cerr << "Usage: draw_meshes UP FRONT OUTPUT.png FILE...\n";
    return (2);
  }
  try
  {
    run ({argv + 1, argv + argc});
    return (0);
  }
  catch (const std::exception& error)
  {
    std::cerr << "draw_meshes: " << error.what () << '\n';
    return (1);
  }
}
