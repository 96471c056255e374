// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "range_image.h"

#include "look_at.h"
#include "pcl_cosection/common/directions.h"
#include "pcl_cosection/common/quantile.h"
#include "sensor_noise.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr double max_slope = 1.7321; // tangent of half of 120 degrees
constexpr int finest_px = 1024;      // pixels along the longer side ...
constexpr int coarsest_px = 8;       // ... that are tried
constexpr double coarsening = 1.2;
constexpr double points_per_pixel = 2.5;
constexpr double hidden_sigmas = 6.0; // a point that lies so far behind another one of its pixel is hidden ...
constexpr double hidden_pixels = 3.0; // ... unless a steep surface explains it: in widths of a pixel there
constexpr int directions = 400;
constexpr std::size_t samples = 2000;
constexpr double unsure_share = 0.1; // of the points, may face away from the sensor, or be hidden from it
constexpr double distance_diagonals = 5.0;
constexpr float nothing = std::numeric_limits<float>::infinity ();

/** \brief Points before a camera: slopes x/z, y/z and depth z. */
struct Projection
{
  std::vector<Eigen::Vector3f> points;
  Eigen::AlignedBox2f slopes;
};

/** \brief Nothing if some points are not before the sensor. */
std::optional<Projection>
project (const std::vector<Eigen::Vector3f>& points, const Eigen::Isometry3d& T_sensor_points)
{
  Projection projection;
  for (const Eigen::Vector3f& point : points)
  {
    if (!point.allFinite ())
      continue;
    const Eigen::Vector3d p = T_sensor_points * point.cast<double> ();
    const Eigen::Vector2d slope = p.head<2> () / p.z ();
    if (!(p.z () > 0.0) || !(slope.norm () < max_slope))
      return std::nullopt;
    projection.slopes.extend (slope.cast<float> ());
    projection.points.emplace_back (static_cast<float> (slope.x ()), static_cast<float> (slope.y ()),
                                    static_cast<float> (p.z ()));
  }
  return projection;
}

std::size_t
pixelOf (const PinholeCamera& camera, const Eigen::Vector3f& p)
{
  const auto u = static_cast<int> (std::lround (camera.fx * p.x () + camera.cx));
  const auto v = static_cast<int> (std::lround (camera.fy * p.y () + camera.cy));
  return static_cast<std::size_t> (std::clamp (v, 0, camera.height - 1)) * camera.width +
         std::clamp (u, 0, camera.width - 1);
}

/** \brief A camera for the given slopes with \a longest pixels along the longer side. */
PinholeCamera
cameraFor (const Eigen::AlignedBox2f& slopes, int longest)
{
  const Eigen::Vector2d size = slopes.sizes ().cast<double> ();
  PinholeCamera camera;
  camera.fx = camera.fy = (longest - 1) / std::max (size.maxCoeff (), 1e-9);
  camera.width = static_cast<int> (std::lround (size.x () * camera.fx)) + 1;
  camera.height = static_cast<int> (std::lround (size.y () * camera.fy)) + 1;
  camera.cx = -slopes.min ().x () * camera.fx;
  camera.cy = -slopes.min ().y () * camera.fy;
  return camera;
}

std::size_t
occupiedPixels (const PinholeCamera& camera, const std::vector<Eigen::Vector3f>& points)
{
  std::vector<std::uint8_t> occupied (static_cast<std::size_t> (camera.width) * camera.height, 0);
  for (const Eigen::Vector3f& p : points)
    occupied[pixelOf (camera, p)] = 1;
  return static_cast<std::size_t> (std::count (occupied.begin (), occupied.end (), 1));
}

PinholeCamera
supportedCamera (const Projection& projection)
{
  int longest = finest_px;
  while (longest > coarsest_px &&
         static_cast<double> (projection.points.size ()) <
             points_per_pixel *
                 static_cast<double> (occupiedPixels (cameraFor (projection.slopes, longest), projection.points)))
    longest = static_cast<int> (longest / coarsening);
  return cameraFor (projection.slopes, std::max (longest, coarsest_px));
}

/** \param[in] p slopes and depth */
bool
isHidden (const DepthView& view, const Eigen::Vector3f& p)
{
  const float nearest = view.depth[pixelOf (view.camera, p)];
  return p.z () > nearest + hidden_sigmas * depthNoiseSigma (nearest, view.working_range_m) +
                      hidden_pixels * nearest / view.camera.fx;
}

double
hiddenCount (const DepthView& view, const std::vector<Eigen::Vector3f>& points)
{
  return static_cast<double> (
      std::count_if (points.begin (), points.end (), [&] (const Eigen::Vector3f& p) { return isHidden (view, p); }));
}

/** \param[in] p slopes and depth */
bool
isWithin (const PinholeCamera& camera, const Eigen::Vector3f& p)
{
  const double u = camera.fx * p.x () + camera.cx, v = camera.fy * p.y () + camera.cy;
  return u > -0.5 && v > -0.5 && u < camera.width - 0.5 && v < camera.height - 0.5;
}

