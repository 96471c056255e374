// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/volume/tsdf_raycast.h>

#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/volume/mesh_distance/sign_bricks.h"
#include "pcl_cosection/volume/pixel_region.h"
#include "pcl_cosection/volume/rigid_motion.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

namespace pcl::cosection {
namespace {

constexpr float no_depth = std::numeric_limits<float>::quiet_NaN ();

void
checkBody (const RaycastBody& body)
{
  if (!body.volume)
    throw InvalidArgument ("ray casting: a body has no volume");
  if (body.id == RaycastImage::nothing)
    throw InvalidArgument ("ray casting: the id 65535 stands for nothing");
  if (!isRigidMotion (body.T_grid_sensor))
    throw InvalidArgument ("ray casting: the sensor's pose must be a finite rigid motion");
  if (body.foreground_only && !body.volume->options ().foreground)
    throw InvalidArgument ("ray casting: the volume was made without foreground counts");
}

/** \brief The camera of every \a stride-th pixel. */
PinholeCamera
sparseCamera (const PinholeCamera& camera, int stride)
{
  return {(camera.width - 1) / stride + 1,
          (camera.height - 1) / stride + 1,
          camera.fx / stride,
          camera.fy / stride,
          camera.cx / stride,
          camera.cy / stride};
}

/** \brief origin + t direction for 0 <= t <= end; voxel coordinates, within the voxels' box whatever is rounded. */
struct GridRay
{
  std::array<float, 3> origin;
  std::array<float, 3> direction;
  float end;
  float step; ///< for which the coordinate that changes most changes by one

  std::array<float, 3> at (float t) const
  {
    return {origin[0] + t * direction[0], origin[1] + t * direction[1], origin[2] + t * direction[2]};
  }
};

/** \brief Finds surfaces along rays. \a field must have two voxels along each axis at least. */
class RayMarch
{
public:
  using Point = std::array<float, 3>; // voxel coordinates

  /** \brief How far rays must stay away from the faces of the box. */
  static double margin (const VoxelGrid& grid)
  {
    constexpr double rounding = 1e-6; // of a coordinate of a ray
    return rounding * grid.dims.maxCoeff () + 1e-4;
  }

  RayMarch (const SignedDistanceField& field, const SignBricks& bricks)
      : values_ (field.values.data ())
      , bricks_ (bricks)
      , row_ (field.grid.dims.x ())
      , slice_ (row_ * field.grid.dims.y ())
  {}

  /** \brief Where the field first passes from positive values to others, if accept (t) says so; NaN: nowhere.
   *
   * Bricks at the distance n > 1 are passed n - 1 at once. At the distance 1 a step leads no farther than a voxel into
   * one with both signs, from where one step back is looked at, too. A step that cuts off a brick's corner misses no
   * surface: what is before the corner and what is behind it share the voxels at the corner, so that both have the same
   * sign. */
  template <typename Accept> float firstSurface (const GridRay& ray, Accept&& accept) const
  {
    bool known = false;   // whether before is the value at t_before
    bool refused = false; // the ray is behind a surface that was not accepted
    float t_before = 0.0f;
    float before = none;
    float t = 0.0f;
    while (true)
    {
      const Point p = ray.at (t);
      const int distance = bricks_.distanceAt (cell (p[0]), cell (p[1]), cell (p[2]));
      if (distance == 0 || known) // the first sample behind bricks with both signs belongs to them
      {
        if (!known)
          before = sample (ray.at (t_before = std::max (0.0f, t - ray.step)));
        const float value = sample (p);
        if (before > 0.0f && value <= 0.0f)
        {
          const float surface = refine (ray, t_before, before, t, value);
          if (!std::isnan (surface) && accept (surface))
            return surface;
          refused = true;
        }
        else if (before <= 0.0f && value > 0.0f)
        {
          if (!refused)
            return none; // out of the back of something
          refused = false;
        }
        t_before = t;
        before = value;
        known = (distance == 0);
      }
      if (t >= ray.end)
        return none;
      const int voxels = (distance > 1 ? (distance - 1) * SignBricks::edge : 1);
      t = std::min (t + static_cast<float> (voxels) * ray.step, ray.end);
    }
  }

  /** \brief Trilinear, within the voxels' box without its far faces; NaN next to an unknown voxel. */
  float sample (const Point& p) const
  {
    const std::ptrdiff_t i = cell (p[0]);
    const std::ptrdiff_t j = cell (p[1]);
    const std::ptrdiff_t k = cell (p[2]);
    const float* c = values_ + (k * slice_ + j * row_ + i);
    const float fx = p[0] - static_cast<float> (i);
    const float fy = p[1] - static_cast<float> (j);
    const float fz = p[2] - static_cast<float> (k);
    const float near = mix (mix (c[0], c[1], fx), mix (c[row_], c[row_ + 1], fx), fy);
    c += slice_;
    const float far = mix (mix (c[0], c[1], fx), mix (c[row_], c[row_ + 1], fx), fy);
    return mix (near, far, fz);
  }

private:
  static constexpr float none = std::numeric_limits<float>::quiet_NaN ();

