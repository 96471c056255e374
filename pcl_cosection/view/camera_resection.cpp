// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "camera_resection.h"

#include "sensor_noise.h"

#include <pcl/cosection/common/error.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>

#include <cmath>
#include <cstddef>
#include <limits>

namespace pcl::cosection {
namespace {

using Matrix34 = Eigen::Matrix<double, 3, 4>;
using Matrix12 = Eigen::Matrix<double, 12, 12>;

constexpr int reweightings = 3;
constexpr std::size_t min_points = 50;
// Least ratio of the second smallest eigenvalue to the smallest; below it, several matrices fit.
constexpr double min_distinction = 100.0;
constexpr double at_sensor = 1e-3;   ///< of the mean depth; points that are nearer are no readings
constexpr double min_effect = 10.0;  ///< of perspective on the pixels, in residuals
constexpr double least_before = 0.9; ///< of the points lie before a camera that is one

/** \brief A change of coordinates, x -> scale (x - middle), after which they are about one. */
template <int Dimension> struct Normalisation
{
  Eigen::Matrix<double, Dimension, 1> middle = Eigen::Matrix<double, Dimension, 1>::Zero ();
  double scale = 1.0;

  Eigen::Matrix<double, Dimension, 1> operator() (const Eigen::Matrix<double, Dimension, 1>& x) const
  {
    return scale * (x - middle);
  }

  Eigen::Matrix<double, Dimension + 1, Dimension + 1> matrix () const
  {
    auto m = Eigen::Matrix<double, Dimension + 1, Dimension + 1>::Identity ().eval ();
    m.template topLeftCorner<Dimension, Dimension> () *= scale;
    m.template topRightCorner<Dimension, 1> () = -scale * middle;
    return m;
  }
};

Normalisation<3>
normalisationOf (const std::vector<Eigen::Vector3f>& points)
{
  Normalisation<3> result;
  double count = 0.0;
  for (const Eigen::Vector3f& p : points)
    if (p.allFinite ())
      result.middle += (p.cast<double> () - result.middle) / ++count;
  double squared = 0.0;
  for (const Eigen::Vector3f& p : points)
    if (p.allFinite ())
      squared += (p.cast<double> () - result.middle).squaredNorm () / count;
  result.scale = squared > 0.0 ? 1.0 / std::sqrt (squared) : 0.0;
  return result;
}

Normalisation<2>
normalisationOf (int width, int height)
{
  Normalisation<2> result;
  result.middle = 0.5 * Eigen::Vector2d (width - 1, height - 1);
  result.scale = 2.0 / std::hypot (width, height);
  return result;
}

/** \brief The matrix of least algebraic error, each point weighted by 1 / depth^2 under \a last, which makes the error
 * one in pixels.
 * \return nothing if others fit as well */
std::optional<Matrix34>
fitProjection (const std::vector<Eigen::Vector3f>& points, int width, int height, const Normalisation<3>& of_points,
               const Normalisation<2>& of_pixels, const std::optional<Matrix34>& last)
{
  Eigen::Matrix4d xx = Eigen::Matrix4d::Zero (), u_xx = xx, v_xx = xx, uv_xx = xx;
  double mean_depth = 0.0;
  std::size_t count = 0;
  if (last)
    for (const Eigen::Vector3f& p : points)
      if (p.allFinite ())
        mean_depth += (std::abs (last->row (2).dot (of_points (p.cast<double> ()).homogeneous ())) - mean_depth) /
                      static_cast<double> (++count);
  count = 0;
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u)
    {
      const Eigen::Vector3f& p = points[static_cast<std::size_t> (v) * width + u];
      if (!p.allFinite ())
        continue;
      const Eigen::Vector4d x = of_points (p.cast<double> ()).homogeneous ();
      const Eigen::Vector2d pixel = of_pixels (Eigen::Vector2d (u, v));
      double weight = 1.0;
      if (last)
      {
        const double depth = last->row (2).dot (x);
        if (!(std::abs (depth) > at_sensor * mean_depth))
          continue;
        weight = mean_depth * mean_depth / (depth * depth);
      }
      ++count;
      const Eigen::Matrix4d product = weight * x * x.transpose ();
      xx += product;
      u_xx += pixel.x () * product;
      v_xx += pixel.y () * product;
      uv_xx += pixel.squaredNorm () * product;
    }
  if (count < min_points)
    return std::nullopt;
  // Rows of the system: (x, 0, -u x) and (0, x, -v x).
  Matrix12 normal = Matrix12::Zero ();
  normal.block<4, 4> (0, 0) = normal.block<4, 4> (4, 4) = xx;
  normal.block<4, 4> (0, 8) = normal.block<4, 4> (8, 0) = -u_xx;
  normal.block<4, 4> (4, 8) = normal.block<4, 4> (8, 4) = -v_xx;
  normal.block<4, 4> (8, 8) = uv_xx;
  const Eigen::SelfAdjointEigenSolver<Matrix12> eigen (normal);
  const auto& values = eigen.eigenvalues ();
  if (eigen.info () != Eigen::Success || !(values[1] > min_distinction * std::abs (values[0])))
    return std::nullopt;
  Matrix34 projection;
  for (int row = 0; row < 3; ++row)
    projection.row (row) = eigen.eigenvectors ().col (0).segment<4> (4 * row).transpose ();
  return projection;
}

/** \brief The pose of the sensor of a projection matrix whose sign is open. */
std::optional<Eigen::Isometry3d>
poseOf (Matrix34 projection)
{
  if (projection.leftCols<3> ().determinant () < 0.0)
    projection = -projection;
  const Eigen::Matrix3d m = projection.leftCols<3> ();
  // m = K R: the rows of R from the last on, as K is upper triangular with a positive diagonal.
  Eigen::Matrix3d rotation;
  rotation.row (2) = m.row (2).normalized ();
  rotation.row (1) = (m.row (1) - m.row (1).dot (rotation.row (2)) * rotation.row (2)).normalized ();
  rotation.row (0) = rotation.row (1).cross (rotation.row (2));
  Eigen::Isometry3d T_points_sensor = Eigen::Isometry3d::Identity ();
  T_points_sensor.linear () = rotation.transpose ();
  T_points_sensor.translation () = -m.fullPivLu ().solve (projection.col (3));
  if (!T_points_sensor.matrix ().allFinite ())
    return std::nullopt;
  return T_points_sensor;
}

/** \brief Whether the points would look clearly different from infinitely far away, which they need for the distance of
 * the camera to be known. */
bool
tellsDepth (const PinholeCamera& camera, const std::vector<Eigen::Vector3f>& seen)
{
  double count = 0.0, depth = 0.0, depth_squares = 0.0, residual_squares = 0.0, radius_squares = 0.0;
  Eigen::Vector2d middle = Eigen::Vector2d::Zero ();
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u)
    {
      const Eigen::Vector3d p = seen[static_cast<std::size_t> (v) * camera.width + u].cast<double> ();
      if (!(p.z () > 0.0))
        continue;
      ++count;
      const double beyond = p.z () - depth;
      depth += beyond / count;
      depth_squares += beyond * (p.z () - depth);
      const Eigen::Vector2d pixel (u, v);
      const Eigen::Vector2d aside = pixel - middle;
      middle += aside / count;
      radius_squares += aside.dot (pixel - middle);
      residual_squares += (camera.project (p) - pixel).squaredNorm ();
    }
  const double effect_px = std::sqrt (radius_squares / count) * std::sqrt (depth_squares / count) / depth;
  return effect_px > min_effect * std::sqrt (residual_squares / count);
}

} // namespace

