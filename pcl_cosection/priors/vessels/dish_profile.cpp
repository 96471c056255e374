// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "wall_profile.h"

#include "pcl_cosection/common/quantile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>

namespace pcl::cosection {
namespace {

constexpr double leaning = 0.5;         // least component of a normal of the inside towards the opening
constexpr double level = 0.8;           // component of a floor's or bottom's normal along the axis
constexpr std::size_t least_points = 3; // in a part of the profile
constexpr std::size_t least_parts = 4;
constexpr std::size_t least_floor = 10; // points of a floor
constexpr double floor_share = 0.05;    // of the points: those nearest to the axis are on the floor
constexpr double outliers = 0.01;
constexpr double edge_outliers = 0.1; // of the points near the edge: outliers beyond it
constexpr double least_reach = 0.1;   // of a part's length
constexpr double usual_wall = 0.04;   // wall thickness of crockery, of the radius
constexpr double thickest = 0.065;
constexpr double least_rise = 1.0; // of the wall's thickness: a flatter thing is a disc
constexpr double lid_rise = 0.12;  // of the radius: a thing with a lower but steep border may be a lid
constexpr double steep = 2.0;      // rise of a steep border, of its breadth
constexpr std::array<double, 2> border = {0.2, 0.8}; // part of the rise that counts as border
constexpr double highest_floor = 0.35;  // of the radius: a dish with a higher floor stands on something, or is solid
constexpr double thinnest_cells = 0.25; // least wall thickness, the accuracy of planes
constexpr double noise_cells = 0.4;     // lower limit of noise_m_; at most half of the wall
constexpr double noise_spreads = 3.0;   // noise_m_ in median distances of points from the inside
constexpr double beyond_share = 0.1;    // of all points: those that may be farther from the inside than the wall

/** \brief Distance from a line segment. */
double
distanceFrom (const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p)
{
  const Eigen::Vector2d along = b - a;
  const double length_2 = along.squaredNorm ();
  const double t = length_2 > 0.0 ? std::clamp (along.dot (p - a) / length_2, 0.0, 1.0) : 0.0;
  return (a + t * along - p).norm ();
}

/** \brief The profile of a plate or bowl that showed only its inside, and perhaps the edge: a wall of even thickness
 * below the inside.
 *
 * The wall is as thick as the floor is high above the support plane. If this height is unknown, or larger than crockery
 * is thick, the usual thickness of crockery is assumed. Below its floor a dish is solid down to the support plane. */
class DishProfile : public WallProfile
{
public:
  /** \return whether there is such a profile */
  bool fit (const std::vector<ProfilePoint>& points, double cell_m, const std::optional<StandingPlane>& plane)
  {
    double facing = 0.0;
    for (const ProfilePoint& p : points)
      facing += p.normal.x ();
    up_ = plane ? plane->up : facing < 0.0 ? -1.0 : 1.0;
    if (!findInside (points, 0.5 * cell_m))
      return false;

    std::vector<double> radii, heights;
    for (const ProfilePoint& p : points)
      radii.push_back (p.position.y ());
    const double innermost = quantile (radii, floor_share);
    const double radius = quantile (radii, 1.0 - outliers);
    for (const ProfilePoint& p : points)
      if (p.position.y () <= innermost && up_ * p.normal.x () > level)
        heights.push_back (up_ * p.position.x ());
    if (heights.size () < least_floor)
      return false;
    floor_m_ = quantile (heights, 0.5);
    const double thinnest = thinnest_cells * cell_m;
    wall_m_ = std::max (usual_wall * radius, thinnest);
    bottom_m_ = floor_m_ - wall_m_;
    if (plane)
    {
      const double height = floor_m_ - plane->up * plane->height;
      if (height > highest_floor * radius)
        return false;
      if (height < thickest * radius)
        wall_m_ = std::max (height, thinnest);
      bottom_m_ = plane->up * plane->height;
    }
    std::vector<double> off;
    for (const ProfilePoint& p : points)
      if (partOf (p) == VesselPart::Inner)
        off.push_back (std::abs (heightOver (vertical (p.position))));
    if (off.empty ())
      return false;
    noise_m_ = std::max ({0.5 * wall_m_, noise_cells * cell_m, noise_spreads * quantile (off, 0.5)});
    double rim = floor_m_;
    for (const ProfilePoint& place : inside_)
    {
      rim = std::max (rim, place.position.x ());
      if (place.position.x () < floor_m_ + 0.5 * wall_m_)
        foot_m_ = std::max (foot_m_, (place.position - wall_m_ * place.normal).y ());
    }
    const auto is_beyond = [&] (const ProfilePoint& p) {
      const double over = heightOver (vertical (p.position));
      return over > noise_m_ || over < -wall_m_ - noise_m_;
    };
    const std::ptrdiff_t beyond = std::count_if (points.begin (), points.end (), is_beyond);
    const bool is_lid = !plane && rim - floor_m_ < lid_rise * radius && isGrazing (rim);
    return !is_lid && !(rim - floor_m_ < least_rise * wall_m_) &&
           !(static_cast<double> (beyond) > beyond_share * static_cast<double> (points.size ()));
  }

