// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/triangle_mesh.h>

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <cstdint>

namespace pcl::cosection {

/** \brief The mean of a mesh's colours. */
inline TriangleMesh::Colour
meanColour (const TriangleMesh& mesh, const TriangleMesh::Colour& otherwise)
{
  if (mesh.colours.empty ())
    return otherwise;
  std::array<double, 3> sum{};
  for (const TriangleMesh::Colour& colour : mesh.colours)
    for (int c = 0; c < 3; ++c)
      sum[c] += colour[c];
  TriangleMesh::Colour mean{};
  for (int c = 0; c < 3; ++c)
    mean[c] = static_cast<std::uint8_t> (std::lround (sum[c] / static_cast<double> (mesh.colours.size ())));
  return mean;
}

} // namespace pcl::cosection
