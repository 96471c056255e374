// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace pcl::cosection::test {

/** \brief One difference of the discrete Hessian as a linear functional of the field, and the weight of its
 * square in ||H u||_F^2. */
struct Difference
{
  double weight;
  std::vector<std::size_t> voxels;
  std::vector<double> coefficients;

  double operator() (const std::vector<double>& u) const
  {
    double sum = 0.0;
    for (std::size_t i = 0; i < voxels.size (); ++i)
      sum += coefficients[i] * u[voxels[i]];
    return sum;
  }
};

/** \brief The definition, difference by difference: D_aa at nodes interior along a, D_ab on 2x2 faces. */
inline std::vector<Difference>
hessianDifferences (const Eigen::Vector3i& dims)
{
  std::vector<Difference> out;
  const Eigen::Vector3i strides (1, dims.x (), dims.x () * dims.y ());
  for (int k = 0; k < dims.z (); ++k)
    for (int j = 0; j < dims.y (); ++j)
      for (int i = 0; i < dims.x (); ++i)
      {
        const Eigen::Vector3i at (i, j, k);
        const auto n = static_cast<std::size_t> (at.dot (strides));
        for (int a = 0; a < 3; ++a)
        {
          const std::size_t sa = strides[a];
          if (at[a] > 0 && at[a] + 1 < dims[a])
            out.push_back ({1.0, {n - sa, n, n + sa}, {1.0, -2.0, 1.0}});
          for (int b = a + 1; b < 3; ++b)
          {
            const std::size_t sb = strides[b];
            if (at[a] + 1 < dims[a] && at[b] + 1 < dims[b])
              out.push_back ({2.0, {n, n + sa, n + sb, n + sa + sb}, {1.0, -1.0, -1.0, 1.0}});
          }
        }
      }
  return out;
}

/** \brief ||H u||_F^2. */
inline double
hessianEnergy (const std::vector<Difference>& differences, const std::vector<double>& u)
{
  double sum = 0.0;
  for (const Difference& d : differences)
    sum += d.weight * d (u) * d (u);
  return sum;
}

/** \brief H^T H u. */
inline std::vector<double>
hessianProduct (const std::vector<Difference>& differences, const std::vector<double>& u)
{
  std::vector<double> out (u.size (), 0.0);
  for (const Difference& d : differences)
  {
    const double value = d.weight * d (u);
    for (std::size_t i = 0; i < d.voxels.size (); ++i)
      out[d.voxels[i]] += d.coefficients[i] * value;
  }
  return out;
}

} // namespace pcl::cosection::test
