// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "steady_scan.h"

#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/view/look_at.h"
#include "pcl_cosection/view/range_image.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr float most_steps = 3.0f;   // between neighbours, of the usual one, and as few
constexpr double least_steady = 0.9; // share of such neighbours
constexpr double most_aslant = 0.5;  // mean cosine of the angle between rows and columns
constexpr double finest_step = 1e-3; // the images are no finer: 2000 pixels along a face
constexpr double face_slope = 1.0;   // a cube's faces reach 45 degrees from their axes

/** \brief Usual step between neighbours that are \a step apart, if most are about so. */
std::optional<float>
steadyStep (const SensorCloud& cloud, std::size_t step, bool along_rows)
{
  std::vector<float> angles;
  for (std::size_t i = 0; i + step < cloud.positions.size (); ++i)
  {
    const Eigen::Vector3f &a = cloud.positions[i], &b = cloud.positions[i + step];
    const bool is_last = along_rows && (i + 1) % static_cast<std::size_t> (cloud.width) == 0;
    if (!is_last && a.allFinite () && b.allFinite ())
      angles.push_back ((a.normalized () - b.normalized ()).norm ());
  }
  if (angles.size () < RangeImage::min_points)
    return std::nullopt;
  const float usual = upperMedian (angles);
  const auto steady = std::count_if (angles.begin (), angles.end (), [usual] (float angle) {
    return angle < most_steps * usual && most_steps * angle > usual;
  });
  if (!(static_cast<double> (steady) > least_steady * static_cast<double> (angles.size ())))
    return std::nullopt;
  return usual;
}

/** \brief Whether columns of an organised cloud cross its rows, as seen from the origin. With another width than that
 * of the sensor, the next row is beside a pixel instead of under it. */
bool
columnsCrossRows (const SensorCloud& cloud)
{
  const auto width = static_cast<std::size_t> (cloud.width);
  double cosines = 0.0, count = 0.0;
  for (std::size_t i = 0; i + width < cloud.positions.size (); ++i)
  {
    const Eigen::Vector3f &p = cloud.positions[i], &right = cloud.positions[i + 1], &under = cloud.positions[i + width];
    if ((i + 1) % width == 0 || !p.allFinite () || !right.allFinite () || !under.allFinite ())
      continue;
    const Eigen::Vector3f along = right.normalized () - p.normalized (), down = under.normalized () - p.normalized ();
    if (const float lengths = along.norm () * down.norm (); lengths > 0.0f)
    {
      cosines += std::abs (along.dot (down)) / lengths;
      ++count;
    }
  }
  return cosines < most_aslant * count;
}

/** \brief The points before a face of the cube, in its frame. */
struct Face
{
  Eigen::Isometry3d T_points_sensor;
  std::vector<Eigen::Vector3f> points;
  Eigen::AlignedBox2d slopes; // x/z and y/z of those within it
  std::size_t within = 0;
};

/** \param[in] margin slope by which what is beside the face is taken, too */
Face
faceAlong (const Eigen::Vector3d& axis, double margin, const SensorCloud& cloud)
{
  Face face;
  face.T_points_sensor = lookingAlong (Eigen::Vector3d::Zero (), axis);
  const Eigen::Matrix3f R_sensor_points = face.T_points_sensor.linear ().transpose ().cast<float> ();
  for (const Eigen::Vector3f& position : cloud.positions)
  {
    const Eigen::Vector3f p = R_sensor_points * position;
    if (!p.allFinite () || !(p.z () > 0.0f))
      continue;
    const Eigen::Vector2d slope = (p.head<2> () / p.z ()).cast<double> ();
    const double farthest = slope.cwiseAbs ().maxCoeff ();
    if (farthest > face_slope + margin)
      continue;
    face.points.push_back (p);
    if (farthest > face_slope)
      continue;
    ++face.within;
    face.slopes.extend (slope);
  }
  return face;
}

DepthView
imageOf (const Face& face, double step, double reach)
{
  DepthView view;
  view.T_world_sensor = face.T_points_sensor;
  PinholeCamera& camera = view.camera;
  camera.fx = camera.fy = 1.0 / step;
  const Eigen::Array2i size = (face.slopes.sizes ().array () / step).ceil ().cast<int> () + 1;
  camera.width = size.x ();
  camera.height = size.y ();
  camera.cx = -face.slopes.min ().x () / step;
  camera.cy = -face.slopes.min ().y () / step;
  view.depth.assign (static_cast<std::size_t> (camera.width) * camera.height, std::numeric_limits<float>::quiet_NaN ());
  std::vector<double> nearest (view.depth.size (), reach);
  for (const Eigen::Vector3f& point : face.points)
  {
    const Eigen::Vector3d p = point.cast<double> ();
    const double range = p.norm ();
    const Eigen::Vector2d at = camera.project (p);
    const double reach_px = reach * camera.fx * (range / p.z ()) * (range / p.z ()); // slopes grow faster than angles
    const Eigen::Array2i first = (at.array () - reach_px).ceil ().cast<int> ().max (0);
    const Eigen::Array2i last = (at.array () + reach_px).floor ().cast<int> ().min (size - 1);
    for (int v = first.y (); v <= last.y (); ++v)
      for (int u = first.x (); u <= last.x (); ++u)
      {
        const Eigen::Vector3d ray = camera.unproject (u, v, 1.0).normalized ();
        const double away = (ray - p / range).norm ();
        const std::size_t pixel = static_cast<std::size_t> (v) * camera.width + u;
        if (away > nearest[pixel])
          continue;
        nearest[pixel] = away;
        view.depth[pixel] = static_cast<float> (range * ray.z ());
      }
  }
  return view;
}

} // namespace

std::optional<ScanSteps>
stepsOfScan (const SensorCloud& cloud)
{
  const auto along_rows = steadyStep (cloud, 1, true);
  const auto along_columns = steadyStep (cloud, static_cast<std::size_t> (cloud.width), false);
  if (!along_rows || !along_columns || !columnsCrossRows (cloud))
    return std::nullopt;
  return ScanSteps{*along_rows, *along_columns};
}

std::vector<DepthView>
imagesOfScan (const SensorCloud& cloud, const ScanSteps& steps)
{
  const double step = std::max<double> (std::min (steps.along_rows, steps.along_columns), finest_step);
  const double reach = 0.5 * std::hypot (steps.along_rows, steps.along_columns);
  std::vector<Face> faces;
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {1.0, -1.0})
      if (Face face = faceAlong (sign * Eigen::Vector3d::Unit (axis), 2.0 * reach, cloud);
          face.within >= RangeImage::min_points)
        faces.push_back (std::move (face));
  std::stable_sort (faces.begin (), faces.end (), [] (const Face& a, const Face& b) { return a.within > b.within; });
  std::vector<DepthView> views;
  for (const Face& face : faces)
    views.push_back (imageOf (face, step, reach));
  return views;
}

} // namespace pcl::cosection
