// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "proposal.h"
#include <pcl/cosection/common/oriented_point.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <limits>
#include <vector>

namespace pcl::cosection {

constexpr float level_top_cosine = 0.95f; // component upwards of the normals of a level top

/** \brief What is hidden below an object's own observed surface reaches the support plane, where nothing was seen free.
 *
 * The observed points are a height map over the plane. Space below it, down to the plane, that nothing shows to be free
 * is exempt from the extent prior: the surface above it hides it. If hardly any column of the height map was seen free
 * further down, the object has vertical walls, and is expected to fill these columns. If these are columns of
 * level tops at one height, what is hidden below free space beside them is outside the object. */
class Extrusion
{
public:
  /** \param[in] points of the object, the grid's frame \param[in] plane unit normal towards the object */
  Extrusion (const BodyEnergy& energy, const std::vector<OrientedPoint>& points, const Eigen::Vector4d& plane);

  /** \brief Whether free space cuts hardly any column. */
  bool hasWalls () const { return has_walls_; }

  /** \brief Add what is expected, where \a proposal does not expect free space.
   * \param[in] below_m only so far over the plane */
  void addTo (Proposal& proposal, double below_m = std::numeric_limits<double>::infinity ()) const;

  /** \brief If columns with level tops are all of the object: nothing is expected below free space that is lower than
   * the tops, as it is beside vertical walls. */
  void emptyBesideTops (Proposal& proposal) const;

private:
  /** \brief A column over the plane. */
  struct Column
  {
    float height_m = -1.0f; // of the highest point; negative: no points
    float upwards = 0.0f;   // of that point's normal
  };

  int cellOf (const Eigen::Vector3d& place) const;
  Eigen::Vector3d placeOf (int column, int row, double height_m) const;
  double heightOver (const Eigen::Vector3d& place) const { return up_.dot (place) + plane_[3]; }
  Column& at (int column, int row) { return map_[static_cast<std::size_t> (row) * columns_ + column]; }
  const Column& at (int column, int row) const { return map_[static_cast<std::size_t> (row) * columns_ + column]; }
  bool isFree (const Eigen::Vector3d& place) const;
  bool isFreeBetween (const Eigen::Vector3d& place, double low_m, double high_m) const;
  void raise (const std::vector<OrientedPoint>& points);
  void fillGaps ();
  double cutShare () const;
  double levelShare () const;

  const BodyEnergy& energy_;
  Eigen::Vector4d plane_;
  Eigen::Vector3d up_, across_, along_;
  double cell_m_;
  Eigen::Vector2d first_ = Eigen::Vector2d::Zero (); // corner of the cells
  int columns_ = 0, rows_ = 0;
  double top_m_ = 0.0; // height of the highest column
  std::vector<Column> map_;
  bool has_walls_ = false, is_level_ = false;
};

} // namespace pcl::cosection
