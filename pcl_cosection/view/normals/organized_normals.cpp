// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/surface/normals.h>

#include "pcl_cosection/common/multiversion.h"
#include "pcl_cosection/common/require.h"

#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/view/visibility/depth_edges.h"
#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/error.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

namespace pcl::cosection {
namespace {

constexpr int max_radius = 15;
constexpr double trim_sigmas = 3.5;   ///< points farther from the first plane are not of this surface
constexpr double planar_sigmas = 1.5; ///< thickness of a plane that noise explains ...
constexpr double planar_ratio = 0.05; ///< ... plus this share of the second eigenvalue for curvature
constexpr double line_ratio = 0.02;   ///< second over first eigenvalue: below, the support is a line

constexpr int lanes = 8; ///< rows are read and written in pieces of so many pixels

/** \brief Pixels of one window relative to its centre, as arrays for vectorised sums. */
struct Window
{
  static constexpr int capacity = (2 * max_radius + 1) * (2 * max_radius + 1) + lanes; // the last piece may be long
  alignas (32) std::array<float, capacity> x; // aligned, so that sums have one order at any address
  alignas (32) std::array<float, capacity> y;
  alignas (32) std::array<float, capacity> z;
  int size = 0;
};

/** \brief Mean and covariance of some points. */
struct Moments
{
  int count = 0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero ();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero ();
};

/** \brief Sums of x, y, z, xx, xy, xz, yy, yz and zz. */
PCL_COSECTION_MULTIVERSION void
sumProducts (const float* px, const float* py, const float* pz, int n, float* sums)
{
  float x = 0, y = 0, z = 0, xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
#pragma omp simd reduction(+ : x, y, z, xx, xy, xz, yy, yz, zz) aligned(px, py, pz : 32)
  for (int i = 0; i < n; ++i)
  {
    x += px[i];
    y += py[i];
    z += pz[i];
    xx += px[i] * px[i];
    xy += px[i] * py[i];
    xz += px[i] * pz[i];
    yy += py[i] * py[i];
    yz += py[i] * pz[i];
    zz += pz[i] * pz[i];
  }
  const std::array<float, 9> all{x, y, z, xx, xy, xz, yy, yz, zz};
  std::copy (all.begin (), all.end (), sums);
}

/** \brief Largest |a x + b y + c z - offset|. */
PCL_COSECTION_MULTIVERSION float
farthestFromPlane (const float* px, const float* py, const float* pz, int n, const float* plane)
{
  const float a = plane[0], b = plane[1], c = plane[2], offset = plane[3];
  float farthest = 0.0f;
#pragma omp simd reduction(max : farthest) aligned(px, py, pz : 32)
  for (int i = 0; i < n; ++i)
    farthest = std::max (farthest, std::abs (a * px[i] + b * py[i] + c * pz[i] - offset));
  return (farthest);
}

Moments
computeMoments (const Window& w)
{
  std::array<float, 9> sum;
  sumProducts (w.x.data (), w.y.data (), w.z.data (), w.size, sum.data ());
  Moments m;
  m.count = w.size;
  const double n = w.size;
  m.mean = Eigen::Vector3d (sum[0], sum[1], sum[2]) / n;
  m.covariance << sum[3], sum[4], sum[5], sum[4], sum[6], sum[7], sum[5], sum[7], sum[8];
  m.covariance = m.covariance / n - m.mean * m.mean.transpose ();
  return (m);
}

/** \brief Median angle between horizontal neighbours: the camera's pixel pitch, radians. */
double
estimatePitch (const std::vector<Eigen::Vector3f>& points, const std::vector<float>& range, int width, int height)
{
  std::vector<double> angles;
  const int step = std::max (1, height / 60);
  for (int v = 0; v < height; v += step)
    for (int u = 0; u + 1 < width; u += step)
    {
      const std::size_t i = static_cast<std::size_t> (v) * width + u;
      if (range[i] > 0 && range[i + 1] > 0)
        angles.push_back ((points[i] / range[i] - points[i + 1] / range[i + 1]).norm ());
    }
  if (angles.empty ())
    return (0.0);
  return upperMedian (angles);
}

class NormalEstimator
{
public:
  NormalEstimator (const std::vector<Eigen::Vector3f>& points, int width, int height,
                   const std::vector<std::uint32_t>& labels, const OrganizedNormalsOptions& options)
      : points_ (points)
      , width_ (width)
      , height_ (height)
      , labels_ (labels)
      , options_ (options)
      , x_ (points.size () + lanes)
      , y_ (points.size () + lanes)
      , z_ (points.size () + lanes)
      , range_ (points.size ())
      , run_ (points.size ())
      , reach_ (points.size ())
      , min_cosine_ (std::cos (options.max_incidence_rad))
  {
    parallelFor (0, static_cast<int> (points.size ()), options.threads, [this] (int i) {
      const float range = points_[i].norm ();
      range_[i] = std::isfinite (range) ? range : 0.0f;
      x_[i] = points_[i].x ();
      y_[i] = points_[i].y ();
      z_[i] = points_[i].z ();
    });
    pitch_ = estimatePitch (points, range_, width, height);
    parallelFor (0, height, options.threads, [this] (int v) {
      for (int u = 0; u < width_; ++u)
      {
        const int i = v * width_ + u;
        reach_[i] = rowReach (u, v);
        run_[i] = u == 0 ? 0 : run_[i - 1] + (range_[i] <= 0.0f || !usable (i, i - 1));
      }
    });
  }

