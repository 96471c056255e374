// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "cloud_segmentation.h"

#include "cluster_segmentation.h"
#include "pcl_cosection/view/range_image.h"
#include "pcl_cosection/view/visibility/visibility.h"
#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <sstream>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr std::ptrdiff_t worth_saying = 100; // points, as many as an object needs
constexpr double least_dense = 0.8; // share of the pixels with a point that have one beside and one below them, too

/** \brief Which point of an unorganised cloud a sensor at the origin saw in each pixel of an image. */
struct PointsOfPixels
{
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max ();

  RangeImage image;
  std::vector<std::size_t> pixel_of; ///< a point; none: not in the image, or hidden
  std::vector<std::size_t> nearest;  ///< point of a pixel; none: there is none

  /** \brief Whether neighbours of a pixel mostly have points, so that surfaces can be followed from pixel to pixel. A
   * scanner's lines may be too far apart. */
  bool isDense () const
  {
    const auto width = static_cast<std::size_t> (image.view.camera.width);
    std::size_t with_point = 0, dense = 0;
    for (std::size_t p = 0; p + width < nearest.size (); ++p)
      if (nearest[p] != none)
      {
        ++with_point;
        dense += nearest[p + 1] != none && nearest[p + width] != none;
      }
    return static_cast<double> (dense) > least_dense * static_cast<double> (with_point);
  }
};

std::optional<PointsOfPixels>
pointsOfPixels (const std::vector<Eigen::Vector3f>& points)
{
  std::optional<RangeImage> image = drawRangeImage (points, Eigen::Vector3d::Zero ());
  if (!image)
    return std::nullopt;
  PointsOfPixels result{std::move (*image), std::vector<std::size_t> (points.size (), PointsOfPixels::none), {}};
  const DepthView& view = result.image.view;
  result.nearest.assign (view.depth.size (), PointsOfPixels::none);
  for (std::size_t i = 0; i < points.size (); ++i)
  {
    if (!points[i].allFinite () || result.image.hides (points[i]))
      continue;
    const auto pixel = pixelOf (view.camera, view.T_world_sensor.inverse () * points[i].cast<double> ());
    if (!pixel)
      continue;
    const auto p = static_cast<std::size_t> (pixel->y ()) * view.camera.width + static_cast<std::size_t> (pixel->x ());
    result.pixel_of[i] = p;
    if (std::size_t& n = result.nearest[p];
        n == PointsOfPixels::none || points[i].squaredNorm () < points[n].squaredNorm ())
      n = i;
  }
  return result;
}

/** \brief Segments what a sensor at the origin saw as an image; nothing if that does not show surfaces and planes. */
std::optional<ObjectSegmentation>
segmentAsImage (const std::vector<Eigen::Vector3f>& points, const ObjectSegmentationOptions& options)
{
  const std::optional<PointsOfPixels> seen = pointsOfPixels (points);
  if (!seen || !seen->isDense ())
    return std::nullopt;
  const DepthView& view = seen->image.view;
  const Eigen::Isometry3f T_view_points = view.T_world_sensor.inverse ().cast<float> ();
  std::vector<Eigen::Vector3f> pixels (view.depth.size (),
                                       Eigen::Vector3f::Constant (std::numeric_limits<float>::quiet_NaN ()));
  for (std::size_t p = 0; p < pixels.size (); ++p)
    if (seen->nearest[p] != PointsOfPixels::none)
      pixels[p] = T_view_points * points[seen->nearest[p]];
  ObjectSegmentation of_pixels;
  try
  {
    of_pixels = segmentObjects (pixels, view.camera.width, view.camera.height, options);
  }
  catch (const DegenerateInput&)
  {
    return std::nullopt;
  }
  ObjectSegmentation result;
  result.objects = of_pixels.objects;
  result.labels.assign (points.size (), 0);
  result.too_long.assign (points.size (), 0);
  for (std::size_t i = 0; i < points.size (); ++i)
    if (const std::size_t p = seen->pixel_of[i]; p != PointsOfPixels::none)
    {
      result.labels[i] = of_pixels.labels[p];
      result.too_long[i] = of_pixels.too_long[p];
    }
  for (Eigen::Vector4f plane : of_pixels.support_planes)
  {
    plane.head<3> () = T_view_points.linear ().transpose () * plane.head<3> (); // the sensor is at both origins
    result.support_planes.push_back (plane);
  }
  return result;
}

} // namespace

ObjectSegmentation
segmentCloud (const OrganizedCloud& cloud, const ObjectSegmentationOptions& options)
{
  if (cloud.height > 1)
    return segmentObjects (cloud.points, cloud.width, cloud.height, options);
  if (cloud.seen_from_origin)
    if (auto found = segmentAsImage (cloud.points, options))
      return std::move (*found);
  return segmentClusters (cloud.points, options);
}

std::vector<std::string>
warningsOf (const ObjectSegmentation& found, const ObjectSegmentationOptions& options)
{
  std::vector<std::string> warnings;
  if (found.support_planes.empty ())
    warnings.emplace_back ("shows no plane on which objects stand; each group of points is taken as one");
  if (const auto points = std::count (found.too_long.begin (), found.too_long.end (), 1); points >= worth_saying)
  {
    std::ostringstream text;
    text << points << " points are left out, of what is longer than " << options.max_object_size_m
         << " m, as furniture is; if it is an object, give --max-object-size";
    warnings.push_back (text.str ());
  }
  return warnings;
}

} // namespace pcl::cosection
