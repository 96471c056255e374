// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "separate_parts.h"

#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/view/labels/label_patches.h"
#include "pcl_cosection/view/normals/estimated_normals.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <vector>

namespace pcl::cosection {
namespace {

/** \brief How much may be wrong of what is so far apart. */
struct Limit
{
  double reach; // in largest steps of a surface
  double share; // of the points
};

// Little that is apart, or more that is farther: in 17 real things that were cut out by masks, up to .09 are of what is
// behind them, but of one .13; scanned things that are seen in pieces, such as racks and book ends, have .13 near the
// rest. Mean accuracy of the real ones 12.9 mm without a limit, 7.4 mm with the first one, 6.8 mm with both.
constexpr std::array<Limit, 2> limits = {{{1.0, 0.1}, {2.0, 0.3}}};

constexpr std::size_t least_points = 100; // as many remain
constexpr double least_step_rad = 1e-6;   // of directions: less is the rounding of single precision

/** \brief The outline of points as the sensor sees them: from where to where they reach in rows and columns. */
class Outline
{
public:
  /** \param[in] step_rad from one point to the next */
  explicit Outline (float step_rad) : step_rad_ (step_rad) {}

  void add (const Eigen::Vector3f& point)
  {
    const Eigen::Array2f at = directionOf (point);
    for (int axis = 0; axis < 2; ++axis)
      lines_[axis][cellOf (at[1 - axis])].extend (Eigen::Matrix<float, 1, 1> (at[axis]));
  }

  /** \brief Whether there are points on both sides of one. */
  bool encloses (const Eigen::Vector3f& point) const
  {
    const Eigen::Array2f at = directionOf (point);
    for (int axis = 0; axis < 2; ++axis)
      if (const auto line = lines_[axis].find (cellOf (at[1 - axis]));
          line != lines_[axis].end () && line->second.contains (Eigen::Matrix<float, 1, 1> (at[axis])))
        return true;
    return false;
  }

private:
  static Eigen::Array2f directionOf (const Eigen::Vector3f& point)
  {
    return {std::atan2 (point.x (), point.z ()), std::asin (std::clamp (point.normalized ().y (), -1.0f, 1.0f))};
  }

  int cellOf (float angle) const { return static_cast<int> (std::floor (angle / step_rad_)); }

  float step_rad_;
  std::array<std::map<int, Eigen::AlignedBox<float, 1>>, 2> lines_; // rows and columns
};

/** \brief Which points no surface connects with the largest part, and are beside it; what is seen through its gaps may
 * be of it. \param[in] reach_m from one point to the next of a part */
std::vector<bool>
findBeside (const std::vector<Eigen::Vector3f>& points, double reach_m, float step_rad)
{
  const LabelPatches patches = patchesOf (points, reach_m);
  Outline outline (step_rad);
  for (std::size_t k = 0; k < points.size (); ++k)
    if (patches.patch_of[k] == patches.largest)
      outline.add (points[k]);
  std::vector<std::size_t> enclosed (points.size (), 0); // by patch
  for (std::size_t k = 0; k < points.size (); ++k)
    if (patches.patch_of[k] != no_patch)
      enclosed[patches.patch_of[k]] += outline.encloses (points[k]);
  std::vector<bool> beside (points.size ());
  for (std::size_t k = 0; k < points.size (); ++k)
    if (const std::size_t patch = patches.patch_of[k]; patch != patches.largest)
      beside[k] = patch == no_patch || 2 * enclosed[patch] <= patches.sizes[patch];
  return beside;
}

} // namespace

double
leaveOutSeparateParts (const PcdViewOptions& options, const std::vector<std::size_t>& indices, SensorCloud& cloud)
{
  std::vector<std::size_t> usable;
  std::copy_if (indices.begin (), indices.end (), std::back_inserter (usable),
                [&] (std::size_t i) { return cloud.normals[i].allFinite (); });
  if (usable.size () < 2)
    return 0.0;
  const std::vector<Eigen::Vector3f> points = pick (cloud.positions, usable);
  std::vector<float> spacings_m = neighbourDistances (points, 1, options.threads);
  std::vector<float> ranges_m (points.size ());
  std::transform (points.begin (), points.end (), ranges_m.begin (), [] (const auto& point) { return point.norm (); });
  const double range_m = upperMedian (ranges_m), spacing_m = upperMedian (spacings_m);
  if (!(spacing_m > least_step_rad * range_m))
    return 0.0;
  const double step_m = largestSurfaceStep (range_m, spacing_m, cloud.working_range_m);
  for (const Limit& limit : limits)
  {
    const std::vector<bool> beside = findBeside (points, limit.reach * step_m,
                                                 static_cast<float> (spacing_m / range_m));
    const auto count = static_cast<std::size_t> (std::count (beside.begin (), beside.end (), true));
    const std::size_t without_normal = indices.size () - usable.size (), left = usable.size () - count;
    if (static_cast<double> (count + without_normal) > limit.share * static_cast<double> (indices.size ()) ||
        left < least_points)
      continue;
    for (std::size_t k = 0; k < usable.size (); ++k)
      if (beside[k])
        cloud.normals[usable[k]].setConstant (nan_value);
    return static_cast<double> (count) / static_cast<double> (indices.size ());
  }
  return 0.0;
}

} // namespace pcl::cosection