  /** \brief Normal at a pixel, NaN if there is none. */
  Eigen::Vector3f estimate (int u, int v, Window& window) const
  {
    const Eigen::Vector3f none = Eigen::Vector3f::Constant (std::numeric_limits<float>::quiet_NaN ());
    const int centre = v * width_ + u;
    const double range = range_[centre];
    if (range <= 0.0 || pitch_ <= 0.0)
      return (none);
    const double pixel_m = pitch_ * range;
    const int radius = static_cast<int> (
        std::clamp<double> (std::round (options_.radius_m / pixel_m), options_.min_radius_px, options_.max_radius_px));
    const int needed = std::max (
        6, static_cast<int> (std::ceil (options_.min_support * (2 * radius + 1) * (2 * radius + 1))));
    const double sigma = depthNoiseSigma (range, options_.working_range_m);

    collect (u, v, radius, window);
    if (window.size < needed)
      return (none);
    Moments moments = computeMoments (window);
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
    eigen.computeDirect (moments.covariance);
    if (trim (window, moments.mean, eigen.eigenvectors ().col (0), trim_sigmas * sigma))
    {
      if (window.size < needed)
        return (none);
      moments = computeMoments (window);
      eigen.computeDirect (moments.covariance);
    }

    const Eigen::Vector3d lambda = eigen.eigenvalues ();
    const double noise = planar_sigmas * sigma;
    if (!(lambda[0] <= noise * noise + planar_ratio * lambda[1]) || lambda[1] < 2.0 * lambda[0] ||
        lambda[1] < line_ratio * lambda[2])
      return (none);
    Eigen::Vector3d normal = eigen.eigenvectors ().col (0).normalized ();
    if (!(std::abs (normal.dot (moments.mean)) <= trim_sigmas * sigma)) // the centre itself is off the plane
      return (none);
    const double cosine = -normal.dot (points_[centre].cast<double> ()) / range;
    if (!(std::abs (cosine) >= min_cosine_))
      return (none);
    return ((cosine > 0.0 ? normal : Eigen::Vector3d (-normal)).cast<float> ());
  }

private:
  /** \brief How many pixels of a row, before and after a pixel, are reached from it. */
  struct Reach
  {
    std::uint8_t before = 0;
    std::uint8_t after = 0;
  };

  /** \brief Whether pixel \a i has a reading and the label of \a centre. */
  bool usable (int centre, int i) const
  {
    return (range_[i] > 0.0f && (labels_.empty () || labels_[i] == labels_[centre]));
  }

  /** \brief Walk along a row or a column; calls \a visit (step, pixel) at every pixel reached without
   * a jump in range. Unusable pixels are stepped over. */
  template <typename Visit> void walk (int start, int stride, int steps, Visit&& visit) const
  {
    const double range = range_[start], pixel_m = pitch_ * range;
    int last = 0;
    for (int k = 1; k <= steps; ++k)
    {
      const int i = start + k * stride;
      if (!usable (start, i))
        continue;
      if (std::abs (range_[i] - range_[start + last * stride]) >
          largestSurfaceStep (range, pixel_m * (k - last), options_.working_range_m))
        return;
      visit (k, i);
      last = k;
    }
  }

  Reach rowReach (int u, int v) const
  {
    Reach reach;
    const int i = v * width_ + u;
    if (range_[i] > 0.0f)
    {
      const int radius = options_.max_radius_px;
      walk (i, -1, std::min (radius, u), [&] (int k, int) { reach.before = static_cast<std::uint8_t> (k); });
      walk (i, 1, std::min (radius, width_ - 1 - u), [&] (int k, int) { reach.after = static_cast<std::uint8_t> (k); });
    }
    return (reach);
  }

  /** \brief to[i] = from[i] - origin for at least \a n elements, whole pieces at a time. */
  static void copyRelative (const float* from, float origin, int n, float* to)
  {
    for (int piece = 0; piece < n; piece += lanes)
      for (int i = piece; i < piece + lanes; ++i)
        to[i] = from[i] - origin;
  }

