// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <array>
#include <vector>

namespace pcl::cosection {

/** \brief Linear interpolation along one axis between cell-centred grids, a coarse voxel covering
 * two fine ones; linear extrapolation at the border, so that affine functions are reproduced exactly.
 *
 * The same weights are the refinement rule of quadratic B-splines: a coarse value is the coefficient
 * of a basis function of bounded second derivative, which a Galerkin operator of fourth order needs. */
struct AxisTransfer
{
  /** \brief A voxel of the other level. */
  struct Relative
  {
    int voxel;
    double weight;
  };

  int fine_size;
  int coarse_size;
  std::vector<std::array<Relative, 2>> parents; ///< per fine voxel
  std::vector<std::vector<Relative>> children;  ///< per coarse voxel

  /** \brief Halve an axis of \a size voxels, or keep it if it has no more than \a keep. */
  AxisTransfer (int size, int keep);
};

/** \brief Tensor product of three axis transfers. */
struct GridTransfer
{
  std::array<AxisTransfer, 3> axes;

  /** \param[in] keep axes of no more voxels are not coarsened */
  GridTransfer (const Eigen::Vector3i& fine, int keep) : axes{{{fine.x (), keep}, {fine.y (), keep}, {fine.z (), keep}}}
  {}

  Eigen::Vector3i fineDims () const { return {axes[0].fine_size, axes[1].fine_size, axes[2].fine_size}; }

  Eigen::Vector3i coarseDims () const { return {axes[0].coarse_size, axes[1].coarse_size, axes[2].coarse_size}; }

  /** \brief coarse = P^T fine. */
  template <typename Real> void restrict(const Real* fine, Real* coarse, int threads) const;

  /** \brief fine += P coarse. */
  template <typename Real> void prolongAdd (const Real* coarse, Real* fine, int threads) const;
};

} // namespace pcl::cosection
