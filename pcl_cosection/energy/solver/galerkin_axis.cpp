// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "galerkin_axis.h"

#include <algorithm>
#include <cmath>

namespace pcl::cosection {
namespace {

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
  return axis;
}

GalerkinAxis
GalerkinAxis::shortened (int keep) const
{
  if (size <= keep)
    return *this;
  GalerkinAxis axis;
  axis.size = keep;
  const auto shorten = [&] (const Pentadiagonal& from, Pentadiagonal& to) {
    for (int d = 0; d < 5; ++d)
    {
      to[d].assign (from[d].begin (), from[d].begin () + keep / 2);
      to[d].insert (to[d].end (), from[d].end () - (keep - keep / 2), from[d].end ());
    }
  };
  shorten (mass, axis.mass);
  shorten (first, axis.first);
  shorten (second, axis.second);
  return axis;
}

} // namespace pcl::cosection