/** \brief The nearest point of each pixel; NaN where there is none. */
DepthView
draw (const Projection& projection, const Eigen::Isometry3d& T_points_sensor)
{
  DepthView view;
  view.T_world_sensor = T_points_sensor;
  view.camera = supportedCamera (projection);
  view.depth.assign (static_cast<std::size_t> (view.camera.width) * view.camera.height, nothing);
  for (const Eigen::Vector3f& p : projection.points)
  {
    float& depth = view.depth[pixelOf (view.camera, p)];
    depth = std::min (depth, p.z ());
  }
  std::replace (view.depth.begin (), view.depth.end (), nothing, std::numeric_limits<float>::quiet_NaN ());
  view.working_range_m = workingRange (view.depth);
  return view;
}

/** \brief Slopes and depth of a point in a view; nothing if it is not before it, or beside it. */
std::optional<Eigen::Vector3f>
projectInto (const DepthView& view, const Eigen::Vector3f& point)
{
  const Eigen::Vector3d p = view.T_world_sensor.inverse () * point.cast<double> ();
  if (!(p.z () > 0.0))
    return std::nullopt;
  const Eigen::Vector3f projected (static_cast<float> (p.x () / p.z ()), static_cast<float> (p.y () / p.z ()),
                                   static_cast<float> (p.z ()));
  if (!isWithin (view.camera, projected))
    return std::nullopt;
  return projected;
}

/** \brief How many pixels an object covers, and in how many of them there is something behind it. */
struct Cover
{
  std::size_t pixels = 0, pierced = 0;
};

/** \brief Whether a pixel and those around it have the same value. */
bool
isInner (const PinholeCamera& camera, const std::vector<std::uint32_t>& image, int u, int v)
{
  for (int dv = -1; dv <= 1; ++dv)
    for (int du = -1; du <= 1; ++du)
      if (image[static_cast<std::size_t> (v + dv) * camera.width + u + du] !=
          image[static_cast<std::size_t> (v) * camera.width + u])
        return false;
  return true;
}

void
addCovers (const DepthView& view, const std::vector<Eigen::Vector3f>& points, const std::vector<std::uint32_t>& labels,
           std::map<std::uint32_t, Cover>& covers)
{
  std::vector<std::uint32_t> nearest (view.depth.size (), 0); // label of a pixel
  std::vector<float> depth (view.depth.size (), nothing);
  std::vector<std::pair<std::size_t, std::uint32_t>> hidden; // pixel and label of a point
  for (std::size_t i = 0; i < points.size (); ++i)
    if (const auto p = projectInto (view, points[i]))
    {
      const std::size_t pixel = pixelOf (view.camera, *p);
      if (isHidden (view, *p))
        hidden.emplace_back (pixel, labels[i]);
      else if (p->z () < depth[pixel])
      {
        depth[pixel] = p->z ();
        nearest[pixel] = labels[i];
      }
    }
  std::vector<std::uint8_t> pierced (view.depth.size (), 0);
  for (const auto& [pixel, label] : hidden)
    pierced[pixel] |= label != nearest[pixel];
  for (int v = 1; v + 1 < view.camera.height; ++v)
    for (int u = 1; u + 1 < view.camera.width; ++u)
      if (const std::size_t pixel = static_cast<std::size_t> (v) * view.camera.width + u;
          nearest[pixel] != 0 && isInner (view.camera, nearest, u, v))
      {
        ++covers[nearest[pixel]].pixels;
        covers[nearest[pixel]].pierced += pierced[pixel];
      }
}

} // namespace

bool
RangeImage::hides (const Eigen::Vector3f& point) const
{
  const auto hidesIn = [&] (const DepthView& of) {
    const auto projected = projectInto (of, point);
    return projected && isHidden (of, *projected);
  };
  return hidesIn (view) || std::any_of (others.begin (), others.end (), hidesIn);
}

double
RangeImage::seenThrough (const std::vector<Eigen::Vector3f>& points, const std::vector<std::uint32_t>& labels) const
{
  std::map<std::uint32_t, Cover> covers;
  addCovers (view, points, labels, covers);
  for (const DepthView& other : others)
    addCovers (other, points, labels, covers);
  double most = 0.0;
  for (const auto& [label, cover] : covers)
    if (cover.pixels >= min_points)
      most = std::max (most, static_cast<double> (cover.pierced) / static_cast<double> (cover.pixels));
  return most;
}

