// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "mixed_pixels.h"

#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/view/normals/estimated_normals.h"
#include "pcl_cosection/view/visibility/depth_edges.h"
#include "pcl_cosection/view/visibility/free_space_view.h"
#include "pcl_cosection/view/visibility/visibility.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl::cosection {
namespace {

constexpr int scattered_neighbours = 20;  // of which the farthest ...
constexpr float scattered_factor = 4.0f;  // ... is so much farther than usual: the point shows no surface
constexpr std::size_t least_points = 100; // of an object: as many remain if some are left out, ...
constexpr double most_left_out = 0.3;     // ... which are no larger a share than this
// Share in points that are one per pixel, up to which these are surface that recedes: at most .0036 in 13 things cut
// out of simulated views, and .006 to .02 with the readings that are wrong at their edges.
constexpr double few_trails = 0.005;
constexpr std::size_t most_points = 20000; // of an object: of more, trails are a small share
constexpr int spacing_neighbours = 6;
constexpr float reach_to_spacing = 0.72f; // square root of pi / 6: as many neighbours, a point in each square
constexpr float beside_spacings = 1.25f;  // from a point of an edge in the image
constexpr float behind_spacings = 6.0f;   // a surface of up to 78 degrees to the image falls off less on that way
constexpr float lonely_factor = 3.0f;     // of the usual spacing: trails have fewer points than surfaces
// A share of the usual distance in the image, that of the nearest pixels; means in cells have 0.5 to 0.8.
constexpr float regular = 0.93f;
constexpr float pixels_per_spacing = 1.5f; // of the most dense points
constexpr double most_dense = 0.1;         // share of all points
constexpr float most_pixels = 2048.0f;     // along a side
constexpr float most_pixels_beside = 30.0f;
constexpr float nearest = 1e-4f;  // of the working range, and ...
constexpr float farthest = 1e5f;  // ... of what can be judged
constexpr float steepest = 10.0f; // slope of a ray to the camera's axis

/** \brief Is it before the camera, so that it has a place in the image? */
bool
isBefore (const Eigen::Vector3f& point, float working_range_m)
{
  return point.z () > nearest * working_range_m && point.z () < farthest * working_range_m &&
         point.head<2> ().norm () < steepest * point.z ();
}

/** \brief Are the points one per pixel of an image, so that the nearest one in the image is nowhere much nearer than is
 * usual? */
bool
isImage (const std::vector<Eigen::Vector3f>& points, int threads)
{
  std::vector<Eigen::Vector3f> slopes;
  slopes.reserve (points.size ());
  for (const Eigen::Vector3f& point : points)
    slopes.emplace_back (point.x () / point.z (), point.y () / point.z (), 0.0f);
  std::vector<float> distances = neighbourDistances (slopes, 1, threads);
  const float near = quantile (distances, most_dense);
  return near > regular * quantile (distances, 0.5);
}

/** \brief From which depth on what is seen in a pixel is behind some point beside it. */
class DepthLimit
{
public:
  DepthLimit (const std::vector<Eigen::Vector3f>& points, const std::vector<float>& spacings, double working_range_m)
      : working_range_m_ (working_range_m)
  {
    std::vector<float> angles;
    angles.reserve (points.size ());
    for (std::size_t i = 0; i < points.size (); ++i)
    {
      slopes_.extend (slopeOf (points[i]));
      angles.push_back (spacings[i] / points[i].z ());
    }
    pixel_ = std::max ({quantile (angles, most_dense) / pixels_per_spacing, slopes_.sizes ().maxCoeff () / most_pixels,
                        std::numeric_limits<float>::min ()});
    size_ = (slopes_.sizes () / pixel_).cast<int> ().array () + 1;
    limit_.assign (static_cast<std::size_t> (size_.x ()) * size_.y (), std::numeric_limits<float>::infinity ());
  }

  void add (const Eigen::Vector3f& point, float spacing)
  {
    const float z = point.z ();
    const float behind = z + std::max (behind_spacings * spacing,
                                       static_cast<float> (smallestEdgeStep (z, working_range_m_)));
    const float radius = std::min (most_pixels_beside, beside_spacings * spacing / z / pixel_);
    const Eigen::Array2f centre = place (point);
    const Eigen::Array2i first = (centre - radius).ceil ().cast<int> ().max (0);
    const Eigen::Array2i last = (centre + radius).floor ().cast<int> ().min (size_ - 1);
    for (int v = first.y (); v <= last.y (); ++v)
      for (int u = first.x (); u <= last.x (); ++u)
        if ((Eigen::Array2f (static_cast<float> (u), static_cast<float> (v)) - centre).matrix ().squaredNorm () <=
            radius * radius)
        {
          float& limit = limit_[static_cast<std::size_t> (v) * size_.x () + u];
          limit = std::min (limit, behind);
        }
  }

