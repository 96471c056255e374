// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "row_kernels.h"

#include "hessian_operator.h"
#include "pcl_cosection/common/parallel.h"

namespace pcl::cosection {

template <typename Real>
template <typename RowFunction>
void
HessianOperator<Real>::forEachRow (const Real* u, RowFunction&& row) const
{
  forEachRow (u, row, [] (int) {});
}

template <typename Real>
template <typename RowFunction, typename PlaneFunction>
void
HessianOperator<Real>::forEachRow (const Real* u, RowFunction&& row, PlaneFunction&& finished) const
{
  const int nx = dims_.x ();
  const int ny = dims_.y ();
  const int nz = dims_.z ();
  const std::size_t plane = static_cast<std::size_t> (nx) * ny;

  // Rows of a volume or of a ring of planes; a missing neighbour is replaced by the row itself, so
  // that its difference vanishes (natural boundary).
  const auto neighbours = [&] (const Real* below, const Real* here, const Real* above, int j) {
    const std::size_t offset = static_cast<std::size_t> (j) * nx;
    kernels::RowNeighbours<Real> rows;
    rows.center = here + offset;
    rows.y_minus = j > 0 ? rows.center - nx : rows.center;
    rows.y_plus = j < ny - 1 ? rows.center + nx : rows.center;
    rows.z_minus = below ? below + offset : rows.center;
    rows.z_plus = above ? above + offset : rows.center;
    return rows;
  };

  // A plane is needed until the row after it is done, and by the neighbouring chunk if it is one of the
  // two next to it.
  std::vector<std::uint8_t> pending (nz, 1);
  parallelChunks (0, nz, threads_, [&] (int first, int last) {
    const int first_own = first > 0 ? first + 2 : 0;
    const int last_own = last < nz ? last - 2 : nz;
    const auto finish = [&] (int k) {
      if (k < first_own || k >= last_own)
        return;
      finished (k);
      pending[k] = 0;
    };
    std::vector<Real> ring (3 * plane);
    std::vector<Real> out (nx);
    const auto laplacian = [&] (int k) { return ring.data () + ((k + 3) % 3) * plane; };
    const auto laplacianOfPlane = [&] (int k) {
      const Real* here = u + k * plane;
      for (int j = 0; j < ny; ++j)
        kernels::laplaceRow (neighbours (k > 0 ? here - plane : nullptr, here, k < nz - 1 ? here + plane : nullptr, j),
                             nx, laplacian (k) + static_cast<std::size_t> (j) * nx);
    };
    if (first > 0)
      laplacianOfPlane (first - 1);
    laplacianOfPlane (first);
    for (int k = first; k < last; ++k)
    {
      if (k < nz - 1)
        laplacianOfPlane (k + 1);
      for (int j = 0; j < ny; ++j)
      {
        kernels::laplaceRow (neighbours (k > 0 ? laplacian (k - 1) : nullptr, laplacian (k),
                                         k < nz - 1 ? laplacian (k + 1) : nullptr, j),
                             nx, out.data ());
        const Real* c = u + k * plane + static_cast<std::size_t> (j) * nx;
        const auto correct = [&] (int i, int n, std::ptrdiff_t stride) {
          // Rows 0, 1 and n - 2, n - 1 of B along y or z.
          if (n < 2)
            return;
          if (i == 0)
            kernels::subtractDifference (c, c + stride, nx, out.data ());
          if (i == 1)
            kernels::subtractDifference (c, c - stride, nx, out.data ());
          if (i == n - 2)
            kernels::subtractDifference (c, c + stride, nx, out.data ());
          if (i == n - 1)
            kernels::subtractDifference (c, c - stride, nx, out.data ());
        };
        correct (j, ny, nx);
        correct (k, nz, static_cast<std::ptrdiff_t> (plane));
        if (nx >= 2)
        {
          const Real begin = c[0] - c[1];
          out[0] -= begin;
          out[1] += begin;
          const Real end = c[nx - 1] - c[nx - 2];
          out[nx - 1] -= end;
          out[nx - 2] += end;
        }
        row (j, k, const_cast<const Real*> (out.data ()));
      }
      finish (k - 1);
    }
    finish (last - 1);
  });
  for (int k = 0; k < nz; ++k)
    if (pending[k])
      finished (k);
}

} // namespace pcl::cosection
