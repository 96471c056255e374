// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "galerkin_axis.h"

#include <algorithm>
#include <cmath>

namespace pcl
{
namespace cosection
{

namespace
{

Pentadiagonal
zeros (int size)
{
  Pentadiagonal m;
  for (auto& diagonal : m)
    diagonal.assign (size, 0.0);
  return m;
}

Pentadiagonal
galerkin (const Pentadiagonal& fine, const AxisTransfer& transfer)
{
  Pentadiagonal coarse = zeros (transfer.coarse_size);
  for (int x = 0; x < transfer.fine_size; ++x)
    for (int d = 0; d < 5; ++d)
    {
      const int y = x + d - 2;
      if (y < 0 || y >= transfer.fine_size)
        continue;
      for (const auto& p : transfer.parents[x])
        for (const auto& q : transfer.parents[y])
          if (p.weight != 0.0 && q.weight != 0.0)
            coarse[q.coarse - p.coarse + 2][p.coarse] += p.weight * q.weight * fine[d][x];
    }
  return coarse;
}

std::array<double, 5>
interiorGalerkin (const std::array<double, 5>& fine)
{
  // A coarse voxel I reaches the fine voxels 2 I - 1 ... 2 I + 2.
  constexpr std::array<double, 4> p{0.25, 0.75, 0.75, 0.25};
  std::array<double, 5> coarse{};
  for (int delta = -2; delta <= 2; ++delta)
    for (int s = 0; s < 4; ++s)
      for (int t = 0; t < 4; ++t)
      {
        const int offset = 2 * delta + t - s;
        if (std::abs (offset) <= 2)
          coarse[delta + 2] += p[s] * p[t] * fine[offset + 2];
      }
  return coarse;
}

double
symbol (const std::array<double, 5>& row, double theta)
{
  return row[2] + 2.0 * row[3] * std::cos (theta) + 2.0 * row[4] * std::cos (2.0 * theta);
}

} // namespace

GalerkinAxis
GalerkinAxis::finest (int size)
{
  GalerkinAxis axis;
  axis.size = size;
  axis.mass = axis.first = axis.second = zeros (size);
  for (int i = 0; i < size; ++i)
    axis.mass[2][i] = 1.0;
  for (int i = 0; i + 1 < size; ++i)
  {
    axis.first[2][i] += 1.0;
    axis.first[2][i + 1] += 1.0;
    axis.first[3][i] -= 1.0;
    axis.first[1][i + 1] -= 1.0;
  }
  constexpr std::array<double, 3> difference{1.0, -2.0, 1.0};
  for (int i = 1; i + 1 < size; ++i)
    for (int s = -1; s <= 1; ++s)
      for (int t = -1; t <= 1; ++t)
        axis.second[t - s + 2][i + s] += difference[s + 1] * difference[t + 1];
  axis.interior_mass = {0.0, 0.0, 1.0, 0.0, 0.0};
  axis.interior_first = {0.0, -1.0, 2.0, -1.0, 0.0};
  axis.interior_second = {1.0, -4.0, 6.0, -4.0, 1.0};
  return axis;
}

GalerkinAxis
GalerkinAxis::coarsen (const AxisTransfer& transfer) const
{
  if (transfer.coarse_size == transfer.fine_size)
    return *this;
  GalerkinAxis axis;
  axis.size = transfer.coarse_size;
  axis.mass = galerkin (mass, transfer);
  axis.first = galerkin (first, transfer);
  axis.second = galerkin (second, transfer);
  axis.interior_mass = interiorGalerkin (interior_mass);
  axis.interior_first = interiorGalerkin (interior_first);
  axis.interior_second = interiorGalerkin (interior_second);
  return axis;
}

double
largestSymbol (const std::array<GalerkinAxis, 3>& axes)
{
  constexpr int samples = 16;
  const auto combine = [] (const std::array<double, 3>& m, const std::array<double, 3>& k1,
                           const std::array<double, 3>& k2) {
    return k2[0] * m[1] * m[2] + m[0] * k2[1] * m[2] + m[0] * m[1] * k2[2] +
           2.0 * (k1[0] * k1[1] * m[2] + k1[0] * m[1] * k1[2] + m[0] * k1[1] * k1[2]);
  };
  const double diagonal = combine ({axes[0].interior_mass[2], axes[1].interior_mass[2], axes[2].interior_mass[2]},
                                   {axes[0].interior_first[2], axes[1].interior_first[2], axes[2].interior_first[2]},
                                   {axes[0].interior_second[2], axes[1].interior_second[2], axes[2].interior_second[2]});
  double largest = 0.0;
  for (int i = 0; i <= samples; ++i)
    for (int j = 0; j <= samples; ++j)
      for (int k = 0; k <= samples; ++k)
      {
        const std::array<double, 3> theta{M_PI * i / samples, M_PI * j / samples, M_PI * k / samples};
        std::array<double, 3> m{}, k1{}, k2{};
        for (int a = 0; a < 3; ++a)
        {
          m[a] = symbol (axes[a].interior_mass, theta[a]);
          k1[a] = symbol (axes[a].interior_first, theta[a]);
          k2[a] = symbol (axes[a].interior_second, theta[a]);
        }
        largest = std::max (largest, combine (m, k1, k2));
      }
  return largest / diagonal;
}

} // namespace cosection
} // namespace pcl
