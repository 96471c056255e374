// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/export.h>

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief A regular grid of cubic voxels, axis-aligned in its reference frame. Values live at voxel
 * centres; x varies fastest. */
struct VoxelGrid
{
  Eigen::Vector3i dims = Eigen::Vector3i::Zero ();     ///< voxels along x, y, z
  double voxel_size_m = 0.0;                           ///< edge of a voxel
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero (); ///< centre of voxel (0, 0, 0)

  /** \brief Number of voxels. */
  std::size_t size () const { return static_cast<std::size_t> (dims.x ()) * dims.y () * dims.z (); }

  /** \brief Position of voxel (i, j, k) in arrays of one value per voxel. */
  std::size_t index (int i, int j, int k) const
  {
    return (static_cast<std::size_t> (k) * dims.y () + j) * dims.x () + i;
  }

  /** \brief Centre of voxel (i, j, k), metres, in the reference frame. */
  Eigen::Vector3d center (int i, int j, int k) const { return origin_m + voxel_size_m * Eigen::Vector3d (i, j, k); }

  /** \brief Continuous voxel coordinates; voxel (i, j, k) has its centre at (i, j, k). */
  Eigen::Vector3d toVoxel (const Eigen::Vector3d& p) const { return (p - origin_m) / voxel_size_m; }

  /** \brief The voxel with the nearest centre; nothing outside the grid, however far, and for NaN. */
  std::optional<Eigen::Vector3i> nearest (const Eigen::Vector3d& p) const
  {
    const Eigen::Array3d v = toVoxel (p).array ();
    if (!((v >= -0.5).all () && (v < dims.cast<double> ().array () - 0.5).all ()))
      return std::nullopt;
    return Eigen::Vector3i ((v + 0.5).cast<int> ().min (dims.array () - 1)); // none is negative
  }

  /** \brief Whether voxel (i, j, k) is in the grid. */
  bool contains (int i, int j, int k) const
  {
    return i >= 0 && j >= 0 && k >= 0 && i < dims.x () && j < dims.y () && k < dims.z ();
  }
};

/** \brief A signed distance sampled on a grid: metres, positive outside, negative inside. */
struct PCL_COSECTION_EXPORT SignedDistanceField
{
  /** \brief Shared pointer. */
  using Ptr = std::shared_ptr<SignedDistanceField>;
  /** \brief Shared pointer to what is constant. */
  using ConstPtr = std::shared_ptr<const SignedDistanceField>;

  VoxelGrid grid;                      ///< where the values are
  std::vector<float> values;           ///< metres, one per voxel
  std::vector<std::uint8_t> supported; ///< 1 where the value is evidence rather than extrapolation; empty: everywhere

  /** \brief Trilinear interpolation at \a p (metres, the grid's frame); nothing outside the voxel
   * centres' box. */
  std::optional<float> sample (const Eigen::Vector3d& p) const;

  /** \brief As sample (), at voxel coordinates. */
  std::optional<float> sampleVoxel (const Eigen::Vector3d& v) const;

  /** \brief As sample (), and nothing where the nearest voxel is not supported. */
  std::optional<float> sampleSupported (const Eigen::Vector3d& p) const;

  /** \brief As sampleSupported (), but only values below zero, at voxel coordinates; quick where there are none. Of a
   * field that grows by no more than three times the distance. */
  std::optional<float> sampleInside (const Eigen::Vector3d& v) const;

  /** \brief Whether sampleInside () may have a value where voxel \a n is the nearest. */
  bool mayBeInside (std::size_t n) const
  {
    constexpr float surely_outside_voxels = 3.0f; // that a value must exceed for all around it to be positive: more
                                                  // than a cell's diagonal
    return (supported.empty () || supported[n] != 0) &&
           !(values[n] > surely_outside_voxels * static_cast<float> (grid.voxel_size_m));
  }
};

