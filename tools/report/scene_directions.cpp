// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "scene_directions.h"

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>

using namespace pcl::cosection;

namespace {

constexpr double stamp_tolerance = 1e-6;

} // namespace

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

Eigen::Vector3d
standingSize (const TriangleMesh& mesh, const Eigen::Vector3d& up)
{
  if (mesh.vertices.empty ())
    return (Eigen::Vector3d::Zero ());
  const Eigen::Vector3d x = up.unitOrthogonal (), y = up.cross (x);
  std::vector<cv::Point2f> horizontal;
  Eigen::AlignedBox1d heights;
  for (const Eigen::Vector3f& vertex : mesh.vertices)
  {
    const Eigen::Vector3d v = vertex.cast<double> ();
    horizontal.emplace_back (static_cast<float> (v.dot (x)), static_cast<float> (v.dot (y)));
    heights.extend (Eigen::AlignedBox1d::VectorType (v.dot (up)));
  }
  const cv::Size2f area = cv::minAreaRect (horizontal).size;
  return {std::max (area.width, area.height), std::min (area.width, area.height), heights.sizes ()[0]};
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
