// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief Directions evenly distributed over the sphere, symmetric with respect to the senses of the axes: those of a
 * Fibonacci lattice in one octant, and their mirror images. \param[in] axes columns */
std::vector<Eigen::Vector3d> evenDirections (int count, const Eigen::Matrix3d& axes);

/** \brief Mean normals of all large flat faces, the largest first.
 * \param[in] bins unit directions, evenly distributed over the sphere */
std::vector<Eigen::Vector3d> faceNormals (const std::vector<OrientedPoint>& points,
                                          const std::vector<Eigen::Vector3d>& bins);

/** \brief Whether most points belong to the three largest faces. */
bool prevail (const std::vector<OrientedPoint>& points, const std::vector<Eigen::Vector3d>& faces);

/** \brief Whether nearly all points belong to faces at right angles, of at least two directions. */
bool isCuboid (const std::vector<OrientedPoint>& points, const std::vector<Eigen::Vector3d>& faces);

/** \brief Points of a vertical wall, one above the other. */
using WallColumn = std::vector<OrientedPoint>;

/** \brief The vertical walls of a thing that stands on a plane: a box, a hexagonal tin, a wedge of cheese. */
class PrismWalls
{
public:
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

  /** \brief Points of walls below the edges of the observed top, which need not be convex. Only if showsTop (). */
  std::vector<WallColumn> belowEdges (double step_m) const;

  /** \brief Whether its top was seen: at least a tenth of the points. */
  bool showsTop () const { return shows_top_; }

  /** \brief Component of the top along the normal of the plane, if all of the observed top has one height. Only if
   * showsTop (). */
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

  Eigen::Vector4d plane_;
  Eigen::Matrix3d axes_ = Eigen::Matrix3d::Identity (); // columns; the last one points upwards
  bool shows_top_ = false;
  std::vector<Eigen::Vector3d> top_; // points of horizontal faces, along the axes
  std::vector<Wall> walls_;          // of the convex outline
};

} // namespace pcl::cosection
