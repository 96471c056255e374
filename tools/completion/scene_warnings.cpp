// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "scene_warnings.h"

#include "pcl_cosection/common/boxes.h"
#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/segmentation/clusters/cluster_segmentation.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <sstream>

using namespace pcl::cosection;

namespace {

constexpr double whole_image_share = 0.5;   ///< of the pixels; an object that was cut out has fewer ...
constexpr std::size_t image_pixels = 70000; ///< ... or is smaller than a camera's image
constexpr std::size_t most_points = 20000;  ///< in which planes are looked for
constexpr double long_object = 5.0;         ///< metres; what is longer is hardly one thing in metres
// Voxels along the second of an object's three extents; with fewer, the volumes of boxes, cans and balls are more than
// a tenth too large.
constexpr double least_across = 8.0;
constexpr double outlier_share = 0.02; ///< of its points, on each side
constexpr double larger_of_two = 2.0;  ///< than the other: one of two is always the larger

/** \brief How far points extend along the axes, without outliers, metres. */
Eigen::Vector3d
extentOf (const std::vector<OrientedPoint>& points)
{
  return trimmedBox<double> (points, outlier_share, [] (const OrientedPoint& p) { return p.position; }).sizes ();
}

/** \brief Whether what is found on a plane has it on most sides, as a thing on a table, and no side of a box beside
 * another one. */
bool
isSurrounded (const std::vector<Eigen::Vector3f>& points, const ObjectSegmentation& found)
{
  constexpr int sides = 8;
  const Eigen::Vector3f up = found.support_planes.front ().head<3> (), u = up.unitOrthogonal (), v = up.cross (u);
  int beyond = 0;
  for (int k = 0; k < sides; ++k)
  {
    const float angle = 2.0f * static_cast<float> (M_PI) * static_cast<float> (k) / sides;
    const Eigen::Vector3f direction = std::cos (angle) * u + std::sin (angle) * v;
    std::vector<float> of_plane, of_thing;
    for (std::size_t p = 0; p < points.size (); ++p)
      (found.labels[p] == 0 ? of_plane : of_thing).push_back (direction.dot (points[p]));
    const float end = trimmedMax (of_thing, outlier_share), width = end - trimmedMin (of_thing, outlier_share);
    beyond += trimmedMax (of_plane, outlier_share) > end + 0.25f * width;
  }
  return 2 * beyond > sides;
}

/** \brief How many things stand on the planes that points without an order show. */
std::size_t
thingsOnPlanes (const std::vector<OrientedPoint>& points)
{
  std::vector<Eigen::Vector3f> some;
  for (std::size_t p = 0; p < points.size (); p += points.size () / most_points + 1)
    some.push_back (points[p].position);
  try
  {
    const ObjectSegmentation found = segmentClusters (some);
    if (found.support_planes.empty () || (found.objects == 1 && !isSurrounded (some, found)))
      return 0;
    return found.objects;
  }
  catch (const DegenerateInput&) // too few points
  {
    return 0;
  }
}

} // namespace

std::optional<std::string>
wholeScene (const LabelledView& view)
{
  if (view.has_labels || view.objects.empty ())
    return std::nullopt;
  const LabelledView::Points& all = view.objects.begin ()->second;
  const std::size_t pixels = view.view ? view.view->depth.size () : 0;
  const bool is_image = view.organized && pixels >= image_pixels &&
                        static_cast<double> (all.readings) > whole_image_share * static_cast<double> (pixels);
  const std::size_t things = view.organized ? 0 : thingsOnPlanes (all.points);
  if (!is_image && things == 0)
    return std::nullopt;
  return "has no field label, so all that it shows is taken as one object; " +
         (things > 1    ? std::to_string (things) + " things in it stand on a plane: "
          : things == 1 ? "a thing in it stands on a plane: "
                        : std::string ("if it shows several: ")) +
         "give --segment to complete each, or labels, or cut one out";
}