std::optional<RangeImage>
drawRangeImage (const std::vector<Eigen::Vector3f>& points, const Eigen::Vector3d& sensor)
{
  Eigen::AlignedBox3d box;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero ();
  for (const Eigen::Vector3f& p : points)
    if (p.allFinite ())
    {
      box.extend (p.cast<double> ());
      direction += (p.cast<double> () - sensor).normalized ();
    }
  if (box.isEmpty () || !sensor.allFinite ())
    return std::nullopt;
  Eigen::Isometry3d T_points_sensor = Eigen::Isometry3d::Identity ();
  std::optional<Projection> projected;
  for (const Eigen::Vector3d& axis :
       {Eigen::Vector3d (box.center () - sensor), direction}) // a sensor in a room may be in their box
    if (!projected && !axis.isZero (0.0))
    {
      T_points_sensor = lookingAlong (sensor, axis);
      projected = project (points, T_points_sensor.inverse ());
    }
  if (!projected)
    return std::nullopt;
  const Projection& projection = *projected;
  if (projection.points.size () < RangeImage::min_points)
    return std::nullopt;

  RangeImage image;
  image.view = draw (projection, T_points_sensor);
  image.hidden_share = hiddenCount (image.view, projection.points) / static_cast<double> (projection.points.size ());
  return image;
}

DepthView
withSurroundings (const DepthView& view)
{
  const int margin_px = std::max (view.camera.width, view.camera.height) / 2;
  DepthView wide = view;
  wide.camera.width += 2 * margin_px;
  wide.camera.height += 2 * margin_px;
  wide.camera.cx += margin_px;
  wide.camera.cy += margin_px;
  wide.depth.assign (static_cast<std::size_t> (wide.camera.width) * wide.camera.height,
                     std::numeric_limits<float>::quiet_NaN ());
  for (int v = 0; v < view.camera.height; ++v)
    std::copy_n (view.depth.begin () + static_cast<std::ptrdiff_t> (v) * view.camera.width, view.camera.width,
                 wide.depth.begin () + static_cast<std::ptrdiff_t> (v + margin_px) * wide.camera.width + margin_px);
  return wide;
}

std::optional<RangeImage>
drawPanorama (const std::vector<Eigen::Vector3f>& points, const Eigen::Vector3d& sensor)
{
  struct Face
  {
    Projection projection;
    Eigen::Isometry3d T_points_sensor;
  };
  std::vector<Face> faces;
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {1.0, -1.0})
      faces.push_back ({{}, lookingAlong (sensor, sign * Eigen::Vector3d::Unit (axis))});
  for (const Eigen::Vector3f& point : points)
  {
    if (!point.allFinite ())
      continue;
    const Eigen::Vector3d d = point.cast<double> () - sensor;
    int axis = 0;
    if (!(d.cwiseAbs ().maxCoeff (&axis) > 0.0))
      continue;
    Face& face = faces[2 * axis + (d[axis] < 0.0 ? 1 : 0)];
    const Eigen::Vector3f p = (face.T_points_sensor.inverse () * point.cast<double> ()).cast<float> ();
    const Eigen::Vector2f slope = p.head<2> () / p.z ();
    face.projection.slopes.extend (slope);
    face.projection.points.emplace_back (slope.x (), slope.y (), p.z ());
  }
  std::stable_sort (faces.begin (), faces.end (), [] (const Face& a, const Face& b) {
    return a.projection.points.size () > b.projection.points.size ();
  });
  RangeImage image;
  double hidden = 0.0, all = 0.0;
  for (const Face& face : faces)
  {
    if (face.projection.points.size () < RangeImage::min_points)
      continue;
    DepthView view = draw (face.projection, face.T_points_sensor);
    hidden += hiddenCount (view, face.projection.points);
    all += static_cast<double> (face.projection.points.size ());
    if (image.view.depth.empty ())
      image.view = std::move (view);
    else
      image.others.push_back (std::move (view));
  }
  if (image.view.depth.empty ())
    return std::nullopt;
  image.hidden_share = hidden / all;
  return image;
}

std::optional<DepthView>
virtualViewpoint (const std::vector<OrientedPoint>& points)
{
  if (points.empty ())
    return std::nullopt;
  const std::size_t step = std::max<std::size_t> (1, points.size () / samples);
  std::vector<float> cosines;
  float best = 0.0f;
  Eigen::Vector3f facing = Eigen::Vector3f::Zero ();
  for (int n = 0; n < directions; ++n)
  {
    const Eigen::Vector3f d = sphereDirection (n, directions);
    cosines.clear ();
    for (std::size_t p = 0; p < points.size (); p += step)
      if (points[p].normal.allFinite ())
        cosines.push_back (d.dot (points[p].normal));
    if (cosines.empty ())
      return std::nullopt;
    if (const float low = trimmedMin (cosines, unsure_share); low > best)
    {
      best = low;
      facing = d;
    }
  }
  if (!(best > 0.0f))
    return std::nullopt;
  Eigen::AlignedBox3d box;
  std::vector<Eigen::Vector3f> positions;
  positions.reserve (points.size ());
  for (const OrientedPoint& p : points)
  {
    positions.push_back (p.position);
    box.extend (p.position.cast<double> ());
  }
  std::optional<RangeImage> image = drawRangeImage (
      positions, box.center () + distance_diagonals * box.diagonal ().norm () * facing.cast<double> ());
  if (!image || image->hidden_share > unsure_share)
    return std::nullopt;
  return std::move (image->view);
}

} // namespace pcl::cosection
