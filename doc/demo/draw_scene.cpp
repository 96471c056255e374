// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// draw_scene VIEW.pcd MESHES OUTPUT.png: three pictures beside each other: the points of a view seen from the side, the
// meshes in the folder MESHES from there, and the meshes from behind, coloured by provenance. Up is where most of the
// background faces.

#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/rendering/picture.h"
#include "pcl_cosection/view/look_at.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/mesh_io.h>
#include <pcl/cosection/rendering/rasterizer.h>

#include <pcl/common/point_tests.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

using namespace pcl::cosection;

namespace {

constexpr int width_px = 440;
constexpr int height_px = 400;
constexpr double side_rad = 0.9;    ///< from the sensor, about the vertical axis
constexpr double behind_rad = M_PI; ///< likewise
constexpr double margin = 1.2;      ///< of the picture around the objects
constexpr double outliers = 0.02;   ///< share of the objects' points that may be out of the picture, at each end
constexpr TriangleMesh::Colour background_colour = {225, 222, 216};

using Cloud = pcl::PointCloud<pcl::PointXYZRGBL>;

/** \brief What is drawn, in the world frame. */
struct Scene
{
  std::vector<Eigen::Vector3f> points;
  std::vector<TriangleMesh::Colour> colours;
  Eigen::Vector3d sensor;
  Eigen::Vector3d middle; ///< of the objects' points
  double radius = 0.0;    ///< of the objects' points around it
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ ();
  TriangleMesh background;
  std::vector<TriangleMesh> objects;
};

void
addView (const std::string& path, Scene& scene)
{
  Cloud cloud;
  if (pcl::io::loadPCDFile (path, cloud) != 0)
    throw IoError ("cannot read " + path);
  scene.sensor = cloud.sensor_origin_.head<3> ().cast<double> ();

  std::array<std::vector<double>, 3> coordinates;
  for (const pcl::PointXYZRGBL& point : cloud)
  {
    if (!pcl::isFinite (point))
      continue;
    scene.points.push_back (cloud.sensor_orientation_ * point.getVector3fMap () + cloud.sensor_origin_.head<3> ());
    scene.colours.push_back ({point.r, point.g, point.b});
    if (point.label > 0)
      for (int axis = 0; axis < 3; ++axis)
        coordinates[axis].push_back (scene.points.back ()[axis]);
  }
  if (coordinates[0].empty ())
    throw DegenerateInput (path + " has no labelled points");
  Eigen::Vector3d size;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double low = quantile (coordinates[axis], outliers);
    const double high = quantile (coordinates[axis], 1.0 - outliers);
    scene.middle[axis] = 0.5 * (low + high);
    size[axis] = high - low;
  }
  scene.radius = 0.5 * size.norm ();
}

void
addMeshes (const std::string& folder, Scene& scene)
{
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator (folder))
    files.push_back (entry.path ());
  std::sort (files.begin (), files.end ());
  for (const std::filesystem::path& file : files)
  {
    if (file.filename () == "background.ply")
    {
      scene.background = loadPlyMesh (file.string ());
      Eigen::Vector3f sum = Eigen::Vector3f::Zero ();
      for (const Eigen::Vector3f& normal : scene.background.normals)
        sum += normal;
      if (sum.norm () > 0.0f)
        scene.up = sum.normalized ().cast<double> ();
    }
    else if (file.extension () == ".ply")
      scene.objects.push_back (loadPlyMesh (file.string ()));
  }
}

/** \brief A camera that sees all objects, turned about the vertical axis from where the sensor was. */
class Panel
{
public:
  Panel (const Scene& scene, double turn_rad)
  {
    const Eigen::Vector3d offset = Eigen::AngleAxisd (turn_rad, scene.up) * (scene.sensor - scene.middle);
    const double focal_length = 0.5 * std::min (width_px, height_px) * offset.norm () / (margin * scene.radius);
    camera_ = {width_px, height_px, focal_length, focal_length, 0.5 * (width_px - 1), 0.5 * (height_px - 1)};
    T_world_camera_ = lookAt (scene.middle + offset, scene.middle, scene.up);
  }

  Rasterizer rasterizer () const { return (Rasterizer (camera_, T_world_camera_)); }

  Picture picture (const Rasterizer& rasterizer) const { return (shade (rasterizer.image (), camera_)); }

private:
  PinholeCamera camera_;
  Eigen::Isometry3d T_world_camera_;
};

Picture
drawPoints (const Scene& scene, const Panel& panel)
{
  Rasterizer rasterizer = panel.rasterizer ();
  rasterizer.drawPoints (scene.points, scene.colours, 0, 3);
  return (panel.picture (rasterizer));
}

Picture
drawMeshes (const Scene& scene, const Panel& panel)
{
  Rasterizer rasterizer = panel.rasterizer ();
  rasterizer.draw (scene.background, 0);
  for (const TriangleMesh& mesh : scene.objects)
    rasterizer.draw (mesh, 1);
  return (panel.picture (rasterizer));
}

Picture
drawProvenance (const Scene& scene, const Panel& panel)
{
  Rasterizer rasterizer = panel.rasterizer ();
  TriangleMesh background = scene.background;
  background.colours.clear ();
  rasterizer.draw (background, 0, Eigen::Isometry3d::Identity (), background_colour);
  for (TriangleMesh mesh : scene.objects)
  {
    if (!mesh.provenance.empty ())
      mesh.colours = provenanceColours (mesh);
    rasterizer.draw (mesh, 1);
  }
  return (panel.picture (rasterizer));
}

} // namespace

int
main (int argc, char** argv)
{
  if (argc != 4)
  {
    std::cerr << "Usage: draw_scene VIEW.pcd MESHES OUTPUT.png\n";
    return (2);
  }
  try
  {
    Scene scene;
    addView (argv[1], scene);
    addMeshes (argv[2], scene);
    const Panel side (scene, side_rad);
    const Panel behind (scene, behind_rad);
    writePng (beside ({drawPoints (scene, side), drawMeshes (scene, side), drawProvenance (scene, behind)}), argv[3]);
    return (0);
  }
  catch (const std::exception& error)
  {
    std::cerr << "draw_scene: " << error.what () << '\n';
    return (1);
  }
}
