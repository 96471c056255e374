// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "hessian_rows.h"

#include <algorithm>

namespace pcl::cosection {

template <typename Real>
HessianOperator<Real>::HessianOperator (const Eigen::Vector3i& dims, int threads)
    : dims_ (dims)
    , threads_ (threadsForVoxels (threads, static_cast<std::size_t> (dims.x ()) * dims.y () * dims.z ()))
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const int n = dims[axis];
    auto& first = diagonal_first_[axis];
    auto& second = diagonal_second_[axis];
    first.assign (n, Real (0));
    second.assign (n, Real (0));
    for (int i = 0; i + 1 < n; ++i)
    {
      first[i] += 1;
      first[i + 1] += 1;
    }
    for (int i = 1; i + 1 < n; ++i)
    {
      second[i - 1] += 1;
      second[i] += 4;
      second[i + 1] += 1;
    }
  }
}

template <typename Real>
void
HessianOperator<Real>::apply (const std::vector<Real>& u, std::vector<Real>& out) const
{
  out.resize (u.size ());
  forEachRow (u.data (), [&] (int j, int k, const Real* values) {
    std::copy_n (values, dims_.x (), out.data () + (static_cast<std::size_t> (k) * dims_.y () + j) * dims_.x ());
  });
}

template <typename Real>
kernels::HessianDiagonal<Real>
HessianOperator<Real>::diagonal (int j, int k) const
{
  const Real ky = diagonal_first_[1][j];
  const Real kz = diagonal_first_[2][k];
  return {diagonal_first_[0].data (), diagonal_second_[0].data (), 2 * (ky + kz),
          diagonal_second_[1][j] + diagonal_second_[2][k] + 2 * ky * kz};
}

template <typename Real>
std::vector<Real>
HessianOperator<Real>::diagonal () const
{
  std::vector<Real> out;
  for (int k = 0; k < dims_.z (); ++k)
    for (int j = 0; j < dims_.y (); ++j)
    {
      const kernels::HessianDiagonal<Real> row = diagonal (j, k);
      for (int i = 0; i < dims_.x (); ++i)
        out.push_back (row.second[i] + row.slope * row.first[i] + row.constant);
    }
  return out;
}

template class HessianOperator<float>;
template class HessianOperator<double>;

} // namespace pcl::cosection
