// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "wall_profile.h"

#include "pcl_cosection/common/quantile.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <map>

namespace pcl::cosection {
namespace {

constexpr double sideways = 0.4;        // least component of a wall's normal across the axis
constexpr double level = 0.8;           // least component of a floor's normal along the axis
constexpr double leaning = 0.5;         // component towards the opening: normals with more belong to floor or rim
constexpr std::size_t least_points = 3; // of a side in a band
constexpr std::size_t least_bands = 2;  // in which both sides are seen
constexpr std::size_t least_floor = 10; // points of a floor
constexpr double thickest = 0.35;       // largest wall thickness, of the outer radius
constexpr double even = 0.5;            // tolerance of a band's thickness, of the wall's thickness ...
constexpr double noise_cells = 0.4;     // ... or this, if it is larger
constexpr double even_share = 0.7;      // share of bands within that tolerance
constexpr double end_cells = 2.0;       // sides whose ends are nearer to each other end together
// An inner side that comes nearer to the bottom than both of these belongs to a tube, if no floor was seen.
constexpr double open_wall = 0.5; // of the thickness
constexpr double open_cells = 0.25;
constexpr double narrow = 0.9; // of the opening's radius: with a narrower bottom it is a bowl, as funnels are rare
constexpr double outer_outliers = 0.002; // of the points of a side: outliers that lie lower
constexpr double inner_outliers = 0.01;
constexpr double least_floor_steps = 3.0; // thickness of the floor: a thinner one would vanish
constexpr double least_side = 0.1;        // share of a band's points that a side must have
constexpr double hardly_sideways = 0.2;   // replaces sideways when the thickness of the wall is known
constexpr double narrowest = 0.5;         // least radius of the bottom, of the lowest known radius

/** \brief The points of a band of heights. */
struct Sides
{
  std::vector<double> outer, inner; // radii
  std::vector<double> through;      // inner radii plus the thickness of the wall
  std::size_t points = 0;           // number of all points, on a side or not
  double across = 0.0;              // sum of the normals' components across the axis

  double meanAcross () const
  {
    return across > 0.0 ? across / static_cast<double> (outer.size () + inner.size ()) : 1.0;
  }
};

/** \brief Radius of a point, moved along its tangent to the middle of its band of heights. */
double
radiusInBand (const ProfilePoint& p, double band_m)
{
  const double up = (std::floor (p.position.x () / band_m) + 0.5) * band_m - p.position.x ();
  return p.position.y () - p.normal.x () / p.normal.y () * up;
}

/** \brief The profile of a vessel: a wall of even thickness between an outer and an inner side, round about an axis and
 * open at one end.
 *
 * Views see little of the deep inside of a vessel and nothing of its bottom. The hidden wall is as thick as where both
 * sides were seen, down to the horizontal floor. An unseen floor is as far above the bottom as the wall is thick. */
class VesselProfile : public WallProfile
{
public:
  /** \return whether there is such a profile */
  bool fit (const std::vector<ProfilePoint>& points, double cell_m, const std::optional<StandingPlane>& plane)
  {
    return findWall (points, cell_m) && findBottom (points, cell_m, plane);
  }

  void openFloor () override
  {
    has_floor_ = false;
    floor_m_ = bottom_m_;
  }

  VesselPart partOf (const ProfilePoint& point) const override
  {
    const double along = opening_ * point.normal.x ();
    if (along > level && opening_ * (rim_m_ - point.position.x ()) < noise_m_)
      return VesselPart::Rim;
    if (along < -level && opening_ * (point.position.x () - bottom_m_) < noise_m_)
      return VesselPart::Bottom;
    return point.normal.y () < leaning * along ? VesselPart::Inner : VesselPart::Outer;
  }

  std::vector<ProfilePoint> depths (double step_m) const override
  {
    std::vector<ProfilePoint> points;
    const auto goDown = [&] (double from, double to, double side) {
      const auto radiusAt = [&] (double height) { return side > 0.0 ? outerAt (height) : innerAt (height); };
      const double depth = opening_ * (from - to);
      double slope = 0.0;
      for (double up = 0.0; up < depth; up += step_m / std::hypot (1.0, slope))
      {
        const double height = to + opening_ * up;
        const double radius = radiusAt (height);
        slope = (radiusAt (height + step_m) - radiusAt (height - step_m)) / (2.0 * step_m);
        if (radius > 0.0)
          points.push_back ({{height, radius}, side * Eigen::Vector2d (-slope, 1.0).normalized ()});
      }
    };
    const double floor = opening_ * std::max (opening_ * floor_m_, opening_ * bottom_m_ + least_floor_steps * step_m);
    goDown (lowest_outer_m_, bottom_m_, 1.0);
    goDown (lowest_inner_m_, has_floor_ ? floor : bottom_m_, -1.0);
    if (!has_floor_)
      return points;
    const double floor_radius = innerAt (floor);
    const double bottom_radius = outerAt (bottom_m_);
    for (double radius = 0.0; radius < bottom_radius; radius += step_m)
    {
      if (radius < floor_radius)
        points.push_back ({{floor, radius}, {opening_, 0.0}});
      points.push_back ({{bottom_m_, radius}, {-opening_, 0.0}});
    }
    return points;
  }

