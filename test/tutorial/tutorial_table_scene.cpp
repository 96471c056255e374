// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// The code of doc/tutorial_table_scene.md.
//
// tutorial_table_scene [VIEW.pcd ...]: closed meshes of the objects on a table, to the folder table_scene, of organised
// views whose poses are in the headers; without arguments of a scene that the program makes up.

#include "table_views.h"

#include <pcl/cosection/io/mesh_io.h>
#include <pcl/cosection/surface/free_space_filter.h>
#include <pcl/cosection/surface/hessian_imls.h>
#include <pcl/cosection/surface/normals.h>

#include <pcl/common/transforms.h>
#include <pcl/filters/extract_indices.h>
#include <pcl/filters/project_inliers.h>
#include <pcl/filters/statistical_outlier_removal.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>
#include <pcl/segmentation/extract_clusters.h>
#include <pcl/segmentation/extract_polygonal_prism_data.h>
#include <pcl/segmentation/sac_segmentation.h>
#include <pcl/surface/convex_hull.h>

#include <exception>
#include <filesystem>
#include <iostream>
#include <stdexcept>

namespace {

using View = pcl::PointCloud<pcl::PointXYZRGB>;
using Cloud = pcl::PointCloud<pcl::PointXYZRGBNormal>;

constexpr float range_m = 1.5f; ///< farther readings are too noisy for meshes
constexpr float leaf_m = 0.004f;
constexpr std::size_t made_up_objects = 3; ///< on the table that the program makes up, without the visitor

View::Ptr
load (const std::string& path)
{
  View::Ptr view (new View);
  if (pcl::io::loadPCDFile (path, *view) != 0)
    throw std::runtime_error ("cannot read " + path);
  return view;
}

/** \brief T_world_sensor */
Eigen::Isometry3d
pose (const View& view)
{
  Eigen::Isometry3d T_world_sensor = Eigen::Isometry3d::Identity ();
  T_world_sensor.linear () = view.sensor_orientation_.normalized ().toRotationMatrix ().cast<double> ();
  T_world_sensor.translation () = view.sensor_origin_.head<3> ().cast<double> ();
  return T_world_sensor;
}

/** \brief The points of a view that have a reliable normal, in the world frame. */
Cloud
orientedPoints (const View& view)
{
  std::vector<Eigen::Vector3f> positions;
  for (const auto& p : view)
    positions.push_back (p.getVector3fMap ());
  const auto normals = pcl::cosection::computeOrganizedNormals (positions, view.width, view.height);

  Cloud in_sensor, in_world;
  for (std::size_t i = 0; i < view.size (); ++i)
    if (normals[i].allFinite () && view[i].z < range_m)
    {
      pcl::PointXYZRGBNormal p;
      p.getVector3fMap () = positions[i];
      p.getNormalVector3fMap () = normals[i];
      p.rgb = view[i].rgb;
      in_sensor.push_back (p);
    }
  pcl::transformPointCloudWithNormals (in_sensor, in_world, pose (view).matrix ());
  return in_world;
}

Cloud::Ptr
merge (const std::vector<View::Ptr>& views)
{
  Cloud::Ptr merged (new Cloud), thinned (new Cloud);
  for (const auto& view : views)
    *merged += orientedPoints (*view);

  pcl::VoxelGrid<pcl::PointXYZRGBNormal> grid; // averages normals and colours, too
  grid.setInputCloud (merged);
  grid.setLeafSize (leaf_m, leaf_m, leaf_m);
  grid.filter (*thinned);
  return thinned;
}

Cloud::Ptr
removeOutliers (const Cloud::Ptr& cloud, const std::vector<View::Ptr>& views)
{
  Cloud::Ptr dense (new Cloud), clean (new Cloud);
  pcl::StatisticalOutlierRemoval<pcl::PointXYZRGBNormal> outliers;
  outliers.setInputCloud (cloud);
  outliers.setMeanK (30);
  outliers.setStddevMulThresh (3.0);
  outliers.filter (*dense);

  pcl::cosection::FreeSpaceFilter<pcl::PointXYZRGBNormal> free_space;
  free_space.setInputCloud (dense);
  for (const auto& view : views)
    if (!free_space.addView (*view, pose (*view)))
      throw std::runtime_error ("a view is not the image of a depth camera");
  free_space.filter (*clean);
  return clean;
}

pcl::PointIndices::Ptr
findTable (const Cloud::Ptr& cloud, pcl::ModelCoefficients& table)
{
  pcl::PointIndices::Ptr inliers (new pcl::PointIndices);
  pcl::SACSegmentation<pcl::PointXYZRGBNormal> plane;
  plane.setModelType (pcl::SACMODEL_PLANE);
  plane.setMethodType (pcl::SAC_RANSAC);
  plane.setDistanceThreshold (0.01);
  plane.setMaxIterations (2000);
  plane.setProbability (0.999);
  plane.setOptimizeCoefficients (true);
  plane.setInputCloud (cloud);
  plane.segment (*inliers, table);
  if (inliers->indices.empty ())
    throw std::runtime_error ("there is no table");
  return inliers;
}

/** \brief Convex outline of the largest connected part of the table. */
Cloud::Ptr
outline (const Cloud::Ptr& cloud, const pcl::PointIndices::Ptr& inliers, const pcl::ModelCoefficients& table)
{
  std::vector<pcl::PointIndices> parts; // the largest first
  pcl::EuclideanClusterExtraction<pcl::PointXYZRGBNormal> connected;
  connected.setInputCloud (cloud);
  connected.setIndices (inliers);
  connected.setClusterTolerance (0.03);
  connected.setMinClusterSize (100);
  connected.extract (parts);
  if (parts.empty ())
    throw std::runtime_error ("the table is too small");

  Cloud::Ptr flat (new Cloud), hull (new Cloud);
  pcl::ProjectInliers<pcl::PointXYZRGBNormal> project;
  project.setModelType (pcl::SACMODEL_PLANE);
  project.setModelCoefficients (pcl::make_shared<pcl::ModelCoefficients> (table));
  project.setInputCloud (cloud);
  project.setIndices (pcl::make_shared<pcl::PointIndices> (parts.front ()));
  project.filter (*flat);

  pcl::ConvexHull<pcl::PointXYZRGBNormal> convex;
  convex.setDimension (2);
  convex.setInputCloud (flat);
  convex.reconstruct (*hull);
  return hull;
}

Cloud::Ptr
pointsOnTable (const Cloud::Ptr& cloud, const Cloud::Ptr& hull, const Eigen::Vector3f& sensor)
{
  pcl::PointIndices::Ptr above (new pcl::PointIndices);
  pcl::ExtractPolygonalPrismData<pcl::PointXYZRGBNormal> prism;
  prism.setInputCloud (cloud);
  prism.setInputPlanarHull (hull);
  prism.setViewPoint (sensor.x (), sensor.y (), sensor.z ()); // which is above the table
  prism.setHeightLimits (0.01, 0.5);
  prism.segment (*above);

  Cloud::Ptr objects (new Cloud);
  pcl::ExtractIndices<pcl::PointXYZRGBNormal> extract;
  extract.setInputCloud (cloud);
  extract.setIndices (above);
  extract.filter (*objects);
  return objects;
}

std::vector<pcl::PointIndices>
separate (const Cloud::Ptr& objects)
{
  std::vector<pcl::PointIndices> clusters;
  pcl::EuclideanClusterExtraction<pcl::PointXYZRGBNormal> clustering;
  clustering.setInputCloud (objects);
  clustering.setClusterTolerance (3.0 * leaf_m);
  clustering.setMinClusterSize (200);
  clustering.extract (clusters);
  return clusters;
}

bool
complete (const Cloud::Ptr& objects, const pcl::PointIndices& cluster, const std::vector<View::Ptr>& views,
          const pcl::ModelCoefficients& table, const std::string& path)
{
  pcl::cosection::HessianIMLS<pcl::PointXYZRGBNormal> imls;
  imls.setInputCloud (objects);
  imls.setIndices (pcl::make_shared<pcl::PointIndices> (cluster));
  for (const auto& view : views)
    imls.addView (*view, pose (*view));
  imls.addSupportPlane (table);
  pcl::PolygonMesh mesh;
  imls.reconstruct (mesh);
  if (mesh.polygons.empty ())
    return false; // the console says why
  pcl::cosection::saveMesh (imls.getTriangleMesh (), path);

  std::cout << path << ": " << cluster.indices.size () << " points, " << mesh.polygons.size () << " triangles\n";
  return pcl::cosection::computeTopology (imls.getTriangleMesh ()).closed_manifold;
}

/** \brief The table as a mesh, to look at. */
void
saveTable (const Cloud& hull, const Eigen::Vector3f& sensor, const pcl::ModelCoefficients& table,
           const std::string& path)
{
  const Eigen::Vector4f plane = Eigen::Map<const Eigen::Vector4f> (table.values.data ());
  const float up = plane.head<3> ().dot (sensor) + plane[3] > 0.0f ? 1.0f : -1.0f;
  pcl::cosection::TriangleMesh mesh;
  for (const auto& corner : hull)
  {
    mesh.vertices.push_back (corner.getVector3fMap ());
    mesh.normals.push_back (up * plane.head<3> ());
    mesh.colours.push_back ({225, 222, 216});
  }
  for (std::uint32_t i = 2; i < hull.size (); ++i)
  {
    const Eigen::Vector3f edge = mesh.vertices[i - 1] - mesh.vertices[0];
    const bool faces_up = edge.cross (mesh.vertices[i] - mesh.vertices[0]).dot (mesh.normals[0]) > 0.0f;
    mesh.triangles.push_back ({0, faces_up ? i - 1 : i, faces_up ? i : i - 1});
  }
  pcl::cosection::saveMesh (mesh, path);
}

struct Outcome
{
  std::size_t clusters = 0;
  std::size_t closed = 0; ///< meshes
};

Outcome
tableScene (const std::vector<std::string>& paths, const std::string& folder)
{
  std::vector<View::Ptr> views;
  for (const std::string& path : paths)
    views.push_back (load (path));
  const Eigen::Vector3f sensor = pose (*views.front ()).translation ().cast<float> ();

  const Cloud::Ptr merged = merge (views);
  const Cloud::Ptr cloud = removeOutliers (merged, views);
  std::cout << merged->size () << " points, " << cloud->size () << " without outliers\n";

  pcl::ModelCoefficients table;
  const pcl::PointIndices::Ptr inliers = findTable (cloud, table);
  const Cloud::Ptr hull = outline (cloud, inliers, table);
  saveTable (*hull, sensor, table, folder + "/background.ply");

  const Cloud::Ptr objects = pointsOnTable (cloud, hull, sensor);
  Outcome outcome;
  for (const pcl::PointIndices& cluster : separate (objects))
  {
    const std::string path = folder + "/object_" + std::to_string (++outcome.clusters) + ".ply";
    outcome.closed += complete (objects, cluster, views, table, path);
  }
  return outcome;
}

} // namespace

int
main (int argc, char** argv)
{
  try
  {
    const std::string folder = "table_scene";
    std::filesystem::create_directories (folder);
    std::vector<std::string> paths (argv + 1, argv + argc);
    const bool made_up = paths.empty ();
    if (made_up)
      paths = writeTableViews (folder);
    const Outcome outcome = tableScene (paths, folder);
    std::cout << outcome.closed << " closed meshes of " << outcome.clusters << " clusters\n";
    if (made_up)
      return outcome.clusters == made_up_objects && outcome.closed == made_up_objects ? 0 : 1;
    return outcome.closed > 0 ? 0 : 1;
  }
  catch (const std::exception& error)
  {
    std::cerr << "tutorial_table_scene: " << error.what () << '\n';
    return 1;
  }
}
