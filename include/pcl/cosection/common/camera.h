// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/export.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace pcl {
template <typename PointT> class PointCloud;
}

namespace pcl::cosection {

/** \brief A pinhole camera without distortion: pixel (u, v) of integer coordinates is the centre of
 * a pixel; z points forward, x right, y down. */
struct PCL_COSECTION_EXPORT PinholeCamera
{
  int width = 0;   ///< pixels
  int height = 0;  ///< pixels
  double fx = 0.0; ///< focal length, pixels
  double fy = 0.0; ///< focal length, pixels
  double cx = 0.0; ///< principal point, pixels
  double cy = 0.0; ///< principal point, pixels

  /** \brief Pixel coordinates of a point of the sensor frame with z > 0. */
  Eigen::Vector2d project (const Eigen::Vector3d& p) const
  {
    return {fx * p.x () / p.z () + cx, fy * p.y () / p.z () + cy};
  }

  /** \brief Point of the sensor frame at depth \a z (metres along the optical axis). */
  Eigen::Vector3d unproject (double u, double v, double z) const { return {(u - cx) / fx * z, (v - cy) / fy * z, z}; }

  /** \brief Check all values. \throws InvalidArgument if the size or a focal length is not positive and finite. */
  void validate () const;
};

/** \brief One depth image and where it was taken from. */
struct PCL_COSECTION_EXPORT DepthView
{
  PinholeCamera camera;     ///< of the image
  std::vector<float> depth; ///< width * height, row by row, metres along the optical axis; NaN or 0: no reading
  Eigen::Isometry3d T_world_sensor = Eigen::Isometry3d::Identity (); ///< pose of the sensor, metres
  std::string name = {};                                             ///< used in warnings; empty: they give its number
  double working_range_m = 1.0;                                      ///< of the sensor, for depthNoiseSigma ()

  /** \brief Depth at column \a u and row \a v, metres; NaN or 0: no reading. */
  float at (int u, int v) const { return depth[static_cast<std::size_t> (v) * camera.width + u]; }

  /** \brief Check all values. \throws InvalidArgument if the camera is not valid, there is not one depth per pixel,
   * the pose is not a finite rigid motion, or the working range is not positive and finite. */
  void validate () const;
};

/** \brief Standard deviation of the depth of a structured-light sensor at range \a z, metres
 * (C. Nguyen, S. Izadi, D. Lovell, "Modeling Kinect Sensor Noise for Improved 3D Reconstruction and
 * Tracking", 3DIMPVT 2012, axial noise at small angles).
 * \param[in] z range, metres
 * \param[in] working_range_m of a sensor of the same construction, but of another size: that one was measured around
 * one metre */
inline double
depthNoiseSigma (double z, double working_range_m = 1.0)
{
  const double x = z / working_range_m - 0.4;
  return working_range_m * (0.0012 + 0.0019 * x * x);
}

/** \brief Least-squares pinhole of an organised cloud in its sensor frame: x/z and y/z as affine
 * functions of the column and the row.
 * \param[in] points width * height points, row by row, sensor frame, metres; not finite: no reading
 * \param[in] width, height pixels
 * \return nothing if fewer than 50 points are usable, or the residual's root mean square exceeds
 * half a pixel (the cloud is not a pinhole's image) */
PCL_COSECTION_EXPORT std::optional<PinholeCamera> fitPinholeCamera (const std::vector<Eigen::Vector3f>& points,
                                                                    int width, int height);

/** \brief The depth image that a cloud is: of an organised one its pixels, of an unorganised one the nearest point in
 * each direction from its sensor.
 *
 * An organised cloud may be in any frame: its pixels determine the camera's intrinsics and pose. An unorganised one is
 * in its sensor's frame.
 * \param[in] points width * height points, row by row, metres (organised in the sensor's frame: x right, y down, z
 * forward); not finite, or z <= 0 of an organised one: no reading
 * \param[in] width, height of an organised cloud; height 1: not organised
 * \param[in] T_world_points pose of the frame in which the points are
 * \return with the working range of which its depths are typical; nothing if there are no points, if an organised
 * cloud is not the image of a pinhole camera (fitPinholeCamera ()), or if more than a tenth of the points of an
 * unorganised one is hidden from the sensor
 * \throws InvalidArgument if there are not width * height points */
PCL_COSECTION_EXPORT std::optional<DepthView>
toDepthView (const std::vector<Eigen::Vector3f>& points, int width, int height,
             const Eigen::Isometry3d& T_world_points = Eigen::Isometry3d::Identity ());

/** \brief The depth image that a cloud of PCL's is: see toDepthView () of points. A cloud whose size is not its width
 * times its height gives nothing. */
template <typename PointT>
std::optional<DepthView>
toDepthView (const pcl::PointCloud<PointT>& cloud,
             const Eigen::Isometry3d& T_world_cloud = Eigen::Isometry3d::Identity ())
{
  if (cloud.height > 1 && cloud.size () != static_cast<std::size_t> (cloud.width) * cloud.height)
    return std::nullopt;
  std::vector<Eigen::Vector3f> points;
  points.reserve (cloud.size ());
  for (const PointT& p : cloud)
    points.emplace_back (p.x, p.y, p.z);
  const bool organized = cloud.height > 1;
  return toDepthView (points, organized ? static_cast<int> (cloud.width) : static_cast<int> (points.size ()),
                      organized ? static_cast<int> (cloud.height) : 1, T_world_cloud);
}

} // namespace pcl::cosection