  static float mix (float a, float b, float t) { return a + t * (b - a); }

  static std::ptrdiff_t cell (float x) { return static_cast<std::ptrdiff_t> (x); }

  /** \brief Zero between \a a, where the field is positive, and \a b; NaN: something is unknown between. */
  float refine (const GridRay& ray, float a, float at_a, float b, float at_b) const
  {
    const float t = a + (b - a) * (at_a / (at_a - at_b));
    const float at_t = sample (ray.at (t));
    if (at_t > 0.0f)
      return t + (b - t) * (at_t / (at_t - at_b));
    return a + (t - a) * (at_a / (at_a - at_t)); // NaN if at_t is
  }

  const float* values_;
  const SignBricks& bricks_;
  std::ptrdiff_t row_;
  std::ptrdiff_t slice_;
};

/** \brief The rays of a camera through a box in a grid. */
class GridRays
{
public:
  /** \param[in] box corners, voxel coordinates */
  GridRays (const VoxelGrid& grid, const std::array<Eigen::Vector3d, 2>& box, const PinholeCamera& camera,
            const Eigen::Isometry3d& T_grid_sensor)
      : origin_ (grid.toVoxel (T_grid_sensor.translation ()))
  {
    const double margin = RayMarch::margin (grid);
    low_ = (box[0].array ().max (margin)).matrix () - origin_;
    high_ = (box[1].array ().min (grid.dims.cast<double> ().array () - 1.0 - margin)).matrix () - origin_;
    Eigen::Matrix3d ray_of_pixel;
    ray_of_pixel << 1.0 / camera.fx, 0.0, -camera.cx / camera.fx, 0.0, 1.0 / camera.fy, -camera.cy / camera.fy, 0.0,
        0.0, 1.0;
    directions_ = T_grid_sensor.linear () * ray_of_pixel / grid.voxel_size_m;
  }

  /** \brief The part of a ray in the box, up to a depth; \a begin_m is the depth where it begins, and t that from
   * there. */
  std::optional<GridRay> through (int u, int v, double max_depth_m, double& begin_m) const
  {
    const Eigen::Vector3d direction = directions_ * Eigen::Vector3d (u, v, 1.0);
    const Eigen::Vector3d inverse = direction.cwiseInverse ();
    double begin = 0.0;
    double end = max_depth_m;
    for (int axis = 0; axis < 3; ++axis)
    {
      if (direction[axis] == 0.0)
      {
        if (!(low_[axis] <= 0.0 && high_[axis] >= 0.0))
          return std::nullopt;
        continue;
      }
      const double a = low_[axis] * inverse[axis];
      const double b = high_[axis] * inverse[axis];
      begin = std::max (begin, std::min (a, b));
      end = std::min (end, std::max (a, b));
    }
    if (!(begin < end))
      return std::nullopt;
    GridRay ray;
    for (int axis = 0; axis < 3; ++axis)
    {
      ray.origin[axis] = static_cast<float> (origin_[axis] + begin * direction[axis]);
      ray.direction[axis] = static_cast<float> (direction[axis]);
    }
    ray.end = static_cast<float> (end - begin);
    ray.step = static_cast<float> (inverse.cwiseAbs ().minCoeff ());
    begin_m = begin;
    return ray;
  }

private:
  Eigen::Vector3d origin_; // of all rays, voxels
  Eigen::Vector3d low_;    // corners of the box from there
  Eigen::Vector3d high_;
  Eigen::Matrix3d directions_; // voxels per metre of depth of (column, row, 1)
};

/** \brief Puts one body into an image. */
class BodyCaster
{
public:
  BodyCaster (const RaycastBody& body, const RaycastOptions& options, RaycastImage& image)
      : body_ (body)
      , options_ (options)
      , volume_ (*body.volume)
      , bricks_ (volume_.field (), options.threads)
      , march_ (volume_.field (), bricks_)
      , rays_ (volume_.grid (), bricks_.surfaceBox (), image.camera, body.T_grid_sensor)
      , last_ (volume_.grid ().dims.cast<float> ().array () - 1.0f -
               static_cast<float> (RayMarch::margin (volume_.grid ())))
      , image_ (image)
  {}

  /** \brief The pixels that may see a surface. */
  PixelRegion region () const
  {
    const auto box = bricks_.surfaceBox ();
    VoxelGrid part = volume_.grid ();
    part.dims = (box[1] - box[0]).array ().round ().cast<int> () + 1; // corners are voxels
    part.origin_m += part.voxel_size_m * box[0];
    if (part.dims.minCoeff () < 2)
      return {};
    return projectedRegion (part, image_.camera, body_.T_grid_sensor);
  }

