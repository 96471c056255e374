// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// The code of doc/tutorial_segmentation.md.
//
// tutorial_segmentation [VIEW.pcd]: closed meshes of the objects in one organised view, to the folder segmentation;
// without an argument of a view of a scene that the program makes up.

#include "table_views.h"

#include <pcl/cosection/io/mesh_io.h>
#include <pcl/cosection/segmentation/geometric_segmentation.h>
#include <pcl/cosection/surface/hessian_imls.h>
#include <pcl/cosection/surface/normals.h>

#include <pcl/filters/extract_indices.h>
#include <pcl/filters/filter.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <exception>
#include <filesystem>
#include <iostream>
#include <stdexcept>

namespace {

using View = pcl::PointCloud<pcl::PointXYZRGB>;
using Cloud = pcl::PointCloud<pcl::PointXYZRGBNormal>;

constexpr std::size_t made_up_objects = 3; ///< on the table that the program makes up

struct Scene
{
  std::vector<pcl::PointIndices> objects;
  pcl::ModelCoefficients table;
};

Scene
segment (const View::Ptr& view)
{
  Scene scene;
  pcl::cosection::GeometricSegmentation<pcl::PointXYZRGB> segmentation;
  segmentation.setInputCloud (view);
  pcl::PointCloud<pcl::Label> labels; // as organised as the view: 0 background, 1 ... objects
  segmentation.segment (labels, scene.objects);
  if (segmentation.getSupportPlanes ().empty ())
    throw std::runtime_error ("there is no table");
  scene.table = segmentation.getSupportPlanes ().front (); // the best seen
  return scene;
}

/** \brief As organised as the view. */
Cloud::Ptr
withNormals (const View& view)
{
  std::vector<Eigen::Vector3f> positions;
  for (const auto& p : view)
    positions.push_back (p.getVector3fMap ());
  const auto normals = pcl::cosection::computeOrganizedNormals (positions, view.width, view.height);

  Cloud::Ptr cloud (new Cloud (view.width, view.height));
  for (std::size_t i = 0; i < view.size (); ++i)
  {
    (*cloud)[i].getVector3fMap () = positions[i];
    (*cloud)[i].getNormalVector3fMap () = normals[i];
    (*cloud)[i].rgb = view[i].rgb;
  }
  return cloud;
}

Cloud::Ptr
pointsOf (const pcl::PointIndices& object, const Cloud::Ptr& cloud)
{
  Cloud::Ptr points (new Cloud);
  pcl::ExtractIndices<pcl::PointXYZRGBNormal> extract;
  extract.setInputCloud (cloud);
  extract.setIndices (pcl::make_shared<pcl::PointIndices> (object));
  extract.filter (*points);

  pcl::Indices reliable; // edges of depth have no normal
  pcl::removeNaNNormalsFromPointCloud (*points, *points, reliable);
  return points;
}

bool
complete (const Cloud::Ptr& points, const View& view, const pcl::ModelCoefficients& table, const std::string& path)
{
  pcl::cosection::HessianIMLS<pcl::PointXYZRGBNormal> imls;
  imls.setInputCloud (points);
  imls.addView (view, Eigen::Isometry3d::Identity ()); // what lies before its surfaces is free
  imls.addSupportPlane (table);
  pcl::PolygonMesh mesh;
  imls.reconstruct (mesh);
  if (mesh.polygons.empty ())
    return false; // the console says why
  pcl::cosection::saveMesh (imls.getTriangleMesh (), path);
  std::cout << path << ": " << points->size () << " points, " << mesh.polygons.size () << " triangles\n";
  return pcl::cosection::computeTopology (imls.getTriangleMesh ()).closed_manifold;
}

struct Outcome
{
  std::size_t objects = 0;
  std::size_t closed = 0; ///< meshes
};

Outcome
completeAll (const std::string& path, const std::string& folder)
{
  View::Ptr view (new View);
  if (pcl::io::loadPCDFile (path, *view) != 0)
    throw std::runtime_error ("cannot read " + path);

  const Scene scene = segment (view);
  const Cloud::Ptr cloud = withNormals (*view);
  Outcome outcome;
  for (const pcl::PointIndices& object : scene.objects)
    outcome.closed += complete (pointsOf (object, cloud), *view, scene.table,
                                folder + "/object_" + std::to_string (++outcome.objects) + ".ply");
  return outcome;
}

} // namespace

int
main (int argc, char** argv)
{
  try
  {
    const std::string folder = "segmentation";
    std::filesystem::create_directories (folder);
    const bool made_up = argc < 2;
    const Outcome outcome = completeAll (made_up ? writeTableViews (folder).front () : argv[1], folder);
    std::cout << outcome.closed << " closed meshes of " << outcome.objects << " objects\n";
    if (made_up)
      return outcome.objects == made_up_objects && outcome.closed == made_up_objects ? 0 : 1;
    return outcome.closed > 0 ? 0 : 1;
  }
  catch (const std::exception& error)
  {
    std::cerr << "tutorial_segmentation: " << error.what () << '\n';
    return 1;
  }
}
