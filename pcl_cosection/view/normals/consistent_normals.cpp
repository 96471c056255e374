// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "consistent_normals.h"

#include "estimated_normals.h"
#include "pcl_cosection/view/object_surroundings.h"
#include "pcl_cosection/view/outliers/scattered_points.h"

#include <pcl/cosection/surface/normals.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pcl::cosection {
namespace {

// Length of the mean normal of a background that has a side; of random ones to one side, 0.5.
constexpr float one_sided = 0.7f;
constexpr std::size_t least_background = 100; // points, to decide on a side
constexpr double decisive = 0.75;             // share of a piece that faces to one side

/** \brief How much of what of all normals has a sign does have a positive one. */
class Share
{
public:
  void add (float value) { (value > 0.0f ? positive_ : negative_) += std::abs (value); }

  bool isKnown () const { return positive_ + negative_ > 0.0; }

  double get () const { return isKnown () ? positive_ / (positive_ + negative_) : 0.5; }

private:
  double positive_ = 0.0;
  double negative_ = 0.0;
};

/** \brief How much of a piece of the background faces the objects near it; all of them, if there is none near. */
double
facingShare (const Surroundings& objects, const std::vector<Eigen::Vector3f>& points,
             const std::vector<Eigen::Vector3f>& normals)
{
  Share near, all;
  for (std::size_t i = 0; i < points.size (); ++i)
    for (const auto& [label, box] : objects)
    {
      const float facing = normals[i].dot (box.center () - points[i]);
      all.add (facing);
      if (box.contains (points[i]))
        near.add (facing);
    }
  return near.isKnown () ? near.get () : all.get ();
}

/** \brief How much of a piece of an object faces away from the background. */
double
awayShare (const Eigen::Vector3f& away, const std::vector<Eigen::Vector3f>& points,
           const std::vector<Eigen::Vector3f>& normals)
{
  Share share;
  for (const Eigen::Vector3f& normal : normals)
    share.add (normal.dot (away));
  return std::max (share.get (), 1.0 - share.get ()) >= decisive ? share.get () : outwardShare (points, normals);
}

/** \brief The side of the background near an object on which that is; zero if it has none, as a bin's walls. */
Eigen::Vector3f
sideOf (const Eigen::AlignedBox3f& surroundings, const Members& members, const SensorCloud& cloud)
{
  Eigen::Vector3d sum = Eigen::Vector3d::Zero ();
  std::size_t count = 0;
  if (const auto background = members.find (0); background != members.end ())
    for (const std::size_t i : background->second)
      if (cloud.normals[i].allFinite () && surroundings.contains (cloud.positions[i]))
      {
        sum += cloud.normals[i].cast<double> ();
        ++count;
      }
  if (!(count >= least_background && sum.norm () > one_sided * static_cast<double> (count)))
    return Eigen::Vector3f::Zero ();
  return sum.normalized ().cast<float> ();
}

} // namespace

void
addConsistentNormals (const PcdViewOptions& options, const Members& members, SensorCloud& cloud)
{
  const Surroundings objects = surroundingsOf (members, cloud);
  const auto add = [&] (const std::vector<std::size_t>& indices, const auto& rightShare) {
    EstimatedNormals estimated = estimateNormals (options, pick (cloud.positions, indices));
    orientConsistently (estimated.points, estimated.normals, rightShare);
    for (std::size_t k = 0; k < indices.size (); ++k)
      cloud.normals[indices[k]] = estimated.normals[estimated.of[k]];
  };
  const BackgroundParts background = partsOfBackground (objects, members, cloud);
  for (const std::vector<std::size_t>* part : {&background.near, &background.far})
    add (*part, [&] (const auto& points, const auto& normals) { return facingShare (objects, points, normals); });
  leaveOutScattered (options, objects, background.near, cloud);
  for (const auto& [label, indices] : members)
    if (label != 0)
    {
      const Eigen::Vector3f away = sideOf (objects.at (label), members, cloud);
      add (indices, [&away] (const auto& points, const auto& normals) { return awayShare (away, points, normals); });
    }
}

} // namespace pcl::cosection
