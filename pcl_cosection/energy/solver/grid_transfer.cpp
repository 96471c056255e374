// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "grid_transfer.h"

#include "row_kernels.h"

#include "pcl_cosection/common/parallel.h"

#include <algorithm>

namespace pcl::cosection {

AxisTransfer
AxisTransfer::make (int size, int keep)
{
  AxisTransfer t;
  t.fine_size = size;
  if (size <= keep)
  {
    t.coarse_size = size;
    for (int i = 0; i < size; ++i)
    {
      t.parents.push_back ({Parent{i, 1.0}, Parent{i, 0.0}});
      t.children.push_back ({Child{i, 1.0}});
    }
    return t;
  }
  const int n = (size + 1) / 2;
  t.coarse_size = n;
  t.children.resize (n);
  for (int i = 0; i < size; ++i)
  {
    const int near = i / 2;
    int far = i % 2 ? near + 1 : near - 1;
    double near_weight = 0.75;
    double far_weight = 0.25;
    if (n == 1)
    {
      far = near;
      near_weight = 1.0;
      far_weight = 0.0;
    }
    else if (far < 0 || far >= n)
    {
      // v_far = 2 v_near - v_opposite
      far = far < 0 ? near + 1 : near - 1;
      near_weight = 1.25;
      far_weight = -0.25;
    }
    t.parents.push_back ({Parent{near, near_weight}, Parent{far, far_weight}});
    t.children[near].push_back ({i, near_weight});
    if (far_weight != 0.0)
      t.children[far].push_back ({i, far_weight});
  }
  return t;
}

GridTransfer::GridTransfer (const Eigen::Vector3i& fine_dims, int keep)
{
  for (int a = 0; a < 3; ++a)
    axes[a] = AxisTransfer::make (fine_dims[a], keep);
}

template <typename Real> void GridTransfer::restrict(const Real* fine, Real* coarse, int threads) const
{
  const Eigen::Vector3i f = fineDims ();
  const Eigen::Vector3i c = coarseDims ();
  const std::size_t fine_plane = static_cast<std::size_t> (f.x ()) * f.y ();
  parallelChunks (0, c.z (), threads, [&] (int first, int last) {
    std::vector<Real> plane (fine_plane);
    std::vector<Real> row (f.x ());
    for (int k = first; k < last; ++k)
    {
      std::fill (plane.begin (), plane.end (), Real (0));
      for (const auto& child : axes[2].children[k])
        kernels::addScaledRow (fine + child.fine * fine_plane, static_cast<Real> (child.weight),
                               static_cast<int> (fine_plane), plane.data ());
      for (int j = 0; j < c.y (); ++j)
      {
        std::fill (row.begin (), row.end (), Real (0));
        for (const auto& child : axes[1].children[j])
          kernels::addScaledRow (plane.data () + static_cast<std::size_t> (child.fine) * f.x (),
                                 static_cast<Real> (child.weight), f.x (), row.data ());
        Real* out = coarse + (static_cast<std::size_t> (k) * c.y () + j) * c.x ();
        for (int i = 0; i < c.x (); ++i)
        {
          Real sum = 0;
          for (const auto& child : axes[0].children[i])
            sum += static_cast<Real> (child.weight) * row[child.fine];
          out[i] = sum;
        }
      }
    }
  });
}

template <typename Real>
void
GridTransfer::prolongAdd (const Real* coarse, Real* fine, int threads) const
{
  const Eigen::Vector3i f = fineDims ();
  const Eigen::Vector3i c = coarseDims ();
  const std::size_t fine_plane = static_cast<std::size_t> (f.x ()) * f.y ();
  const std::size_t coarse_plane = static_cast<std::size_t> (c.x ()) * c.y ();
  parallelChunks (0, f.z (), threads, [&] (int first, int last) {
    std::vector<Real> plane (coarse_plane);
    std::vector<Real> row (c.x ());
    for (int k = first; k < last; ++k)
    {
      std::fill (plane.begin (), plane.end (), Real (0));
      for (const auto& parent : axes[2].parents[k])
        kernels::addScaledRow (coarse + parent.coarse * coarse_plane, static_cast<Real> (parent.weight),
                               static_cast<int> (coarse_plane), plane.data ());
      for (int j = 0; j < f.y (); ++j)
      {
        std::fill (row.begin (), row.end (), Real (0));
        for (const auto& parent : axes[1].parents[j])
          kernels::addScaledRow (plane.data () + static_cast<std::size_t> (parent.coarse) * c.x (),
                                 static_cast<Real> (parent.weight), c.x (), row.data ());
        Real* out = fine + k * fine_plane + static_cast<std::size_t> (j) * f.x ();
        for (int i = 0; i < f.x (); ++i)
        {
          const auto& p = axes[0].parents[i];
          out[i] += static_cast<Real> (p[0].weight) * row[p[0].coarse] +
                    static_cast<Real> (p[1].weight) * row[p[1].coarse];
        }
      }
    }
  });
}

template void GridTransfer::restrict<float> (const float*, float*, int) const;
template void GridTransfer::restrict<double> (const double*, double*, int) const;
template void GridTransfer::prolongAdd<float> (const float*, float*, int) const;
template void GridTransfer::prolongAdd<double> (const double*, double*, int) const;

} // namespace pcl::cosection
