// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "fitted_profiles.h"

#include "pcl_cosection/view/visibility/free_space_votes.h"
#include "pcl_cosection/view/visibility/visibility.h"
#include "resting_planes.h"

#include <algorithm>

namespace pcl::cosection {
namespace {

constexpr std::ptrdiff_t least_ground = 20; // background points seen in the cavity, which make a vessel a tube

/** \brief Whether the way from a place on the ground to a sensor leads through the opening of a vessel, not through
 * its wall. \param[in] p object frame \param[in] over_m height over the ground at which a cavity begins, above a floor
 */
bool
leadsThroughOpening (const ProfiledShape& shape, const Eigen::Vector3d& p, const Eigen::Vector3d& sensor,
                     const Eigen::Vector3d& up, double over_m, double step_m)
{
  const Eigen::Vector3d way = (sensor - p).normalized ();
  if (!(way.dot (up) > 0.0))
    return false;
  Eigen::Vector3d at = p + over_m / way.dot (up) * way;
  if (!(shape.depthInCavity (at) > 0.0))
    return false;
  while (shape.depthInCavity (at) > 0.0)
    at += step_m * way;
  // Beside a place above the opening there is no cavity either.
  const Eigen::Vector3d axis = shape.axisDirection ().value_or (up);
  const Eigen::Vector3d on_axis = shape.center () + axis.dot (at - shape.center ()) * axis;
  return !(shape.depthInCavity (on_axis) > 0.0);
}

/** \brief The shape with a profile that the points show; without floor if background was seen where a vessel would have
 * its floor.
 */
ProfiledShape
fitShape (const Observation& object, const ObjectSetting& setting, const std::optional<Eigen::Vector4d>& plane)
{
  const Profiles profiles{setting.priors.revolution, setting.priors.vessels};
  if (!plane)
    return ProfiledShape (object.points (), setting.is_alone, profiles);
  ProfiledShape shape (object.points (), *plane, profiles);
  if (!(shape.wallThickness () > 0.0))
    return shape;
  const Eigen::Vector3d up = plane->head<3> ();
  const double near_m = object.voxel_size_m;
  const double floor_m = shape.wallThickness () + 2.0 * near_m;
  const auto is_at_floor = [&] (const Eigen::Vector3d& p, double reach_m) {
    return std::abs (heightOver (*plane, p)) < reach_m && shape.depthInCavity (p + floor_m * up) > near_m;
  };
  // Profiles are not exact: what a view saw beside the vessel's foot says nothing of its floor.
  const auto is_seen_inside = [&] (const Eigen::Vector3d& p) {
    return object.views.empty () || object.virtual_view ||
           std::any_of (object.views.begin (), object.views.end (), [&] (const auto& of_object) {
             const auto& [view, T_object_sensor] = of_object;
             const Eigen::Vector3d in_sensor = T_object_sensor.inverse () * p;
             return visibilityOf (in_sensor, *view, pointMargin (*view, in_sensor.z ())) ==
                        PointVisibility::AtSurface &&
                    leadsThroughOpening (shape, p, T_object_sensor.translation (), up, floor_m, near_m);
           });
  };
  const auto ground = std::count_if (
      setting.background.begin (), setting.background.end (), [&] (const OrientedPoint& point) {
        const Eigen::Vector3d p = setting.T_object_world * point.position.cast<double> ();
        return is_at_floor (p, near_m) && is_seen_inside (p);
      });
  const auto floor = std::count_if (object.points ().begin (), object.points ().end (), [&] (const OrientedPoint& p) {
    return is_at_floor (p.position.cast<double> (), floor_m);
  });
  if (ground >= least_ground && ground > floor)
    shape.openFloor ();
  return shape;
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
