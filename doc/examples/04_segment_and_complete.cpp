// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Find the objects of an organised view by their geometry, then complete them together. 04_segment_and_complete
// [VIEW.pcd]
#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/segmentation/geometric_segmentation.h>
#include <pcl/cosection/surface/co_section.h>
#include <pcl/cosection/surface/normals.h>

#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <iostream>

using namespace pcl::cosection;

int
main (int argc, char** argv)
{
  pcl::PointCloud<pcl::PointXYZ> view;
  if (pcl::io::loadPCDFile (argc > 1 ? argv[1] : "doc/demo/table.pcd", view) != 0)
    return 1;
  std::vector<Eigen::Vector3f> positions;
  for (const auto& p : view)
    positions.push_back (p.getVector3fMap ());
  const auto labels = segmentObjects (positions, view.width, view.height).labels; // 0: background
  const auto normals = computeOrganizedNormals (positions, view.width, view.height, labels);

  CoSection scene; // in the frame of the sensor
  scene.addView (toDepthView (view).value ());
  std::map<int, std::vector<OrientedPoint>> points;
  for (std::size_t n = 0; n < positions.size (); ++n)
    if (normals[n].allFinite ()) // NaN where it would not be reliable, as at depth edges
      points[static_cast<int> (labels[n])].push_back ({positions[n], normals[n]});
  scene.setBackground (points[0]);
  for (auto object = std::next (points.begin ()); object != points.end (); ++object)
    scene.addObject ({object->first, object->second, {}});
  for (const ObjectResult& object : scene.reconstruct ().objects)
    std::cout << "object " << object.id << ": " << object.mesh.triangles.size () << " triangles " << object.error
              << '\n';
}