  VesselPart partOf (const ProfilePoint& point) const override
  {
    const Eigen::Vector2d position = vertical (point.position), normal = vertical (point.normal);
    if (normal.x () < -level && position.x () < bottom_m_ + noise_m_)
      return VesselPart::Bottom;
    if (normal.dot (outwards_) > level && outwards_.dot (position - inside_.back ().position) > -noise_m_)
      return VesselPart::Rim;
    return normal.y () < leaning * normal.x () ? VesselPart::Inner : VesselPart::Outer;
  }

  std::vector<ProfilePoint> depths (double step_m) const override
  {
    std::vector<ProfilePoint> points;
    const auto add = [&] (const Eigen::Vector2d& position, const Eigen::Vector2d& normal) {
      points.push_back ({vertical (position), vertical (normal)});
    };
    for (std::size_t n = 0; n + 1 < inside_.size (); ++n)
    {
      const ProfilePoint& first = inside_[n];
      const ProfilePoint& second = inside_[n + 1];
      if (n == 0)
        for (double radius = 0.0; radius < first.position.y (); radius += step_m)
          add ({first.position.x (), radius}, Eigen::Vector2d::UnitX ());
      const double length = (second.position - first.position).norm ();
      for (double along = 0.0; along < length; along += step_m)
      {
        const double t = along / length;
        const Eigen::Vector2d inside = (1.0 - t) * first.position + t * second.position;
        const Eigen::Vector2d normal = ((1.0 - t) * first.normal + t * second.normal).normalized ();
        add (inside, normal);
        const Eigen::Vector2d outside = inside - wall_m_ * normal;
        if (inside.x () >= floor_m_ + 0.5 * wall_m_ && outside.x () > bottom_m_ && outside.y () > 0.0)
          add (outside, -normal);
      }
    }
    for (double across = 0.0; across < wall_m_; across += step_m)
      add (inside_.back ().position - across * inside_.back ().normal, outwards_);
    for (double radius = 0.0; radius < foot_m_; radius += step_m)
      add ({bottom_m_, radius}, -Eigen::Vector2d::UnitX ());
    for (double height = bottom_m_; height < floor_m_ - wall_m_; height += step_m)
      add ({height, foot_m_}, Eigen::Vector2d::UnitY ());
    return points;
  }

  bool holds (const ProfilePoint& point) const override
  {
    const double over = heightOver (vertical (point.position));
    return over < noise_m_ && (partOf (point) == VesselPart::Inner ? over > -noise_m_ : over > -wall_m_ - noise_m_);
  }

  double depthInCavity (const Eigen::Vector2d& position) const override
  {
    const Eigen::Vector2d place = vertical (position);
    const Eigen::Vector2d& rim = inside_.back ().position;
    return place.x () > rim.x () || place.y () > rim.y () ? 0.0 : std::max (0.0, heightOver (place));
  }

