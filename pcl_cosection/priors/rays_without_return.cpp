// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "rays_without_return.h"

#include "occlusion_map.h"
#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/view/visibility/visibility.h"

#include <algorithm>

namespace pcl::cosection {
namespace {

constexpr int drawn_cell_px = 2;        // of an image that was drawn of points without gaps: a bottle loses 8 % with 1
constexpr int margin_cells = 1;         // around the object, as silhouettes are inaccurate
constexpr double points_of_drawn = 1.6; // in a pixel, from which on it was drawn: a sensor has 1, drawn ones 2.5

/** \brief The cells of an image beside an object, outside its outline. */
class Beside
{
public:
  Beside (const DepthView& view, const Eigen::Isometry3d& T_object_sensor, const std::vector<OrientedPoint>& points)
      : view_ (view)
      , T_sensor_object_ (T_object_sensor.inverse ())
  {
    std::vector<std::uint8_t> own (view.depth.size ());
    double points_in_view = 0.0, pixels = 0.0;
    for (const OrientedPoint& point : points)
      if (const auto pixel = pixelOf (view.camera, T_sensor_object_ * point.position.cast<double> ()))
      {
        std::uint8_t& is_own = own[static_cast<std::size_t> (pixel->y ()) * view.camera.width + pixel->x ()];
        ++points_in_view;
        pixels += is_own == 0;
        is_own = 1;
      }
    cell_ = points_in_view > points_of_drawn * pixels ? drawn_cell_px : outline_cell_px;
    size_ = {(view.camera.width + cell_ - 1) / cell_, (view.camera.height + cell_ - 1) / cell_};
    cells_.assign (static_cast<std::size_t> (size_.x ()) * size_.y (), 0);
    for (std::size_t n = 0; n < own.size (); ++n)
      if (own[n] != 0 || isReading (view.depth[n])) // readings without a normal show a surface, too
        mark (Eigen::Array2i (static_cast<int> (n % view.camera.width), static_cast<int> (n / view.camera.width)) /
              cell_);
    fill ();
  }

  bool isOpen (const Eigen::Vector3d& place) const
  {
    const Eigen::Vector3d q = T_sensor_object_ * place;
    const auto pixel = pixelOf (view_.camera, q);
    return pixel && cells_[indexOf (*pixel / cell_)] == outside &&
           compareWithReading (q.z (), view_.at (pixel->x (), pixel->y ()), 0.0) != PointVisibility::Occluded;
  }

private:
  static constexpr std::uint8_t object = 1;
  static constexpr std::uint8_t outside = 2;

  std::size_t indexOf (const Eigen::Array2i& cell) const
  {
    return static_cast<std::size_t> (cell.y ()) * size_.x () + cell.x ();
  }

  void mark (const Eigen::Array2i& cell)
  {
    const Eigen::Array2i low = (cell - margin_cells).max (0), high = (cell + margin_cells).min (size_ - 1);
    for (int v = low.y (); v <= high.y (); ++v)
      for (int u = low.x (); u <= high.x (); ++u)
        cells_[indexOf ({u, v})] = object;
  }

  /** \brief Flood fill from the border of the image through cells that are not the object's. */
  void fill ()
  {
    std::vector<Eigen::Array2i> front;
    const auto reach = [&] (const Eigen::Array2i& cell) {
      if ((cell < 0).any () || (cell >= size_).any () || cells_[indexOf (cell)] != 0)
        return;
      cells_[indexOf (cell)] = outside;
      front.push_back (cell);
    };
    for (int v = 0; v < size_.y (); ++v)
      for (int u = 0; u < size_.x (); ++u)
        if (u == 0 || v == 0 || u == size_.x () - 1 || v == size_.y () - 1)
          reach ({u, v});
    while (!front.empty ())
    {
      const Eigen::Array2i cell = front.back ();
      front.pop_back ();
      reach (cell + Eigen::Array2i (1, 0));
      reach (cell - Eigen::Array2i (1, 0));
      reach (cell + Eigen::Array2i (0, 1));
      reach (cell - Eigen::Array2i (0, 1));
    }
  }

  const DepthView& view_;
  Eigen::Isometry3d T_sensor_object_;
  int cell_;            // pixels
  Eigen::Array2i size_; // cells
  std::vector<std::uint8_t> cells_;
};

} // namespace

std::vector<std::uint8_t>
findRaysWithoutReturn (const VoxelGrid& grid, const SensorViews& views, const std::vector<OrientedPoint>& points,
                       int threads)
{
  std::vector<std::uint8_t> open (grid.size (), 0);
  for (const auto& [view, T_object_sensor] : views)
  {
    const Beside beside (*view, T_object_sensor, points);
    parallelFor (0, grid.dims.z (), threads, [&] (int k) {
      for (int j = 0; j < grid.dims.y (); ++j)
        for (int i = 0; i < grid.dims.x (); ++i)
          if (std::uint8_t& is_open = open[grid.index (i, j, k)]; !is_open)
            is_open = beside.isOpen (grid.center (i, j, k));
    });
  }
  return open;
}

} // namespace pcl::cosection