std::optional<std::string>
tooLong (std::uint32_t label, const std::vector<OrientedPoint>& points)
{
  const double longest = extentOf (points).maxCoeff ();
  if (longest <= long_object)
    return std::nullopt;
  std::ostringstream text;
  text.precision (3);
  text << "object " << label << " is " << longest
       << " m long: is it one (else give labels), and is its unit the metre (else --scale 0.01 for "
       << "centimetres, 0.001 for millimetres)?";
  return text.str ();
}

std::optional<std::string>
smallBackground (const SceneInput& scene)
{
  if (scene.background.empty ())
    return std::nullopt;
  const double extent_m = extentOf (scene.background).norm ();
  for (const auto& [id, object] : scene.objects)
    if (extent_m <= extentOf (object.points).norm ())
      return "label 0 is the background, and extends no farther than object " + std::to_string (id) +
             ": if labels count the objects from 0, add 1 to them";
  return std::nullopt;
}

std::optional<std::string>
objectLikeBackground (const SceneInput& scene, const std::vector<std::uint32_t>& background_labels)
{
  if (!scene.background.empty () || scene.objects.size () < 2)
    return std::nullopt;
  int largest = 0;
  double extent_m = -1.0;
  for (const auto& [id, object] : scene.objects)
    if (const double other_m = extentOf (object.points).norm (); other_m > extent_m)
    {
      largest = id;
      extent_m = other_m;
    }
  std::vector<OrientedPoint> others;
  for (const auto& [id, object] : scene.objects)
    if (id != largest)
      others.insert (others.end (), object.points.begin (), object.points.end ());
  if (extent_m <= (scene.objects.size () == 2 ? larger_of_two : 1.0) * extentOf (others).norm ())
    return std::nullopt;
  const std::string number = std::to_string (largest);
  if (!background_labels.empty () && background_labels.front () == static_cast<std::uint32_t> (largest))
    return "object " + number + ", which has label 0, extends farther than all others together; if it is the " +
           "background, leave out --background " + number;
  return "object " + number + " extends farther than all others together; if it is the background, give --background " +
         number;
}

std::optional<std::string>
largeVoxels (const SceneInput& scene, double voxel_size_m)
{
  int finest = 0;
  double least_m = least_across * voxel_size_m;
  for (const auto& [id, object] : scene.objects)
  {
    Eigen::Vector3d extent_m = extentOf (object.points);
    std::sort (extent_m.begin (), extent_m.end ());
    if (extent_m[1] >= least_m)
      continue;
    finest = id;
    least_m = extent_m[1];
  }
  if (finest == 0)
    return std::nullopt;
  std::ostringstream text;
  text.precision (2);
  text << "--voxel-size " << voxel_size_m << " m is large for object " << finest << ", which is seen to be "
       << 1000.0 * least_m << " mm across: its volume will be too large (without the option it is chosen)";
  return text.str ();
}

std::optional<std::string>
distantPlanes (const SceneInput& scene)
{
  double least_gap_m = std::numeric_limits<double>::infinity ();
  for (const Eigen::Vector4d& plane : scene.planes)
    for (const auto& [id, object] : scene.objects)
    {
      std::vector<double> distances;
      for (const OrientedPoint& point : object.points)
        distances.push_back (std::abs (plane.head<3> ().dot (point.position.cast<double> ()) + plane[3]) /
                             plane.head<3> ().norm ());
      const double gap_m = quantile (distances, outlier_share);
      if (!object.T_world_object.empty () || gap_m <= extentOf (object.points).maxCoeff ())
        return std::nullopt;
      least_gap_m = std::min (gap_m, least_gap_m);
    }
  if (scene.planes.empty () || scene.objects.empty ())
    return std::nullopt;
  std::ostringstream text;
  text.precision (3);
  text << "--plane is left out: the nearest object is " << least_gap_m
       << " m away, farther than any is long; A, B, C, D are of "
       << "A x + B y + C z + D = 0 in metres, in the world frame: is the sign of D right?";
  return text.str ();
}