  bool holds (const ProfilePoint& point) const override
  {
    const double beyond = point.position.y () - outerAt (point.position.x ());
    if (std::abs (point.normal.y ()) <= sideways && point.normal.x () * opening_ > 0.0)
      return opening_ * (rim_m_ - point.position.x ()) < noise_m_ || beyond < -0.5 * wall_m_;
    if (std::abs (point.normal.y ()) <= sideways)
      return opening_ * (point.position.x () - bottom_m_) < noise_m_;
    return std::abs (point.position.y () - (point.normal.y () < 0.0 ? innerAt (point.position.x ())
                                                                    : outerAt (point.position.x ()))) <= noise_m_;
  }

  double depthInCavity (const Eigen::Vector2d& position) const override
  {
    if (opening_ * (position.x () - rim_m_) > 0.0)
      return 0.0;
    const double over_floor = opening_ * (position.x () - floor_m_);
    const double from_wall = innerAt (position.x ()) - position.y ();
    return over_floor > 0.0 ? std::max (0.0, has_floor_ ? std::min (over_floor, from_wall) : from_wall) : 0.0;
  }

private:
  struct Band // of heights
  {
    double height;
    double outer; // radius
    double wall;  // across the axis
  };

  /** \brief The sides by band, from normals with a component of more than \a across across the axis. */
  std::map<int, Sides> sidesOf (const std::vector<ProfilePoint>& points, double band_m, double across) const
  {
    std::map<int, Sides> sides;
    const auto bandAt = [&] (const Eigen::Vector2d& position) -> Sides& {
      return sides[static_cast<int> (std::floor (position.x () / band_m))];
    };
    for (const ProfilePoint& p : points)
    {
      Sides& band = bandAt (p.position);
      ++band.points;
      if (std::abs (p.normal.y ()) <= across)
        continue;
      (p.normal.y () > 0.0 ? band.outer : band.inner).push_back (radiusInBand (p, band_m));
      band.across += std::abs (p.normal.y ());
      if (p.normal.y () > 0.0)
        continue;
      const ProfilePoint through{p.position - wall_m_ * p.normal, p.normal};
      bandAt (through.position).through.push_back (radiusInBand (through, band_m));
    }
    return sides;
  }

  bool findWall (const std::vector<ProfilePoint>& points, double cell_m)
  {
    std::map<int, Sides> sides = sidesOf (points, cell_m, sideways);
    std::vector<double> thickness, radii;
    for (auto& [number, band] : sides)
      if (band.outer.size () >= least_points && band.inner.size () >= least_points)
      {
        radii.push_back (upperMedian (band.outer));
        thickness.push_back ((radii.back () - upperMedian (band.inner)) * band.meanAcross ());
      }
    if (thickness.size () < least_bands)
      return false;
    wall_m_ = upperMedian (thickness);
    noise_m_ = std::max (even * wall_m_, noise_cells * cell_m);
    const std::ptrdiff_t similar = std::count_if (thickness.begin (), thickness.end (),
                                                  [&] (double t) { return std::abs (t - wall_m_) <= noise_m_; });
    if (!(wall_m_ > 0.0) || wall_m_ > thickest * upperMedian (radii) ||
        static_cast<double> (similar) < even_share * static_cast<double> (thickness.size ()))
      return false;
    findBands (points, cell_m);
    return bands_.size () >= least_bands;
  }

  /** \brief Find the bands, when wall_m_ is known. */
  void findBands (const std::vector<ProfilePoint>& points, double band_m)
  {
    std::map<int, Sides> sides = sidesOf (points, band_m, hardly_sideways);
    for (auto& [number, band] : sides)
    {
      const double height = (number + 0.5) * band_m;
      const double wall_m = wall_m_ / band.meanAcross ();
      const std::size_t least = std::max (least_points,
                                          outlierCount (band.points, least_side)); // fewer: noise of a floor
      const bool has_inner = band.inner.size () >= least;
      const auto add = [&] (double outer, double wall) { bands_.push_back ({height, std::max (0.0, outer), wall}); };
      if (band.outer.size () >= least)
        add (upperMedian (band.outer), wall_m);
      else if (band.through.size () >= least)
      {
        const double outer = upperMedian (band.through);
        add (outer, has_inner ? outer - upperMedian (band.inner) : wall_m);
      }
      else if (has_inner)
        add (upperMedian (band.inner) + wall_m, wall_m);
    }
  }

