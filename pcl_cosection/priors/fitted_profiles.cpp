// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "fitted_profiles.h"

#include "resting_planes.h"

#include <algorithm>

namespace pcl::cosection {
namespace {

constexpr std::ptrdiff_t least_ground = 20; // background points seen in the cavity, which make a vessel a tube

/** \brief The shape with a profile that the points show; without floor if background was seen where a vessel would have
 * its floor.
 */
ProfiledShape
fitShape (const Observation& object, const ObjectSetting& setting, const std::optional<Eigen::Vector4d>& plane)
{
  const Profiles profiles{setting.priors.revolution, setting.priors.vessels};
  if (!plane)
    return ProfiledShape (object.points (), setting.is_alone, profiles);
  const ProfiledShape shape (object.points (), *plane, profiles);
  if (!(shape.wallThickness () > 0.0))
    return shape;
  const Eigen::Vector3d up = plane->head<3> ();
  const double near_m = object.voxel_size_m;
  const double floor_m = shape.wallThickness () + 2.0 * near_m;
  const auto is_at_floor = [&] (const Eigen::Vector3d& p, double reach_m) {
    return std::abs (heightOver (*plane, p)) < reach_m && shape.depthInCavity (p + floor_m * up) > near_m;
  };
  const auto ground = std::count_if (setting.background.begin (), setting.background.end (),
                                     [&] (const OrientedPoint& p) {
                                       return is_at_floor (setting.T_object_world * p.position.cast<double> (), near_m);
                                     });
  const auto floor = std::count_if (object.points ().begin (), object.points ().end (), [&] (const OrientedPoint& p) {
    return is_at_floor (p.position.cast<double> (), floor_m);
  });
  return ground >= least_ground && ground > floor ? shape.withoutFloor () : shape;
}

} // namespace

const ProfiledShape&
shapeOf (const Observation& object, const ObjectSetting& setting, const std::optional<Eigen::Vector4d>& plane)
{
  const Eigen::Vector4d p = plane.value_or (Eigen::Vector4d::Zero ());
  const ShapeFits::key_type key = {p[0], p[1], p[2], p[3]};
  const auto found = object.fits->find (key);
  return found != object.fits->end () ? found->second
                                      : object.fits->emplace (key, fitShape (object, setting, plane)).first->second;
}

std::vector<ProfiledShape>
profiledShapes (const Observation& object, const ObjectSetting& setting, const std::vector<Eigen::Vector4d>& resting)
{
  std::vector<ProfiledShape> shapes;
  for (const Eigen::Vector4d& plane : resting)
    shapes.push_back (shapeOf (object, setting, plane));
  if (resting.empty ())
    shapes.push_back (shapeOf (object, setting, std::nullopt));
  shapes.erase (std::remove_if (shapes.begin (), shapes.end (), [] (const ProfiledShape& shape) { return !shape; }),
                shapes.end ());
  return shapes;
}

} // namespace pcl::cosection
