// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/priors/shape/symmetric_extent.h"
#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstddef>
#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief The vertical walls of a thing that stands on a plane: a box, a hexagonal tin, a wedge of cheese. */
class PrismWalls
{
public:
  PrismWalls () = default;

  /** \brief Fit walls. There are no walls if one of the largest faces is neither vertical nor horizontal, or if no face
   * is vertical.
   * \param[in] points that were observed
   * \param[in] copies expected points of its other side
   * \param[in] faces normals of the observed faces, the largest first
   * \param[in] plane on which it stands: unit normal upwards, and offset */
  PrismWalls (const std::vector<OrientedPoint>& points, const std::vector<OrientedPoint>& copies,
              const std::vector<Eigen::Vector3d>& faces, const Eigen::Vector4d& plane);

  /** \brief Points of all walls, from the plane to the top, seen or not. */
  std::vector<WallColumn> columns (double step_m) const;

  /** \brief Points of walls below the edges of the observed top, which need not be convex. */
  std::vector<WallColumn> belowEdges (double step_m) const;

  /** \brief Whether its top was seen: at least a tenth of the points. */
  bool showsTop () const;

  /** \brief Component of the top along the normal of the plane, if all of the observed top has one height. */
  std::optional<double> levelTop () const;

private:
  struct Wall
  {
    Eigen::Vector2d normal;
    double offset;
    double top; // height over the plane
  };

  WallColumn column (const Eigen::Vector2d& place, const Eigen::Vector2d& normal, double bottom, double top,
                     double step_m) const;

  Eigen::Vector4d plane_ = Eigen::Vector4d::UnitZ ();
  Eigen::Matrix3d axes_ = Eigen::Matrix3d::Identity (); // columns; the last one points upwards
  std::size_t points_ = 0;
  std::vector<Eigen::Vector3d> top_; // points of horizontal faces, along the axes
  std::vector<Wall> walls_;          // of the convex outline
};

} // namespace pcl::cosection
