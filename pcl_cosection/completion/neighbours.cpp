// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "neighbours.h"

#include "pcl_cosection/common/boxes.h"

#include <algorithm>
#include <numeric>

namespace pcl::cosection {
namespace {

constexpr double margin_vox = 3.0; // poses that differ by less than a voxel are taken for one

/** \brief The box in the world of an object's volume at all of its poses. */
Eigen::AlignedBox3d
boxInWorld (const SceneObject& object)
{
  Eigen::AlignedBox3d box;
  for (std::size_t v = 0; v < std::max<std::size_t> (1, object.input->T_world_object.size ()); ++v)
    if (const Eigen::Isometry3d T_world_object = poseAt (*object.input, v); T_world_object.matrix ().allFinite ())
      for (const Eigen::Vector3d& corner : corners (object.grid ()))
        box.extend (T_world_object * corner);
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant (margin_vox * object.grid ().voxel_size_m);
  return {box.min () - margin, box.max () + margin};
}

} // namespace

std::vector<std::vector<std::size_t>>
neighboursOf (const std::vector<SceneObject>& objects)
{
  std::vector<Eigen::AlignedBox3d> boxes (objects.size ());
  std::transform (objects.begin (), objects.end (), boxes.begin (), boxInWorld);
  // Along the axis on which they are spread most, so that few begin before another ends.
  const auto all = std::accumulate (
      boxes.begin (), boxes.end (), Eigen::AlignedBox3d (),
      [] (const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b) { return a.merged (b); });
  Eigen::Index axis = 0;
  if (!objects.empty ())
    all.sizes ().maxCoeff (&axis);
  std::vector<std::size_t> order (objects.size ());
  std::iota (order.begin (), order.end (), std::size_t (0));
  std::sort (order.begin (), order.end (),
             [&] (std::size_t a, std::size_t b) { return boxes[a].min ()[axis] < boxes[b].min ()[axis]; });
  std::vector<std::vector<std::size_t>> neighbours (objects.size ());
  for (auto a = order.begin (); a != order.end (); ++a)
    for (auto b = std::next (a); b != order.end () && boxes[*b].min ()[axis] <= boxes[*a].max ()[axis]; ++b)
      if (boxes[*a].intersects (boxes[*b]))
      {
        neighbours[*a].push_back (*b);
        neighbours[*b].push_back (*a);
      }
  for (std::vector<std::size_t>& of_one : neighbours)
    std::sort (of_one.begin (), of_one.end ());
  return neighbours;
}

} // namespace pcl::cosection
