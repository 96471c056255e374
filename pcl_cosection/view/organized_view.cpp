// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "sensor_view.h"

#include "camera_resection.h"
#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/io/place_text.h"
#include "pcl_cosection/view/labels/label_growth.h"
#include "pcl_cosection/view/labels/stray_patches.h"
#include "pcl_cosection/view/normals/estimated_normals.h"
#include "pcl_cosection/view/normals/label_window.h"
#include "pcl_cosection/view/normals/thin_normals.h"
#include "pcl_cosection/view/outliers/mixed_pixels.h"

#include <pcl/cosection/surface/normals.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <sstream>

namespace pcl::cosection {
namespace {

constexpr double intrinsics_tolerance_px = 2.0;
constexpr double same_place = 0.05;       // of the distance to the points: two places of one sensor
constexpr double least_reliable = 0.15;   // share of a label's points with a reliable normal ...
constexpr std::size_t least_points = 100; // ... and their number: with fewer, points without an order say more

// Cosine of 89 degrees between normal and ray; beyond, noise decides the side.
constexpr float steepest_cosine = 0.02f;
constexpr float steep_cosine = 0.3f;      // 73 degrees: flatter surfaces have normals from their pixels
constexpr std::size_t least_support = 12; // pixels of the window on the plane that is fitted there
constexpr double trim_sigmas = 3.0;       // those farther from it are not of it
constexpr double thickest = 0.4;     // standard deviations from the plane, and in the image across it: a steep plane is
                                     // thin, mixed pixels are not
constexpr float alike_cosine = 0.9f; // of the angle between two normals: 26 degrees
constexpr int reach_px = 20;         // how far the end of the plane is looked for
constexpr float noise_sigmas = 4.0f; // there readings are on it, but for noise ...
constexpr float slope_error = 0.2f;  // ... and this share of the way
constexpr int most_beyond = 2;       // readings of other labels on it: it goes on there
constexpr double least_width_px = 1.6; // standard deviation across the alike pixels: a band of five has 1.4, of six 1.7

/** \brief Root mean square distance of the points from their pixels under a camera. */
double
reprojectionError (const SensorCloud& cloud, const PinholeCamera& camera)
{
  double sum = 0.0;
  std::size_t count = 0;
  for (int v = 0; v < cloud.height; ++v)
    for (int u = 0; u < cloud.width; ++u)
    {
      const Eigen::Vector3f& p = cloud.positions[static_cast<std::size_t> (v) * cloud.width + u];
      if (!(p.z () > 0.0f))
        continue;
      sum += (camera.project (p.cast<double> ()) - Eigen::Vector2d (u, v)).squaredNorm ();
      ++count;
    }
  return (count == 0 ? std::numeric_limits<double>::infinity () : std::sqrt (sum / static_cast<double> (count)));
}

/** \brief Take the points to the sensor at which the camera was found, and say so. */
void
moveToSensor (const std::string& path, const PcdViewOptions& options, const LocatedCamera& located, SensorCloud& cloud,
              LabelledView& result)
{
  cloud.positions = takeToSensor (located.T_points_sensor.inverse (), cloud.positions);
  double distance = 0.0;
  std::size_t count = 0;
  for (const Eigen::Vector3f& p : cloud.positions)
    if (p.allFinite ())
      distance += (p.z () - distance) / static_cast<double> (++count);
  const Eigen::Vector3d found = located.T_points_sensor.translation ();
  const Eigen::Isometry3d given = cloud.T_world_sensor;
  const auto isNear = [&] (const Eigen::Vector3d& place) { return (found - place).norm () < same_place * distance; };
  // The sensor may be at the origin of the points, and only their axes differ from its own.
  const bool at_origin = isNear (Eigen::Vector3d::Zero ());
  const bool in_world = !at_origin && cloud.has_viewpoint && !cloud.in_world && isNear (given.translation ());
  cloud.T_world_sensor = in_world ? located.T_points_sensor : given * located.T_points_sensor;
  if (in_world)
    result.warnings.push_back (path + ": its VIEWPOINT is where its points were seen from if they are in the world "
                                      "frame: taken as with --world-points");
  else if (at_origin && !options.viewpoint)
    result.warnings.push_back (
        path +
        ": the axes of its points are not x right, y down, z forward; their pixels tell which way the sensor looked");
  else if (!at_origin)
    result.warnings.push_back (
        path + ": its points are not in the frame of their sensor; their pixels tell that it stood at " +
        placeText (cloud.origin + cloud.T_world_sensor.translation ()) + ", which is used instead of " +
        sourceOfViewpoint (options));
}

/** \brief The camera of the cloud, which is taken to its frame. */
std::optional<PinholeCamera>
findCamera (const std::string& path, const PcdViewOptions& options, SensorCloud& cloud, LabelledView& result)
{
  if (const auto fitted = fitPinholeCamera (cloud.positions, cloud.width, cloud.height))
    return fitted;
  std::optional<PinholeCamera> given;
  double error = 0.0;
  if (options.intrinsics)
  {
    const auto& k = *options.intrinsics;
    given = PinholeCamera{cloud.width, cloud.height, k[0], k[1], k[2], k[3]};
    error = reprojectionError (cloud, *given);
    if (error <= intrinsics_tolerance_px)
      return given;
  }
  if (const auto located = locateCamera (cloud.positions, cloud.width, cloud.height))
  {
    moveToSensor (path, options, *located, cloud, result);
    return located->camera;
  }
  if (given)
  {
    std::ostringstream text;
    text.precision (3);
    text << path << ": the points are " << error << " pixels off the given intrinsics; its free space may be wrong";
    result.warnings.push_back (text.str ());
  }
  else if (haveParallelRays (cloud.positions, cloud.width))
    result.warnings.push_back (path + ": its rays are parallel, not those of a camera: its points are taken as if "
                                      "without an order");
  else if (!lookAround (membersOf (cloud), cloud, result))
    result.warnings.push_back (
        path + ": organised, but not the image of a pinhole camera in any frame: its points are taken as if without an "
               "order (give --intrinsics, with --world-points if the points are in the world frame)");
  return given;
}

/** \brief Give points normals as if they had no order, towards the sensor. */
void
addNormalsTowardsSensor (const PcdViewOptions& options, const std::vector<std::size_t>& readings, SensorCloud& cloud)
{
  addNormals (options, readings, cloud);
  for (const std::size_t i : readings)
    if (cloud.normals[i].dot (cloud.positions[i]) > 0.0f)
      cloud.normals[i] = -cloud.normals[i];
}

/** \brief Give labels of which hardly anything has a reliable normal those of points without an order.
 * \return whether there is any */
bool
addMissingNormals (const PcdViewOptions& options, const Members& members, SensorCloud& cloud)
{
  bool any = false;
  for (const auto& [label, readings] : members)
  {
    const auto reliable = static_cast<std::size_t> (std::count_if (
        readings.begin (), readings.end (), [&] (std::size_t i) { return cloud.normals[i].allFinite (); }));
    if (readings.size () < least_points ||
        (reliable >= least_points &&
         static_cast<double> (reliable) >= least_reliable * static_cast<double> (readings.size ())))
      continue;
    any = true;
    addNormalsTowardsSensor (options, readings, cloud);
  }
  return any;
}

/** \brief Cosine of the angle between a normal and the ray from a point to the sensor at the origin; NaN if there is no
 * normal. */
float
cosineToSensor (const Eigen::Vector3f& normal, const Eigen::Vector3f& position)
{
  return -normal.dot (position.normalized ());
}

/** \brief Whether the plane at \a i goes on to where its object ends, with what is behind it far behind. Depth edges
 * that a sensor or a filter has smeared over several pixels are planes along the rays, too, but go on beyond the label
 * or flatten out. */
bool
endsInJump (const SensorCloud& cloud, const Eigen::Vector3f& normal, std::size_t i)
{
  const Eigen::Vector3f& here = cloud.positions[i];
  const float range = here.norm ();
  const float offset = normal.dot (here);
  const Eigen::Vector2f away = (here.z () * normal.head<2> () - normal.z () * here.head<2> ())
                                   .normalized (); // in pixels, to where the plane is farther
  const auto row = static_cast<int> (i / cloud.width);
  const auto column = static_cast<int> (i % cloud.width);
  int beyond = 0;
  for (int k = 1; k <= reach_px; ++k)
  {
    const int u = column + static_cast<int> (std::lround (static_cast<float> (k) * away.x ()));
    const int v = row + static_cast<int> (std::lround (static_cast<float> (k) * away.y ()));
    if (u < 0 || u >= cloud.width || v < 0 || v >= cloud.height)
      return true;
    const std::size_t j = static_cast<std::size_t> (v) * cloud.width + u;
    const Eigen::Vector3f& there = cloud.positions[j];
    if (!there.allFinite ())
      continue;
    const float along = normal.dot (there.normalized ());
    if (!(along < 0.0f)) // above the horizon of the plane
      return false;
    const float expected = offset / along;
    const auto noise = static_cast<float> (noise_sigmas * depthNoiseSigma (range, cloud.working_range_m));
    const float difference = there.norm () - expected;
    if (cloud.labels[j] != cloud.labels[i])
    {
      if (!(std::abs (difference) <= noise + 0.5f * (expected - range) / static_cast<float> (k)))
        return difference > 0.0f;
      if (++beyond == most_beyond)
        return false;
    }
    else if (!(std::abs (difference) <= noise + slope_error * (expected - range)))
      return false;
  }
  return true;
}

/** \brief Normal, towards the sensor, of the plane through what the window around \a i has that is steep or without a
 * normal. NaN if that is no plane, or not steep. */
Eigen::Vector3f
grazingNormal (const SensorCloud& cloud, std::size_t i)
{
  const Eigen::Vector3f none = Eigen::Vector3f::Constant (nan_value);
  std::vector<Eigen::Vector3d> offsets;
  visitLabelWindow (cloud, i, [&] (std::size_t j, int, int) {
    if (!(std::abs (cosineToSensor (cloud.normals[j], cloud.positions[j])) > steep_cosine))
      offsets.push_back ((cloud.positions[j] - cloud.positions[i]).cast<double> ());
  });
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
  Eigen::Matrix3d covariance;
  Eigen::Vector3d plane_normal;
  for (const bool trimmed : {false, true})
  {
    if (offsets.size () < least_support)
      return none;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero ();
    for (const Eigen::Vector3d& offset : offsets)
      mean += offset / static_cast<double> (offsets.size ());
    covariance.setZero ();
    for (const Eigen::Vector3d& offset : offsets)
      covariance += (offset - mean) * (offset - mean).transpose () / static_cast<double> (offsets.size ());
    eigen.computeDirect (covariance);
    plane_normal = eigen.eigenvectors ().col (0);
    if (trimmed)
      break;
    const double limit = trim_sigmas * std::sqrt (std::max (0.0, eigen.eigenvalues ()[0]));
    if (!(std::abs (plane_normal.dot (mean)) <= limit)) // the point itself is of something else
      return none;
    offsets.erase (std::remove_if (offsets.begin (), offsets.end (),
                                   [&] (const Eigen::Vector3d& offset) {
                                     return !(std::abs (plane_normal.dot (offset - mean)) <= limit);
                                   }),
                   offsets.end ());
  }
  const Eigen::Vector3d ray = cloud.positions[i].cast<double> ().normalized ();
  const Eigen::Vector3d across = (plane_normal - ray.dot (plane_normal) * ray).normalized ();
  if (!(eigen.eigenvalues ()[0] <= thickest * thickest * across.dot (covariance * across)))
    return none;
  const Eigen::Vector3f normal = plane_normal.cast<float> ();
  const float cosine = cosineToSensor (normal, cloud.positions[i]);
  if (!(std::abs (cosine) >= steepest_cosine && std::abs (cosine) <= steep_cosine))
    return none;
  const Eigen::Vector3f towards = cosine < 0.0f ? Eigen::Vector3f (-normal) : normal;
  return endsInJump (cloud, towards, i) ? towards : none;
}

/** \brief Whether pixels around \a i with normals like its \a steep one are no line in the image. */
bool
isWide (const SensorCloud& cloud, const std::vector<Eigen::Vector3f>& steep, std::size_t i)
{
  double count = 0.0;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero ();
  Eigen::Matrix2d products = Eigen::Matrix2d::Zero ();
  visitLabelWindow (cloud, i, [&] (std::size_t j, int du, int dv) {
    const Eigen::Vector3f& other = cloud.normals[j].allFinite () ? cloud.normals[j] : steep[j];
    if (!(other.dot (steep[i]) > alike_cosine))
      return;
    const Eigen::Vector2d offset (du, dv);
    count += 1.0;
    mean += offset;
    products += offset * offset.transpose ();
  });
  mean /= count;
  const Eigen::Matrix2d covariance = products / count - mean * mean.transpose ();
  const double half_trace = 0.5 * covariance.trace ();
  const double least = half_trace - std::sqrt (std::max (0.0, half_trace * half_trace - covariance.determinant ()));
  return least >= least_width_px * least_width_px;
}

/** \brief Give points of objects on surfaces that an organised view sees at grazing angles normals, towards the sensor.
 *
 * From row to row they are as far apart as points on the two sides of a depth edge, so that computeOrganizedNormals ()
 * finds none. Here planes are fitted to the pixels around that are steep or have no normal either. Mixed pixels, too,
 * lie on surfaces along the rays; but these are a few pixels wide in the image and scatter, whereas normals are given
 * only where thin planes are several pixels wide and end, where they are farthest, with a jump to what is behind them,
 * unlike edges that were smeared.
 *
 * \param[in] members the readings of each label; those of label 0 are left alone
 * \param[in,out] cloud organised, in the frame of its sensor, with normals, NaN where there is none yet */
void
addGrazingNormals (int threads, const Members& members, SensorCloud& cloud)
{
  const std::vector<std::size_t> candidates = objectReadingsWithoutNormals (members, cloud);
  const auto count = static_cast<int> (candidates.size ());
  std::vector<Eigen::Vector3f> steep (cloud.positions.size (), Eigen::Vector3f::Constant (nan_value));
  parallelFor (0, count, threads, [&] (int k) { steep[candidates[k]] = grazingNormal (cloud, candidates[k]); });
  std::vector<char> wide (candidates.size ());
  parallelFor (0, count, threads,
               [&] (int k) { wide[k] = steep[candidates[k]].allFinite () && isWide (cloud, steep, candidates[k]); });
  for (std::size_t k = 0; k < candidates.size (); ++k)
    if (wide[k])
      cloud.normals[candidates[k]] = steep[candidates[k]];
}

/** \brief Labels that end within their objects, or reach beyond them, are made to fit. */
void
mendLabels (const std::string& path, const PinholeCamera& camera, SensorCloud& cloud, LabelledView& result)
{
  const auto warn = [&] (double share, std::uint32_t label, const std::string& what) {
    result.warnings.push_back (path + ": " + percentText (share) + " of the points of label " + std::to_string (label) +
                               ' ' + what);
  };
  const std::map<std::uint32_t, double> added = growLabels (camera, membersOf (cloud), cloud);
  const std::map<std::uint32_t, double> moved = relabelStrayPatches (camera, membersOf (cloud), cloud);
  for (const auto& [label, share] : added)
    if (const auto away = moved.find (label);
        share - (away != moved.end () ? away->second : 0.0) > much_elsewhere) // what is moved may have grown, too
      warn (share, label, "were around it, without a label, on the same surface: the label may be too small");
  for (const auto& [label, share] : moved)
    if (share > much_elsewhere)
      warn (share, label,
            "are on other surfaces behind or before it, and count as part of those: the label may be shifted, or too "
            "large");
}

} // namespace

void
completeOrganized (const std::string& path, const PcdViewOptions& options, SensorCloud& cloud, LabelledView& result)
{
  const auto camera = findCamera (path, options, cloud, result);
  if (!camera && !result.view) // then neighbours in rows need not be neighbours, nor the sensor at the origin
    return completeUnorganized (path, options, cloud, result);
  if (camera)
    result.view = depthImage (*camera, cloud.positions, cloud.T_world_sensor);
  setWorkingRange (membersOf (cloud), cloud, result);
  if (camera && options.labels.empty ()) // those that are given were found in these readings, and end where they do
    mendLabels (path, *camera, cloud, result);
  OrganizedNormalsOptions normal_options;
  normal_options.radius_m *= cloud.working_range_m;
  normal_options.working_range_m = cloud.working_range_m;
  normal_options.threads = options.threads;
  cloud.normals = computeOrganizedNormals (cloud.positions, cloud.width, cloud.height, cloud.labels, normal_options);
  const Members members = membersOf (cloud);
  if (addMissingNormals (options, members, cloud) && result.view)
    leaveOutMixedPixels (*result.view, cloud);
  if (camera)
  {
    addGrazingNormals (options.threads, members, cloud);
    addThinNormals (options.threads, *camera, members, cloud);
  }
  else // rows of a scan are so far apart that most sides of its objects look like edges
    for (const auto& [label, readings] : members)
      if (label != 0)
        addNormalsTowardsSensor (options, readings, cloud);
}

} // namespace pcl::cosection