/** \brief The eight voxels around a point, and the trilinear function between their centres.
 *
 * It needs a number at all eight, so that the gradient exists with the value; SignedDistanceField::sample () makes do
 * with fewer on a cell's faces. All inline: for loops over many points.
 *
 * \code
 * if (const auto cell = TrilinearCell<double>::around (field, p))
 *   minimise (cell->value (), cell->gradient ());
 * \endcode */
template <typename Scalar> class TrilinearCell
{
public:
  /** \brief A point, or a gradient. */
  using Vector3 = Eigen::Matrix<Scalar, 3, 1>;

  /** \brief The cell around \a p (metres, the grid's frame): nothing outside the box of voxel centres, for NaN, where
   * the grid is a single voxel thin, or where one of the eight values is not finite. */
  static std::optional<TrilinearCell> around (const SignedDistanceField& field, const Vector3& p)
  {
    const VoxelGrid& grid = field.grid;
    const Eigen::Vector3d v = grid.toVoxel (p.template cast<double> ());
    TrilinearCell cell;
    std::array<int, 3> lower;
    for (int axis = 0; axis < 3; ++axis)
    {
      const int last = grid.dims[axis] - 1;
      if (!(v[axis] >= 0.0 && v[axis] <= last) || last < 1)
        return std::nullopt;
      const auto below = static_cast<int> (v[axis]);
      lower[axis] = (below < last ? below : last - 1);
      cell.fraction_[axis] = static_cast<Scalar> (v[axis] - lower[axis]);
    }
    const std::size_t row = static_cast<std::size_t> (grid.dims.x ());
    const std::size_t slice = row * grid.dims.y ();
    const float* corner = field.values.data () + grid.index (lower[0], lower[1], lower[2]);
    for (int n = 0; n < 4; ++n)
    {
      const float* pair = corner + (n & 1) * row + (n >> 1) * slice;
      cell.lower_x_[n] = static_cast<Scalar> (pair[0]);
      cell.step_x_[n] = static_cast<Scalar> (pair[1]) - cell.lower_x_[n];
    }
    cell.voxel_size_m_ = static_cast<Scalar> (grid.voxel_size_m);
    if (!std::isfinite (cell.value ())) // of finite values it is finite; 0 * NaN is not
      return std::nullopt;
    return cell;
  }

  /** \brief In the field's unit (metres). */
  Scalar value () const
  {
    const auto edge = alongX ();
    return mix (mix (edge[0], edge[1], fraction_[1]), mix (edge[2], edge[3], fraction_[1]), fraction_[2]);
  }

  /** \brief Derivative of value () by the point: metres per metre, in the grid's frame. Not normalised. */
  Vector3 gradient () const
  {
    const auto edge = alongX ();
    const Scalar dx = mix (mix (step_x_[0], step_x_[1], fraction_[1]), mix (step_x_[2], step_x_[3], fraction_[1]),
                           fraction_[2]);
    const Scalar dy = mix (edge[1] - edge[0], edge[3] - edge[2], fraction_[2]);
    const Scalar dz = mix (edge[2] - edge[0], edge[3] - edge[1], fraction_[1]);
    return Vector3 (dx, dy, dz) / voxel_size_m_;
  }

private:
  /** \brief Values at the four edges along x. */
  std::array<Scalar, 4> alongX () const
  {
    std::array<Scalar, 4> edge;
    for (int n = 0; n < 4; ++n)
      edge[n] = lower_x_[n] + fraction_[0] * step_x_[n];
    return edge;
  }

  static Scalar mix (Scalar a, Scalar b, Scalar t) { return a + t * (b - a); }

  std::array<Scalar, 3> fraction_;
  std::array<Scalar, 4> lower_x_; // where the edges along x begin: (y, z), (y + 1, z), (y, z + 1), (y + 1, z + 1)
  std::array<Scalar, 4> step_x_;
  Scalar voxel_size_m_ = 1;
};

} // namespace pcl::cosection