  void castRow (int v, int left, int right) const
  {
    const auto accept_all = [] (float) { return true; };
    for (int u = left; u < right; ++u)
    {
      float& depth = image_.depth.at (u, v);
      const double max_depth_m = (std::isnan (depth) ? options_.max_depth_m : depth);
      double begin_m = 0.0;
      const auto ray = rays_.through (u, v, max_depth_m, begin_m);
      if (!ray)
        continue;
      const float t = (body_.foreground_only
                           ? march_.firstSurface (*ray, [&] (float at) { return isForeground (*ray, at); })
                           : march_.firstSurface (*ray, accept_all));
      const auto z = static_cast<float> (begin_m + t);
      if (!(z > 0.0f && z <= max_depth_m) || z == depth)
        continue;
      depth = z;
      image_.ids.at (u, v) = body_.id;
      if (options_.normals)
        image_.normals.at (u, v) = normal (*ray, t);
      if (options_.weights)
        image_.weights.at (u, v) = volume_.weight (position (*ray, t));
    }
  }

private:
  /** \brief Metres, the grid's frame. */
  Eigen::Vector3d position (const GridRay& ray, float t) const
  {
    const RayMarch::Point p = ray.at (t);
    return volume_.grid ().origin_m + volume_.grid ().voxel_size_m * Eigen::Vector3d (p[0], p[1], p[2]);
  }

  bool isForeground (const GridRay& ray, float t) const
  {
    const auto probability = volume_.foregroundProbability (position (ray, t));
    return probability && *probability > 0.5f;
  }

  /** \brief By differences over two voxels, where all are known, else within the cell. */
  Eigen::Vector3f normal (const GridRay& ray, float t) const
  {
    const RayMarch::Point p = ray.at (t);
    Eigen::Vector3f gradient;
    for (int axis = 0; axis < 3; ++axis)
    {
      RayMarch::Point before = p;
      RayMarch::Point behind = p;
      before[axis] = std::max (0.0f, p[axis] - 1.0f);
      behind[axis] = std::min (p[axis] + 1.0f, last_[axis]);
      gradient[axis] = (march_.sample (behind) - march_.sample (before)) / (behind[axis] - before[axis]);
    }
    if (!gradient.allFinite ())
      if (const auto cell = volume_.sample (position (ray, t)))
        gradient = cell->gradient ().cast<float> ();
    gradient = (body_.T_grid_sensor.linear ().transpose ().cast<float> () * gradient).eval ();
    const float norm = gradient.norm ();
    return norm > 0.0f ? Eigen::Vector3f (gradient / norm) : Eigen::Vector3f::Zero (); // NaN: zero, too
  }

  const RaycastBody& body_;
  const RaycastOptions& options_;
  const TsdfVolume& volume_;
  SignBricks bricks_;
  RayMarch march_;
  GridRays rays_;
  Eigen::Array3f last_; // where a cell is around, voxels
  RaycastImage& image_;
};

void
cast (const RaycastBody& body, const RaycastOptions& options, RaycastImage& image)
{
  if (body.volume->grid ().dims.minCoeff () < 2) // no cell
    return;
  const BodyCaster caster (body, options, image);
  const PixelRegion region = caster.region ();
  const int rows = region.bottom - region.top;
  const int columns = region.right - region.left;
  if (rows <= 0 || columns <= 0)
    return;
  const int threads = std::min (rows, threadsForVoxels (options.threads, static_cast<std::size_t> (rows) * columns));
  parallelFor (0, threads, threads, [&] (int thread) { // rows by turns, so that each thread has long and short rays
    for (int v = region.top + thread; v < region.bottom; v += threads)
      caster.castRow (v, region.left, region.right);
  });
}

} // namespace

void
RaycastOptions::validate () const
{
  if (stride < 1)
    throw InvalidArgument ("stride must be positive");
  if (!(max_depth_m > 0.0))
    throw InvalidArgument ("max_depth_m must be positive");
  if (threads < 0)
    throw InvalidArgument ("threads must not be negative");
}

RaycastImage
raycast (const std::vector<RaycastBody>& bodies, const PinholeCamera& camera, const RaycastOptions& options)
{
  options.validate ();
  camera.validate ();
  for (const auto& body : bodies)
    checkBody (body);
  RaycastImage image;
  image.camera = sparseCamera (camera, options.stride);
  const int width = image.camera.width;
  const int height = image.camera.height;
  image.depth = Image<float> (width, height, no_depth);
  image.ids = Image<std::uint16_t> (width, height, RaycastImage::nothing);
  if (options.normals)
    image.normals = Image<Eigen::Vector3f> (width, height, Eigen::Vector3f::Zero ());
  if (options.weights)
    image.weights = Image<float> (width, height, 0.0f);
  for (const auto& body : bodies)
    cast (body, options, image);
  return image;
}

RaycastImage
raycast (const TsdfVolume& volume, const PinholeCamera& camera, const Eigen::Isometry3d& T_grid_sensor,
         const RaycastOptions& options)
{
  return raycast ({RaycastBody{&volume, T_grid_sensor}}, camera, options);
}

} // namespace pcl::cosection
