// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "thinned_points.h"

#include "pcl_cosection/common/lattice_cells.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pcl::cosection {
namespace {

constexpr double cells_along = 25.0; // the longest side

Eigen::AlignedBox3d
boxOf (const std::vector<OrientedPoint>& points)
{
  Eigen::AlignedBox3d box;
  for (const OrientedPoint& point : points)
    box.extend (point.position.cast<double> ());
  return box;
}

Eigen::Matrix3Xd
everyFew (const Eigen::Matrix3Xd& all, Eigen::Index count)
{
  const Eigen::Index step = std::max<Eigen::Index> (1, all.cols () / count);
  Eigen::Matrix3Xd result (3, (all.cols () + step - 1) / step);
  for (Eigen::Index n = 0; n < result.cols (); ++n)
    result.col (n) = all.col (n * step);
  return result;
}

} // namespace

OrientedColumns
OrientedColumns::few (Eigen::Index count) const
{
  return {everyFew (positions, count), everyFew (normals, count)};
}

double
thinnedSpacing (const std::vector<OrientedPoint>& points)
{
  return boxOf (points).sizes ().maxCoeff () / cells_along;
}

OrientedColumns
thinToCells (const std::vector<OrientedPoint>& points, double cell_m)
{
  struct Sum
  {
    Eigen::Vector3d position = Eigen::Vector3d::Zero (), normal = Eigen::Vector3d::Zero ();
    double count = 0.0;
  };
  const Eigen::Vector3d corner = boxOf (points).min ();
  OccupiedCells cells;
  std::vector<Sum> sums;
  for (const OrientedPoint& point : points)
  {
    const Eigen::Vector3d p = point.position.cast<double> ();
    const auto cell = cellOf ((p - corner) / cell_m);
    if (!cell)
      continue;
    const std::size_t n = cells.add (*cell);
    sums.resize (cells.size ());
    sums[n].position += p;
    sums[n].normal += point.normal.cast<double> ();
    sums[n].count += 1.0;
  }
  OrientedColumns result;
  result.positions.resize (3, static_cast<Eigen::Index> (sums.size ()));
  result.normals.resize (3, static_cast<Eigen::Index> (sums.size ()));
  for (std::size_t n = 0; n < sums.size (); ++n)
  {
    const auto column = static_cast<Eigen::Index> (n);
    result.positions.col (column) = sums[n].position / sums[n].count;
    result.normals.col (column) = sums[n].normal.normalized ();
  }
  return result;
}

double
spreadOf (const Eigen::Matrix3Xd& positions)
{
  return std::sqrt ((positions.colwise () - positions.rowwise ().mean ()).colwise ().squaredNorm ().mean ());
}

} // namespace pcl::cosection
