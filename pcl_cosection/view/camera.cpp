// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/common/camera.h>

#include "camera_resection.h"
#include "pcl_cosection/volume/rigid_motion.h"
#include "range_image.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace pcl::cosection {
namespace {

constexpr double max_behind_share = 0.01; // of points that no camera at the origin sees
constexpr int min_fit_points = 50;
constexpr double max_fit_residual_px = 0.5; ///< root mean square

/** \brief Least-squares line y = slope x + offset, from running means and central moments. */
class LineFit
{
public:
  void add (double x, double y)
  {
    ++count_;
    const double dx = x - mean_x_;
    mean_x_ += dx / count_;
    const double dy = y - mean_y_;
    mean_y_ += dy / count_;
    xx_ += dx * (x - mean_x_);
    xy_ += dx * (y - mean_y_);
    yy_ += dy * (y - mean_y_);
  }

  double slope () const { return xy_ / xx_; } // not finite if all x are equal

  double offset () const { return mean_y_ - slope () * mean_x_; }

  /** \brief Mean squared residual of x, given y. */
  double residualX () const { return std::max (0.0, yy_ - slope () * xy_) / (count_ * slope () * slope ()); }

private:
  double count_ = 0.0, mean_x_ = 0.0, mean_y_ = 0.0, xx_ = 0.0, xy_ = 0.0, yy_ = 0.0;
};

} // namespace

void
PinholeCamera::validate () const
{
  if (width <= 0 || height <= 0)
    throw InvalidArgument ("camera: width and height must be positive, but are " + std::to_string (width) + " x " +
                           std::to_string (height));
  if (!(fx > 0.0 && fy > 0.0 && std::isfinite (fx) && std::isfinite (fy)))
    throw InvalidArgument ("camera: focal lengths must be positive, but are " + std::to_string (fx) + " and " +
                           std::to_string (fy));
  if (!std::isfinite (cx) || !std::isfinite (cy))
    throw InvalidArgument ("camera: the principal point must be finite");
}

void
DepthView::validate () const
{
  camera.validate ();
  if (depth.size () != static_cast<std::size_t> (camera.width) * camera.height)
    throw InvalidArgument ("the depth of a view has " + std::to_string (depth.size ()) + " values; its camera has " +
                           std::to_string (camera.width) + " x " + std::to_string (camera.height) + " pixels");
  if (!isRigidMotion (T_world_sensor))
    throw InvalidArgument ("the pose of a view must be a finite rigid motion");
  if (!(working_range_m > 0.0 && std::isfinite (working_range_m)))
    throw InvalidArgument ("the working range of a view must be positive and finite");
}

std::optional<PinholeCamera>
fitPinholeCamera (const std::vector<Eigen::Vector3f>& points, int width, int height)
{
  if (width <= 0 || height <= 0 || points.size () != static_cast<std::size_t> (width) * height)
    throw InvalidArgument ("fitPinholeCamera: there must be width * height points");
  LineFit columns, rows; // x/z = column / fx - cx / fx
  int usable = 0, behind = 0;
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u)
    {
      const Eigen::Vector3d p = points[static_cast<std::size_t> (v) * width + u].cast<double> ();
      if (!p.allFinite () || !(p.z () > 0.0))
      {
        behind += p.allFinite () && !p.isZero (0.0); // zero is no reading
        continue;
      }
      columns.add (u, p.x () / p.z ());
      rows.add (v, p.y () / p.z ());
      ++usable;
    }
  if (usable < min_fit_points || behind > max_behind_share * usable)
    return std::nullopt;

  PinholeCamera camera{width, height};
  camera.fx = 1.0 / columns.slope ();
  camera.fy = 1.0 / rows.slope ();
  camera.cx = -columns.offset () * camera.fx;
  camera.cy = -rows.offset () * camera.fy;
  const double mean_squared = columns.residualX () + rows.residualX ();
  if (!(camera.fx > 0.0 && camera.fy > 0.0 && std::isfinite (camera.fx) && std::isfinite (camera.fy) &&
        mean_squared <= max_fit_residual_px * max_fit_residual_px))
    return std::nullopt;
  return camera;
}

bool
haveParallelRays (const std::vector<Eigen::Vector3f>& points, int width)
{
  LineFit columns, rows; // x = column * pitch + offset
  int usable = 0;
  for (std::size_t n = 0; n < points.size (); ++n)
    if (points[n].allFinite ())
    {
      columns.add (static_cast<double> (n % static_cast<std::size_t> (width)), points[n].x ());
      rows.add (static_cast<double> (n / static_cast<std::size_t> (width)), points[n].y ());
      ++usable;
    }
  return usable >= min_fit_points &&
         columns.residualX () + rows.residualX () <= max_fit_residual_px * max_fit_residual_px;
}

std::optional<DepthView>
toDepthView (const std::vector<Eigen::Vector3f>& points, int width, int height, const Eigen::Isometry3d& T_world_points)
{
  if (points.empty ())
    return std::nullopt;
  if (height > 1)
  {
    if (const auto camera = fitPinholeCamera (points, width, height))
      return depthImage (*camera, points, T_world_points);
    if (const auto located = locateCamera (points, width, height))
      return depthImage (located->camera, takeToSensor (located->T_points_sensor.inverse (), points),
                         T_world_points * located->T_points_sensor);
    return std::nullopt;
  }
  std::optional<RangeImage> image = drawRangeImage (points, Eigen::Vector3d::Zero ());
  if (!image || image->hidden_share > RangeImage::max_hidden_share)
    return std::nullopt;
  image->view.T_world_sensor = T_world_points * image->view.T_world_sensor;
  return std::move (image->view);
}

} // namespace pcl::cosection
