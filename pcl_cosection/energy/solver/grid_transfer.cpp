// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "grid_transfer.h"

#include "pcl_cosection/common/parallel.h"
#include "row_kernels.h"

#include <algorithm>

namespace pcl::cosection {
namespace {

/** \brief Sum planes and rows of one level for every row of the other: \a finish (sums, index of the row's first voxel)
 * is what remains to be done along x.
 * \param[in] y, z the relatives of each voxel along these axes */
template <typename Real, typename Relatives, typename Finish>
void
transferRows (const Real* from, const Eigen::Vector3i& from_dims, const Eigen::Vector3i& to_dims, const Relatives& y,
              const Relatives& z, int threads, Finish&& finish)
{
  const std::size_t nx = from_dims.x ();
  const std::size_t plane_size = nx * from_dims.y ();
  parallelChunks (0, to_dims.z (), threads, [&] (int first, int last) {
    std::vector<Real> plane (plane_size);
    std::vector<Real> row (nx);
    for (int k = first; k < last; ++k)
    {
      std::fill (plane.begin (), plane.end (), Real (0));
      for (const auto& relative : z[k])
        kernels::addScaledRow (from + relative.voxel * plane_size, static_cast<Real> (relative.weight),
                               static_cast<int> (plane_size), plane.data ());
      for (int j = 0; j < to_dims.y (); ++j)
      {
        std::fill (row.begin (), row.end (), Real (0));
        for (const auto& relative : y[j])
          kernels::addScaledRow (plane.data () + relative.voxel * nx, static_cast<Real> (relative.weight),
                                 from_dims.x (), row.data ());
        finish (row, (static_cast<std::size_t> (k) * to_dims.y () + j) * to_dims.x ());
      }
    }
  });
}

} // namespace

AxisTransfer::AxisTransfer (int size, int keep)
    : fine_size (size)
    , coarse_size (size <= keep ? size : (size + 1) / 2)
    , children (coarse_size)
{
  for (int i = 0; i < size; ++i)
  {
    const bool kept = size <= keep;
    const int near = kept ? i : i / 2;
    int far = i % 2 ? near + 1 : near - 1;
    double near_weight = 0.75;
    double far_weight = 0.25;
    if (kept || coarse_size == 1)
    {
      far = near;
      near_weight = 1.0;
      far_weight = 0.0;
    }
    else if (far < 0 || far >= coarse_size)
    {
      // v_far = 2 v_near - v_opposite
      far = far < 0 ? near + 1 : near - 1;
      near_weight = 1.25;
      far_weight = -0.25;
    }
    parents.push_back ({Relative{near, near_weight}, Relative{far, far_weight}});
    children[near].push_back ({i, near_weight});
    if (far_weight != 0.0)
      children[far].push_back ({i, far_weight});
  }
}

template <typename Real> void GridTransfer::restrict(const Real* fine, Real* coarse, int threads) const
{
  transferRows (fine, fineDims (), coarseDims (), axes[1].children, axes[2].children, threads,
                [&] (const std::vector<Real>& row, std::size_t at) {
                  for (int i = 0; i < axes[0].coarse_size; ++i)
                  {
                    Real sum = 0;
                    for (const auto& child : axes[0].children[i])
                      sum += static_cast<Real> (child.weight) * row[child.voxel];
                    coarse[at + i] = sum;
                  }
                });
}

template <typename Real>
void
GridTransfer::prolongAdd (const Real* coarse, Real* fine, int threads) const
{
  transferRows (coarse, coarseDims (), fineDims (), axes[1].parents, axes[2].parents, threads,
                [&] (const std::vector<Real>& row, std::size_t at) {
                  for (int i = 0; i < axes[0].fine_size; ++i)
                  {
                    const auto& p = axes[0].parents[i];
                    fine[at + i] += static_cast<Real> (p[0].weight) * row[p[0].voxel] +
                                    static_cast<Real> (p[1].weight) * row[p[1].voxel];
                  }
                });
}

template void GridTransfer::restrict<float> (const float*, float*, int) const;
template void GridTransfer::restrict<double> (const double*, double*, int) const;
template void GridTransfer::prolongAdd<float> (const float*, float*, int) const;
template void GridTransfer::prolongAdd<double> (const double*, double*, int) const;

} // namespace pcl::cosection
