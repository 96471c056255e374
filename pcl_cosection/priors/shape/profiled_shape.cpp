// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "profiled_shape.h"

#include "axes.h"
#include "flat_faces.h"
#include "pcl_cosection/common/quantile.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace pcl::cosection {
namespace {

constexpr int even_directions = 162;     // approximate number
constexpr std::size_t max_points = 4000; // an even subset of no more points is used
constexpr double outlier_share = 0.002;  // of the points: outliers beyond a half-space

std::shared_ptr<ProfileSurface>
profileSurfaceOf (const std::vector<OrientedPoint>& points, const std::vector<Eigen::Vector3d>& faces,
                  const std::optional<Eigen::Vector4d>& plane, bool alone)
{
  std::shared_ptr<ProfileSurface> round = fitSurfaceOfRevolution (points, plane, alone), box;
  if (!round || !round->vessel ())
    box = fitOpenBox (points, faces, plane);
  return box ? box : round;
}

} // namespace

void
ProfiledShape::build (const std::vector<OrientedPoint>& all, const std::optional<Eigen::Vector4d>& plane, bool alone,
                      const Profiles& profiles)
{
  std::vector<OrientedPoint> points;
  for (std::size_t p = 0; p < all.size (); p += all.size () / max_points + 1)
    if (all[p].position.allFinite () && all[p].normal.allFinite ())
      points.push_back (all[p]);
  if (points.empty ())
    return;
  std::optional<Eigen::Vector3d> up;
  if (plane)
    up = plane->head<3> ();
  std::vector<Eigen::Vector3d> directions = evenDirections (even_directions, principalAxes (points, up));
  const std::vector<Eigen::Vector3d> faces = faceNormals (points, directions);
  faceted_ = prevail (points, faces);
  profile_ = profileSurfaceOf (points, faces, plane, alone);
  if (profile_ && !(profile_->vessel () ? profiles.hollow : profiles.solid))
    profile_.reset ();
  if (!(wallThickness () > 0.0))
    return;
  const Eigen::Vector3d center = profile_->center (), axis = profile_->direction ();
  for (const Eigen::Vector3d& normal : faces)
  {
    directions.push_back (normal);
    directions.emplace_back (2.0 * axis.dot (normal) * axis - normal);
  }
  const bool is_standing = up && std::abs (up->dot (axis)) > vertical_cosine;
  const Eigen::Vector3d foot = is_standing ? center - (up->dot (center) + (*plane)[3]) * *up : center;
  std::vector<double> along (points.size ());
  for (const Eigen::Vector3d& n : directions)
  {
    std::transform (points.begin (), points.end (), along.begin (),
                    [&] (const OrientedPoint& p) { return n.dot (p.position.cast<double> ()); });
    region_.add (n,
                 std::max ({trimmedMax (along, outlier_share), profile_->extent (n) + n.dot (center), n.dot (foot)}));
  }
}

std::vector<OrientedPoint>
ProfiledShape::hiddenSide (const std::vector<OrientedPoint>& points, double step_m) const
{
  if (!profile_)
    return {};
  std::vector<OrientedPoint> all = profile_->copies (points);
  const std::vector<OrientedPoint> depths = profile_->depths (step_m);
  all.insert (all.end (), depths.begin (), depths.end ());
  return all;
}

} // namespace pcl::cosection