  bool isBehind (const Eigen::Vector3f& point) const
  {
    const Eigen::Array2i at = place (point).round ().cast<int> ().max (0).min (size_ - 1);
    return point.z () > limit_[static_cast<std::size_t> (at.y ()) * size_.x () + at.x ()];
  }

private:
  static Eigen::Vector2f slopeOf (const Eigen::Vector3f& point) { return point.head<2> () / point.z (); }

  /** \brief In pixels. */
  Eigen::Array2f place (const Eigen::Vector3f& point) const
  {
    return (slopeOf (point) - slopes_.min ()).array () / pixel_;
  }

  double working_range_m_;
  Eigen::AlignedBox2f slopes_;
  float pixel_ = 0.0f;
  Eigen::Array2i size_;
  std::vector<float> limit_;
};

/** \brief Which points are in a trail. \param[in] points in the frame of the camera, before it */
std::vector<bool>
findBehindEdges (const std::vector<Eigen::Vector3f>& points, double working_range_m, int threads)
{
  std::vector<bool> behind (points.size ());
  std::vector<float> spacings = neighbourDistances (points, spacing_neighbours, threads);
  for (float& spacing : spacings)
    spacing *= reach_to_spacing;
  std::vector<float> sorted = spacings;
  const float lonely = lonely_factor * quantile (sorted, 0.5);
  DepthLimit limit (points, spacings, working_range_m);
  for (std::size_t i = 0; i < points.size (); ++i)
    limit.add (points[i], spacings[i]);
  for (std::size_t i = 0; i < points.size (); ++i)
    behind[i] = spacings[i] > lonely && limit.isBehind (points[i]);
  return behind;
}

} // namespace

void
leaveOutMixedPixels (const DepthView& view, SensorCloud& cloud)
{
  const FreeSpaceView seen (view);
  const Eigen::Isometry3d T_view_points = view.T_world_sensor.inverse () * cloud.T_world_sensor;
  for (std::size_t i = 0; i < cloud.positions.size (); ++i)
  {
    if (cloud.labels[i] != 0 || !cloud.positions[i].allFinite ())
      continue;
    const std::optional<Eigen::Array2i> pixel = pixelOf (view.camera,
                                                         T_view_points * cloud.positions[i].cast<double> ());
    if (pixel && seen.atEdge (pixel->x (), pixel->y ()))
      cloud.normals[i].setConstant (nan_value);
  }
}

bool
leaveOutTrails (const PcdViewOptions& options, const DepthView& view, const std::vector<std::size_t>& indices,
                SensorCloud& cloud)
{
  std::vector<std::size_t> usable;
  for (const std::size_t i : indices)
    if (cloud.normals[i].allFinite ())
      usable.push_back (i);
  if (usable.size () <= least_points || usable.size () > most_points)
    return false;
  std::vector<Eigen::Vector3f> points = pick (cloud.positions, usable);
  const Eigen::Isometry3f T_view_points = (view.T_world_sensor.inverse () * cloud.T_world_sensor).cast<float> ();
  for (Eigen::Vector3f& point : points)
    point = T_view_points * point;
  const auto range_m = static_cast<float> (view.working_range_m);
  if (!std::all_of (points.begin (), points.end (), [&] (const auto& p) { return isBefore (p, range_m); }))
    return false; // wide off, numbers say nothing
  const bool are_pixels = isImage (points, options.threads);
  const std::vector<bool> behind = findBehindEdges (points, view.working_range_m, options.threads);
  const auto left_out = static_cast<std::size_t> (std::count (behind.begin (), behind.end (), true));
  const double share = static_cast<double> (left_out) / static_cast<double> (usable.size ());
  if (usable.size () < least_points + left_out || (are_pixels && share <= few_trails) || share > most_left_out)
    return false;
  for (std::size_t k = 0; k < usable.size (); ++k)
    if (behind[k])
      cloud.normals[usable[k]].setConstant (nan_value);
  return are_pixels;
}

void
leaveOutScattered (const PcdViewOptions& options, const Surroundings& objects,
                   const std::vector<std::size_t>& background, SensorCloud& cloud)
{
  const std::vector<float> reach = neighbourDistances (pick (cloud.positions, background), scattered_neighbours,
                                                       options.threads);
  std::vector<bool> scattered (background.size (), true);
  for (const auto& [label, box] : objects)
  {
    std::vector<std::size_t> near;
    std::vector<float> sorted;
    for (std::size_t k = 0; k < background.size (); ++k)
      if (box.contains (cloud.positions[background[k]]))
      {
        near.push_back (k);
        sorted.push_back (reach[k]);
      }
    if (near.empty ())
      continue;
    const float usual = upperMedian (sorted);
    for (const std::size_t k : near)
      if (reach[k] <= scattered_factor * usual)
        scattered[k] = false;
  }
  for (std::size_t k = 0; k < background.size (); ++k)
    if (scattered[k])
      cloud.normals[background[k]].setConstant (nan_value);
}

} // namespace pcl::cosection