  double depthUnder (const Eigen::Vector2d& position) const override
  {
    const Eigen::Vector2d place = vertical (position);
    const double from_wall = -heightOver (place) - wall_m_;
    return std::max (0.0, std::min (from_wall, place.y () - foot_m_));
  }

private:
  bool findInside (const std::vector<ProfilePoint>& points, double step_m)
  {
    // The inside rises outwards, so it is divided into parts by the sum of radius and height.
    struct Part
    {
      std::vector<double> outwards, upwards; // sum and difference of radius and height: both medians are near a point
      Eigen::Vector2d normal = Eigen::Vector2d::Zero (); // sum
    };
    std::map<int, Part> parts;
    for (const ProfilePoint& p : points)
    {
      const Eigen::Vector2d position = vertical (p.position), normal = vertical (p.normal);
      if (normal.y () >= leaning * normal.x ())
        continue;
      Part& part = parts[static_cast<int> (std::floor ((position.x () + position.y ()) / (M_SQRT2 * step_m)))];
      part.outwards.push_back (position.x () + position.y ());
      part.upwards.push_back (position.x () - position.y ());
      part.normal += normal;
    }
    for (auto& [number, part] : parts)
      if (part.outwards.size () >= least_points && part.normal.norm () > 0.0)
      {
        const double outwards = quantile (part.outwards, 0.5), upwards = quantile (part.upwards, 0.5);
        inside_.push_back ({{0.5 * (outwards + upwards), 0.5 * (outwards - upwards)}, part.normal.normalized ()});
      }
    if (inside_.size () < least_parts)
      return false;

    // The last part extends to the edge.
    const ProfilePoint last = inside_.back ();
    outwards_ = {-last.normal.y (), last.normal.x ()};
    std::vector<double> along;
    for (const ProfilePoint& p : points)
      if (const Eigen::Vector2d q = vertical (p.position) - last.position; q.norm () < 2.0 * step_m)
        along.push_back (outwards_.dot (q));
    if (along.empty ())
      return false;
    const double reach = quantile (along, 1.0 - edge_outliers);
    if (reach > least_reach * step_m)
      inside_.push_back ({last.position + reach * outwards_, last.normal});
    return true;
  }

  /** \brief Whether the border rises more steeply than that of crockery. \param[in] rim height */
  bool isGrazing (double rim) const
  {
    std::array<double, 2> radii{};
    for (std::size_t b = 0; b < border.size (); ++b)
    {
      const double height = floor_m_ + border[b] * (rim - floor_m_);
      const auto above = std::find_if (inside_.begin (), inside_.end (),
                                       [&] (const ProfilePoint& place) { return place.position.x () >= height; });
      radii[b] = above == inside_.end () ? inside_.back ().position.y () : above->position.y ();
      if (above != inside_.begin () && above != inside_.end ())
      {
        const Eigen::Vector2d low = std::prev (above)->position, high = above->position;
        radii[b] -= (high.x () - height) / (high.x () - low.x ()) * (high.y () - low.y ());
      }
    }
    return (border[1] - border[0]) * (rim - floor_m_) > steep * (radii[1] - radii[0]);
  }

  /** \brief Height of a place above the inside, negative below it. */
  double heightOver (const Eigen::Vector2d& position) const
  {
    double nearest = std::numeric_limits<double>::infinity ();
    double sense = 1.0;
    for (std::size_t n = 0; n + 1 < inside_.size (); ++n)
    {
      const double distance = distanceFrom (inside_[n].position, inside_[n + 1].position, position);
      if (distance >= nearest)
        continue;
      nearest = distance;
      sense = (inside_[n].normal + inside_[n + 1].normal).dot (position - inside_[n].position) < 0.0 ? -1.0 : 1.0;
    }
    if (position.y () < inside_.front ().position.y ()) // the floor continues to the axis
    {
      const double over = position.x () - inside_.front ().position.x ();
      return std::abs (over) < nearest ? over : sense * nearest;
    }
    return sense * nearest;
  }

  Eigen::Vector2d vertical (const Eigen::Vector2d& profile) const { return {up_ * profile.x (), profile.y ()}; }

  double up_ = 1.0;                  // 1 or -1: the sense of the axis that is upwards
  std::vector<ProfilePoint> inside_; // from the axis outwards to the edge, heights upwards
  Eigen::Vector2d outwards_;         // direction of the inside at the edge
  double noise_m_ = 0.0;             // largest distance of points from a side
  double floor_m_ = 0.0;             // heights
  double bottom_m_ = 0.0;
  double foot_m_ = 0.0; // radius of the floor
};

} // namespace

std::shared_ptr<WallProfile>
fitDish (const std::vector<ProfilePoint>& points, double cell_m, const std::optional<StandingPlane>& plane)
{
  const auto dish = std::make_shared<DishProfile> ();
  return dish->fit (points, cell_m, plane) ? dish : nullptr;
}

} // namespace pcl::cosection
