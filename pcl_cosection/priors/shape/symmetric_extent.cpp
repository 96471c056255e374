// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "symmetric_extent.h"

#include "axes.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr int even_directions = 162;     // approximate number
constexpr std::size_t max_points = 4000; // an even subset of no more points is used
constexpr double outlier_share = 0.002;  // of the points: outliers beyond a half-space
constexpr double tie = 0.97;             // of the largest distance: pairs so far apart count as farthest too
constexpr double rounding = 1e-6;        // relative bound of the rounding errors of a row's values
constexpr double least_flat = 0.5;       // least length of a unit vector's projection onto the plane

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

/** \brief The mean of the two points that are farthest apart, over all such pairs. */
Eigen::Vector3d
middleOfFarthest (const std::vector<Eigen::Vector3d>& ends)
{
  double farthest = 0.0;
  for (const Eigen::Vector3d& a : ends)
    for (const Eigen::Vector3d& b : ends)
      farthest = std::max (farthest, (a - b).norm ());
  Eigen::Vector3d sum = Eigen::Vector3d::Zero ();
  double weights = 0.0;
  for (const Eigen::Vector3d& a : ends)
    for (const Eigen::Vector3d& b : ends)
    {
      const double weight = std::max (0.0, (a - b).norm () - tie * farthest);
      sum += 0.5 * weight * (a + b);
      weights += weight;
    }
  return weights > 0.0 ? Eigen::Vector3d (sum / weights) : ends.front ();
}

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
SymmetricExtent::build (const std::vector<OrientedPoint>& all, const std::optional<Eigen::Vector4d>& plane, bool alone,
                        const Profiles& profiles)
{
  if (all.empty ())
    return;
  std::optional<Eigen::Vector3d> up;
  if (plane)
    up = up_ = plane->head<3> ();
  const Eigen::Matrix3d along = up ? Eigen::Matrix3d (*up * up->transpose ())
                                   : Eigen::Matrix3d (Eigen::Matrix3d::Zero ());
  turn_ = 2.0 * along - Eigen::Matrix3d::Identity ();
  const Eigen::Matrix3d flatten = Eigen::Matrix3d::Identity () - along;
  std::vector<OrientedPoint> points;
  for (std::size_t p = 0; p < all.size (); p += all.size () / max_points + 1)
    if (all[p].position.allFinite () && all[p].normal.allFinite ())
      points.push_back (all[p]);
  if (points.empty ())
    return;
  const Eigen::Matrix3d axes = principalAxes (points, up);
  const std::vector<Eigen::Vector3d> even = evenDirections (even_directions, axes);
  Farthest farthest (points);

  const std::vector<Eigen::Vector3d> faces = faceNormals (points, even);
  profile_ = profileSurfaceOf (points, faces, plane, alone);
  if (profile_ && !(profile_->vessel () ? profiles.hollow : profiles.solid))
    profile_.reset ();
  if (profile_)
  {
    center_ = profile_->center ();
    turn_ = 2.0 * profile_->direction () * profile_->direction ().transpose () - Eigen::Matrix3d::Identity ();
  }
  else
  {
    std::vector<Eigen::Vector3d> ends; // the farthest points of all directions, which include the farthest pair
    for (const Eigen::Vector3d& direction : even)
      if ((flatten * direction).norm () > least_flat)
        ends.push_back (flatten * farthest.along ((flatten * direction).normalized ()));
    center_ = middleOfFarthest (ends);
  }
  std::optional<Eigen::Vector3d> foot;
  if (up && (!profile_ || std::abs (up->dot (profile_->direction ())) > vertical_cosine) &&
      up->dot (farthest.along (-*up)) > -(*plane)[3])
    foot = center_ - (up->dot (center_) + (*plane)[3]) * *up;

  std::vector<Eigen::Vector3d> directions = even;
  for (const Eigen::Vector3d& normal : faces)
  {
    directions.push_back (normal);
    directions.push_back (turn_ * normal);
  }
  for (const Eigen::Vector3d& n : directions)
  {
    // The copy of p is turn (p - center) + center, and turn its own inverse.
    const Eigen::Vector3d turned = turn_ * n;
    const double copied = profile_ ? profile_->extent (n) : turned.dot (farthest.along (turned) - center_);
    double extent = std::max (n.dot (farthest.along (n)), copied + n.dot (center_));
    if (foot)
      extent = std::max (extent, n.dot (*foot));
    half_spaces_.emplace_back (n, extent);
  }
  faceted_ = prevail (points, faces);
  standing_ = up.has_value ();
  copies_alike_ = up || profile_ || isCuboid (points, faces);
  if (up && faceted_ && !profile_)
  {
    walls_ = std::make_shared<const PrismWalls> (points, std::vector<OrientedPoint> (), faces, *plane);
    if (!walls_->showsTop ())
      walls_.reset ();
    walls_with_copies_ = std::make_shared<const PrismWalls> (points, copiesOf (points), faces, *plane);
  }
}

