// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "profiled_shape.h"

#include "axes.h"
#include "flat_faces.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace pcl::cosection {
namespace {

constexpr int even_directions = 162;     // approximate number
constexpr std::size_t max_points = 4000; // an even subset of no more points is used
constexpr double outlier_share = 0.002;  // of the points: outliers beyond a half-space

/** \brief The farthest point along a direction, without outliers. */
class Farthest
{
public:
  explicit Farthest (const std::vector<OrientedPoint>& points)
      : positions_ (static_cast<Eigen::Index> (points.size ()), 3)
      , rank_ (static_cast<std::size_t> (outlier_share * static_cast<double> (points.size ())))
  {
    for (std::size_t n = 0; n < points.size (); ++n)
      positions_.row (static_cast<Eigen::Index> (n)) = points[n].position.cast<double> ().transpose ();
  }

  Eigen::Vector3d along (const Eigen::Vector3d& direction)
  {
    along_ = direction.x () * positions_.col (0) +
             (direction.y () * positions_.col (1) + direction.z () * positions_.col (2));
    // Among equal values the first one is the farther.
    const auto farther = [this] (Eigen::Index a, Eigen::Index b) {
      return along_[a] > along_[b] || (along_[a] == along_[b] && a < b);
    };
    farthest_.clear (); // a heap with the nearest of them in front
    for (Eigen::Index n = 0; n < along_.size (); ++n)
    {
      if (farthest_.size () == rank_ + 1)
      {
        if (along_[n] <= along_[farthest_.front ()])
          continue;
        std::pop_heap (farthest_.begin (), farthest_.end (), farther);
        farthest_.pop_back ();
      }
      farthest_.push_back (n);
      std::push_heap (farthest_.begin (), farthest_.end (), farther);
    }
    return positions_.row (farthest_.front ()).transpose ().matrix ();
  }

private:
  Eigen::ArrayX3d positions_;
  Eigen::ArrayXd along_;
  std::size_t rank_;
  std::vector<Eigen::Index> farthest_;
};

std::shared_ptr<const ProfileSurface>
profileSurfaceOf (const std::vector<OrientedPoint>& points, const std::vector<Eigen::Vector3d>& faces,
                  const std::optional<Eigen::Vector4d>& plane, bool alone)
{
  std::shared_ptr<const ProfileSurface> round = fitSurfaceOfRevolution (points, plane, alone), box;
  if (!round || !round->vessel ())
    box = fitOpenBox (points, faces, plane);
  return box ? box : round;
}

} // namespace

void
ProfiledShape::build (const std::vector<OrientedPoint>& all, const std::optional<Eigen::Vector4d>& plane, bool alone,
                      const Profiles& profiles)
{
  standing_ = plane.has_value ();
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
  if (!profile_)
    return;
  const Eigen::Vector3d center = profile_->center (), axis = profile_->direction ();
  for (const Eigen::Vector3d& normal : faces)
  {
    directions.push_back (normal);
    directions.emplace_back (2.0 * axis.dot (normal) * axis - normal);
  }
  Farthest farthest (points);
  std::optional<Eigen::Vector3d> foot;
  if (up && std::abs (up->dot (axis)) > vertical_cosine && up->dot (farthest.along (-*up)) > -(*plane)[3])
    foot = center - (up->dot (center) + (*plane)[3]) * *up;
  for (const Eigen::Vector3d& n : directions)
  {
    double extent = std::max (n.dot (farthest.along (n)), profile_->extent (n) + n.dot (center));
    if (foot)
      extent = std::max (extent, n.dot (*foot));
    region_.add (n, extent);
  }
}

std::vector<OrientedPoint>
ProfiledShape::hiddenSide (const std::vector<OrientedPoint>& points, double step_m) const
{
  if (!profile_)
    return {};
  std::vector<OrientedPoint> all = profile_->copies (points);
  const std::vector<OrientedPoint> ends = profile_->vessel () ? profile_->depths (step_m)
                                          : standing_         ? std::vector<OrientedPoint> ()
                                                              : profile_->flatEnds ();
  all.insert (all.end (), ends.begin (), ends.end ());
  return all;
}

ProfiledShape
ProfiledShape::withoutFloor () const
{
  ProfiledShape open = *this;
  if (profile_)
    open.profile_ = profile_->withoutFloor ();
  return open;
}

} // namespace pcl::cosection
