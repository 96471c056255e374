// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "grid_transfer.h"

#include <array>
#include <vector>

namespace pcl::cosection {

/** \brief A symmetric matrix of half bandwidth two along one axis: entry [d][i] couples i and
 * i + d - 2; entries that would reach over the border are 0. */
using Pentadiagonal = std::array<std::vector<double>, 5>;

/** \brief The one-dimensional factors of the Hessian's Gram matrix along one axis of one level.
 *
 *     H^T H = K2 x M x M + M x K2 x M + M x M x K2 + 2 (K1 x K1 x M + K1 x M x K1 + M x K1 x K1)
 *
 * with M = identity, K1 = first and K2 = second differences' Gram matrix on the finest level. For a
 * tensor-product interpolation the Galerkin product P^T (H^T H) P keeps that form with P^T M P,
 * P^T K1 P and P^T K2 P, which all stay pentadiagonal: the exact coarse operator costs three banded
 * matrices an axis, and no stored stencil. */
struct GalerkinAxis
{
  int size = 0;
  Pentadiagonal mass, first, second;
  /** \brief The factors of an axis of \a size voxels on the finest level. */
  static GalerkinAxis finest (int size);

  /** \brief The factors on the next coarser level. */
  GalerkinAxis coarsen (const AxisTransfer& transfer) const;

  /** \brief An axis of at most \a size voxels with the same rows near its borders; rows in the middle, which are all
   * alike, are removed. For local quantities. */
  GalerkinAxis shortened (int size) const;
};

} // namespace pcl::cosection
