// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "scene_directions.h"

#include <algorithm>
#include <cmath>

using namespace pcl::cosection;

namespace
{

constexpr std::size_t candidates = 200; ///< directions that are tried
constexpr double farthest_cosine = 0.35; ///< from the pictures' up: a camera looks down by at most 70 degrees
constexpr double same_cosine = 0.99;     ///< 8 degrees: of one plane, with noise
constexpr double least_share = 0.05;     ///< of the background
constexpr double stamp_tolerance = 1e-6;

struct Facet
{
  Eigen::Vector3d normal; ///< times the area
  double area;
};

std::vector<Facet>
facetsOf (const TriangleMesh& mesh)
{
  std::vector<Facet> facets;
  for (const TriangleMesh::Triangle& t : mesh.triangles)
  {
    const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double> ();
    const Eigen::Vector3d normal = 0.5 * (mesh.vertices[t[1]].cast<double> () - a).cross (mesh.vertices[t[2]].cast<double> () - a);
    if (normal.norm () > 0.0)
      facets.push_back ({normal, normal.norm ()});
  }
  return (facets);
}

} // namespace

Eigen::Vector3d
upOf (const RunFolder& run)
{
  Eigen::Vector3d up = Eigen::Vector3d::Zero ();
  for (const StampedPose& pose : run.camera)
    up -= pose.pose.linear ().col (1);
  if (!(up.norm () > 1e-6))
    return (Eigen::Vector3d::UnitZ ());
  up.normalize ();
  const std::vector<Facet> facets = facetsOf (run.background);
  double total = 0.0, largest = 0.0;
  for (const Facet& facet : facets)
    total += facet.area;
  Eigen::Vector3d best = up;
  const std::size_t step = facets.size () / candidates + 1;
  for (std::size_t n = 0; n < facets.size (); n += step)
  {
    const Eigen::Vector3d direction = facets[n].normal / facets[n].area;
    if (direction.dot (up) < farthest_cosine)
      continue;
    double area = 0.0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero ();
    for (const Facet& facet : facets)
      if (facet.normal.dot (direction) > same_cosine * facet.area)
      {
        area += facet.area;
        sum += facet.normal;
      }
    if (area > largest)
    {
      largest = area;
      best = sum.normalized ();
    }
  }
  return (largest > least_share * total ? best : up);
}

const Eigen::Isometry3d*
poseAt (const std::vector<StampedPose>& poses, double stamp)
{
  const auto found = std::lower_bound (poses.begin (), poses.end (), stamp - stamp_tolerance,
                                       [] (const StampedPose& pose, double value) { return (pose.stamp < value); });
  return (found == poses.end () || found->stamp > stamp + stamp_tolerance ? nullptr : &found->pose);
}

Eigen::Vector3d
middleOf (const TriangleMesh& mesh)
{
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    box.extend (vertex.cast<double> ());
  return (box.isEmpty () ? Eigen::Vector3d (Eigen::Vector3d::Zero ()) : Eigen::Vector3d (box.center ()));
}

ObjectDirections
directionsOf (const RunObject& object, const RunFolder& run, const Eigen::Vector3d& up)
{
  ObjectDirections directions;
  const Eigen::Vector3d middle = middleOf (object.completed.empty () ? object.seen : object.completed);
  Eigen::Vector3d mean_up = Eigen::Vector3d::Zero (), front = Eigen::Vector3d::Zero ();
  for (const StampedPose& pose : object.poses)
    if (const Eigen::Isometry3d* camera = poseAt (run.camera, pose.stamp))
    {
      const Eigen::Isometry3d T_object_world = pose.pose.inverse ();
      mean_up += T_object_world.linear () * up;
      front += (T_object_world * camera->translation () - middle).normalized ();
    }
  if (mean_up.norm () > 1e-6)
    directions.up = mean_up.normalized ();
  if (front.norm () > 1e-6)
    directions.front = front.normalized ();
  if (directions.up.cross (directions.front).norm () < 0.1) // straight from above: from a side that is one
    directions.front = (directions.up + directions.up.unitOrthogonal ()).normalized ();
  return (directions);
}