  /** \brief Gather the pixels of the window that are reached from its centre: up and down the
   * centre's column, and from there along the rows. */
  void collect (int u, int v, int radius, Window& window) const
  {
    const int centre = v * width_ + u;
    const Eigen::Vector3f origin = points_[centre];
    int size = 0;
    const auto addRow = [&] (int, int row) {
      const int first = row - std::min<int> (radius, reach_[row].before);
      const int last = row + std::min<int> (radius, reach_[row].after);
      if (run_[first] == run_[last])
      {
        const int n = last - first + 1;
        copyRelative (x_.data () + first, origin.x (), n, window.x.data () + size);
        copyRelative (y_.data () + first, origin.y (), n, window.y.data () + size);
        copyRelative (z_.data () + first, origin.z (), n, window.z.data () + size);
        size += n;
        return;
      }
      for (int i = first; i <= last; ++i)
      {
        window.x[size] = x_[i] - origin.x ();
        window.y[size] = y_[i] - origin.y ();
        window.z[size] = z_[i] - origin.z ();
        size += usable (centre, i);
      }
    };
    addRow (0, centre);
    walk (centre, -width_, std::min (radius, v), addRow);
    walk (centre, width_, std::min (radius, height_ - 1 - v), addRow);
    window.size = size;
  }

  /** \brief Remove the points farther than \a limit from a plane. \return whether there were any */
  static bool trim (Window& window, const Eigen::Vector3d& mean, const Eigen::Vector3d& normal, double limit)
  {
    const Eigen::Vector3f n = normal.cast<float> ();
    const auto offset = static_cast<float> (normal.dot (mean));
    const std::array<float, 4> plane{n.x (), n.y (), n.z (), offset};
    if (farthestFromPlane (window.x.data (), window.y.data (), window.z.data (), window.size, plane.data ()) <=
        static_cast<float> (limit))
      return (false);
    int kept = 0;
    for (int i = 0; i < window.size; ++i)
    {
      const float distance = n.x () * window.x[i] + n.y () * window.y[i] + n.z () * window.z[i] - offset;
      window.x[kept] = window.x[i];
      window.y[kept] = window.y[i];
      window.z[kept] = window.z[i];
      kept += std::abs (distance) <= static_cast<float> (limit);
    }
    const bool any = kept < window.size;
    window.size = kept;
    return (any);
  }

  const std::vector<Eigen::Vector3f>& points_;
  const int width_;
  const int height_;
  const std::vector<std::uint32_t>& labels_;
  const OrganizedNormalsOptions& options_;
  std::vector<float> x_, y_, z_; ///< coordinates, and room for a whole piece behind the last
  std::vector<float> range_;     ///< 0: no reading
  std::vector<int> run_;         ///< equal in one row: usable together, like all pixels between them
  std::vector<Reach> reach_;
  const double min_cosine_;
  double pitch_ = 0.0;
};

} // namespace

void
OrganizedNormalsOptions::validate () const
{
  require (isPositive (radius_m), "normals: radius_m must be positive and finite");
  require (isPositive (working_range_m), "normals: working_range_m must be positive and finite");
  require (min_radius_px >= 1, "normals: min_radius_px must be at least 1");
  require (max_radius_px >= min_radius_px && max_radius_px <= max_radius,
           "normals: max_radius_px must be between min_radius_px and " + std::to_string (max_radius));
  require (min_support >= 0.0 && min_support <= 1.0, "normals: min_support must be between 0 and 1");
  require (max_incidence_rad > 0.0 && max_incidence_rad < 1.57,
           "normals: max_incidence_rad must be between 0 and 1.57");
}

std::vector<Eigen::Vector3f>
computeOrganizedNormals (const std::vector<Eigen::Vector3f>& points, int width, int height,
                         const std::vector<std::uint32_t>& labels, const OrganizedNormalsOptions& options)
{
  options.validate ();
  requireImage ("normals", points.size (), width, height);
  if (!labels.empty () && labels.size () != points.size ())
    throw InvalidArgument ("normals: there must be as many labels as points, or none");

  const NormalEstimator estimator (points, width, height, labels, options);
  std::vector<Eigen::Vector3f> normals (points.size ());
  // Threads take rows by turns: readings are not spread evenly over an image.
  const int threads = std::min (height, resolveThreads (options.threads));
  parallelFor (0, threads, threads, [&] (int thread) {
    Window window;
    for (int v = thread; v < height; v += threads)
      for (int u = 0; u < width; ++u)
        normals[static_cast<std::size_t> (v) * width + u] = estimator.estimate (u, v, window);
  });
  return (normals);
}

} // namespace pcl::cosection