  bool findBottom (const std::vector<ProfilePoint>& points, double cell_m, const std::optional<StandingPlane>& plane)
  {
    // Both ends of the axis are analysed, as the opening is not known yet.
    struct End
    {
      std::vector<double> outer, inner, floor; // heights, upwards from this end
      double lowest_outer, lowest_inner;
    };
    const auto endBelow = [&] (double up) {
      End end;
      for (const ProfilePoint& p : points)
        if (p.normal.y () > sideways)
          end.outer.push_back (up * p.position.x ());
        else if (p.normal.y () < -sideways)
          end.inner.push_back (up * p.position.x ());
      end.lowest_outer = trimmedMin (end.outer, outer_outliers);
      end.lowest_inner = trimmedMin (end.inner, inner_outliers);
      const Band& last = up > 0.0 ? bands_.front () : bands_.back ();
      const double within = last.outer - last.wall;
      for (const ProfilePoint& p : points)
        if (up * p.normal.x () > level && p.position.y () < within && up * p.position.x () < end.lowest_inner + cell_m)
          end.floor.push_back (up * p.position.x ());
      return end;
    };
    const End first = endBelow (1.0);
    const End second = endBelow (-1.0);
    const double below = first.lowest_inner - first.lowest_outer;
    const double above = second.lowest_inner - second.lowest_outer;
    if (std::max (first.floor.size (), second.floor.size ()) >= least_floor)
      opening_ = first.floor.size () >= second.floor.size () ? 1.0 : -1.0;
    else if (std::max (above, below) > end_cells * cell_m)
      opening_ = above < below ? 1.0 : -1.0;
    else if (plane)
      opening_ = plane->up;
    else
      opening_ = bands_.front ().outer < bands_.back ().outer ? 1.0 : -1.0;
    if ((opening_ > 0.0 ? above : below) > end_cells * cell_m)
      return false;
    if (opening_ < 0.0)
      std::reverse (bands_.begin (), bands_.end ());

    End end = opening_ > 0.0 ? first : second;
    const bool is_standing = plane && plane->up == opening_; // not upside down
    double bottom = is_standing ? plane->up * plane->height : end.lowest_outer;
    const bool has_floor = end.floor.size () >= least_floor;
    const double lower_end = end.lowest_outer - bottom < end_cells * cell_m ? std::max (bottom, end.lowest_outer)
                                                                            : bottom;
    if (!has_floor && end.lowest_inner - lower_end < std::max (open_wall * wall_m_, open_cells * cell_m) &&
        bands_.front ().outer > narrow * bands_.back ().outer)
      return false;
    const double floor = has_floor ? upperMedian (end.floor) : end.lowest_inner;
    if (!is_standing)
      bottom = std::min (bottom, floor - wall_m_);
    bottom_m_ = opening_ * bottom;
    lowest_outer_m_ = opening_ * std::max (bottom, end.lowest_outer);
    lowest_inner_m_ = opening_ * end.lowest_inner;
    rim_m_ = -opening_ * (opening_ > 0.0 ? second : first).lowest_outer;
    floor_m_ = opening_ * (has_floor ? floor : std::min (bottom + wall_m_, end.lowest_inner));
    return true;
  }

  /** \brief Interpolation and extrapolation of the bands. */
  Band bandAt (double height) const
  {
    const auto above = std::find_if (bands_.begin (), bands_.end (),
                                     [&] (const Band& band) { return opening_ * (band.height - height) >= 0.0; });
    if (above == bands_.end ())
      return {height, bands_.back ().outer, bands_.back ().wall};
    if (above != bands_.begin ())
    {
      const Band& low = *std::prev (above);
      const double t = (height - low.height) / (above->height - low.height);
      return {height, (1.0 - t) * low.outer + t * above->outer, (1.0 - t) * low.wall + t * above->wall};
    }
    const Band& lowest = bands_.front ();
    const Band& other = bands_[std::max<std::size_t> (1, bands_.size () / 3)];
    const double straight = lowest.outer +
                            (other.outer - lowest.outer) / (other.height - lowest.height) * (height - lowest.height);
    return {height, std::clamp (straight, narrowest * lowest.outer, lowest.outer), lowest.wall};
  }

  double outerAt (double height) const { return bandAt (height).outer; }

  double innerAt (double height) const
  {
    const Band band = bandAt (height);
    return band.outer - band.wall;
  }

  double opening_ = 1.0;    // 1 or -1: the sense of the axis towards the opening, which is upwards
  std::vector<Band> bands_; // upwards; bands in which at least one side was seen
  double noise_m_ = 0.0; // largest distance of points from a side or below the rim; tolerance of the wall's thickness
  double rim_m_ = 0.0;   // heights
  double bottom_m_ = 0.0;
  double floor_m_ = 0.0;
  bool has_floor_ = true;
  double lowest_outer_m_ = 0.0; // lowest observed heights
  double lowest_inner_m_ = 0.0;
};

} // namespace

std::shared_ptr<WallProfile>
fitVessel (const std::vector<ProfilePoint>& points, double cell_m, const std::optional<StandingPlane>& plane)
{
  const auto vessel = std::make_shared<VesselProfile> ();
  return vessel->fit (points, cell_m, plane) ? vessel : nullptr;
}

} // namespace pcl::cosection