std::vector<OrientedPoint>
SymmetricExtent::hiddenSide (const std::vector<OrientedPoint>& points, double reach) const
{
  if (profile_)
  {
    std::vector<OrientedPoint> all = profile_->copies (points);
    all.insert (all.end (), continuation_.begin (), continuation_.end ());
    const std::vector<OrientedPoint> ends = profile_->vessel () ? profile_->depths (reach)
                                            : standing_         ? std::vector<OrientedPoint> ()
                                                                : profile_->flatEnds ();
    all.insert (all.end (), ends.begin (), ends.end ());
    return all;
  }
  std::vector<OrientedPoint> copies = continuation_;
  if (has_copies_)
    for (const OrientedPoint& copy : copiesOf (points))
      if (beyond (copy.position.cast<double> ()) >= -reach)
        copies.push_back (copy);
  return copies;
}

std::vector<OrientedPoint>
SymmetricExtent::copiesOf (const std::vector<OrientedPoint>& points) const
{
  if (profile_)
    return profile_->onOtherSides (points);
  std::vector<OrientedPoint> copies;
  for (const OrientedPoint& p : points)
    copies.push_back (turnedAbout (center_, turn_, p));
  return copies;
}

void
SymmetricExtent::expect (const std::vector<OrientedPoint>& points)
{
  continuation_.insert (continuation_.end (), points.begin (), points.end ());
  for (auto& [n, s] : half_spaces_)
    for (const OrientedPoint& p : points)
      s = std::max (s, n.dot (p.position.cast<double> ()));
}

SymmetricExtent
SymmetricExtent::continuedBy (const std::vector<OrientedPoint>& points) const
{
  SymmetricExtent more = *this;
  more.expect (points);
  more.expect (copiesOf (points));
  return more;
}

SymmetricExtent
SymmetricExtent::boundedBy (const std::vector<OrientedPoint>& walls, bool below_top) const
{
  SymmetricExtent prism = *this;
  prism.expect (walls);
  prism.has_copies_ = false;
  if (below_top && walls_)
    prism.top_ = walls_->levelTop ();
  return prism;
}

SymmetricExtent
SymmetricExtent::withoutFloor () const
{
  SymmetricExtent open = *this;
  if (profile_)
    open.profile_ = profile_->withoutFloor ();
  return open;
}

double
SymmetricExtent::beyond (const Eigen::Vector3d& x) const
{
  float value = 0.0f;
  beyond (x, Eigen::Vector3d::Zero (), 1, &value);
  return value;
}

void
SymmetricExtent::beyond (const Eigen::Vector3d& first, const Eigen::Vector3d& step, int count, float* values) const
{
  std::fill (values, values + count, half_spaces_.empty () ? 0.0f : -std::numeric_limits<float>::infinity ());
  for (const auto& [n, s] : half_spaces_)
  {
    const auto at_first = static_cast<float> (n.dot (first) - s);
    const auto per_step = static_cast<float> (n.dot (step));
    for (int i = 0; i < count; ++i)
    {
      const float value = at_first + static_cast<float> (i) * per_step;
      values[i] = values[i] < value ? value : values[i];
    }
  }
}

SymmetricExtent
SymmetricExtent::within (const Eigen::AlignedBox3d& box) const
{
  const Eigen::Vector3d middle = box.center ();
  const Eigen::Vector3d half_sizes = 0.5 * box.sizes ();
  double least = -std::numeric_limits<double>::infinity (); // lower bound of the maximum over k in the box
  for (const auto& [n, s] : half_spaces_)
    least = std::max (least, n.dot (middle) - s - n.cwiseAbs ().dot (half_sizes));
  const double tolerance = rounding * (middle.norm () + half_sizes.norm ());
  SymmetricExtent needed;
  for (const auto& [n, s] : half_spaces_)
    if (n.dot (middle) - s + n.cwiseAbs ().dot (half_sizes) >= least - tolerance)
      needed.half_spaces_.emplace_back (n, s);
  return needed;
}

} // namespace pcl::cosection