std::optional<LocatedCamera>
locateCamera (const std::vector<Eigen::Vector3f>& points, int width, int height)
{
  if (width <= 0 || height <= 0 || points.size () != static_cast<std::size_t> (width) * height)
    throw InvalidArgument ("locateCamera: there must be width * height points");
  const Normalisation<3> of_points = normalisationOf (points);
  const Normalisation<2> of_pixels = normalisationOf (width, height);
  std::optional<Matrix34> projection;
  for (int k = 0; k <= reweightings; ++k)
    if (projection = fitProjection (points, width, height, of_points, of_pixels, projection); !projection)
      return std::nullopt;
  const auto pose = poseOf (of_pixels.matrix ().inverse () * *projection * of_points.matrix ());
  if (!pose)
    return std::nullopt;

  const std::vector<Eigen::Vector3f> seen = takeToSensor (pose->inverse (), points);
  std::size_t readings = 0, before = 0;
  for (const Eigen::Vector3f& p : seen)
  {
    readings += p.allFinite ();
    before += p.z () > 0.0f;
  }
  if (static_cast<double> (before) < least_before * static_cast<double> (readings))
    return std::nullopt; // mirrored
  const auto camera = fitPinholeCamera (seen, width, height);
  if (!camera || !tellsDepth (*camera, seen))
    return std::nullopt;
  return LocatedCamera{*camera, *pose};
}

std::vector<Eigen::Vector3f>
takeToSensor (const Eigen::Isometry3d& T_sensor_points, const std::vector<Eigen::Vector3f>& points)
{
  std::vector<Eigen::Vector3f> seen (points.size (),
                                     Eigen::Vector3f::Constant (std::numeric_limits<float>::quiet_NaN ()));
  double mean_depth = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < points.size (); ++i)
    if (points[i].allFinite ())
    {
      seen[i] = (T_sensor_points * points[i].cast<double> ()).cast<float> ();
      mean_depth += (std::abs (seen[i].z ()) - mean_depth) / static_cast<double> (++count);
    }
  for (Eigen::Vector3f& p : seen)
    if (std::abs (p.z ()) <= at_sensor * mean_depth)
      p.setConstant (std::numeric_limits<float>::quiet_NaN ());
  return seen;
}

DepthView
depthImage (const PinholeCamera& camera, const std::vector<Eigen::Vector3f>& points,
            const Eigen::Isometry3d& T_world_sensor)
{
  DepthView view{camera, {}, T_world_sensor};
  view.depth.reserve (points.size ());
  for (const Eigen::Vector3f& p : points)
    view.depth.push_back (p.z () > 0.0f ? p.z () : std::numeric_limits<float>::quiet_NaN ());
  view.working_range_m = workingRange (view.depth);
  return view;
}

} // namespace pcl::cosection
