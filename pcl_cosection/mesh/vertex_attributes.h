// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/triangle_mesh.h>

#include <cmath>
#include <cstdint>
#include <tuple>
#include <vector>

namespace pcl::cosection {

/** \brief The per-vertex arrays of \a mesh that belong to the material and not to the geometry. One to be added is
 * named here only. */
inline auto
vertexAttributes (TriangleMesh& mesh)
{
  return std::tie (mesh.colours, mesh.intensity, mesh.confidence, mesh.provenance);
}

/** \brief Value at the fraction \a t of the way from \a a to \a b. */
inline float
blended (float a, float b, double t)
{
  return static_cast<float> ((1.0 - t) * a + t * b);
}

inline TriangleMesh::Colour
blended (const TriangleMesh::Colour& a, const TriangleMesh::Colour& b, double t)
{
  TriangleMesh::Colour result;
  for (std::size_t channel = 0; channel < result.size (); ++channel)
    result[channel] = static_cast<std::uint8_t> (std::lround ((1.0 - t) * a[channel] + t * b[channel]));
  return result;
}

/** \brief Names of kinds, like Provenance, have nothing between them: that of the nearer end. */
inline std::uint8_t
blended (std::uint8_t a, std::uint8_t b, double t)
{
  return t <= 0.5 ? a : b;
}

/** \brief Give vertex \a u the attributes at the fraction \a t of the way from \a u to \a v. */
inline void
blendAttributes (TriangleMesh& mesh, std::uint32_t u, std::uint32_t v, double t)
{
  const auto blend = [=] (auto& values) {
    if (!values.empty ())
      values[u] = blended (values[u], values[v], t);
  };
  std::apply ([&] (auto&... arrays) { (blend (arrays), ...); }, vertexAttributes (mesh));
}

/** \brief Keep the attributes of the vertices in \a kept (ascending), in that order. */
inline void
keepAttributes (TriangleMesh& mesh, const std::vector<std::uint32_t>& kept)
{
  const auto compact = [&kept] (auto& values) {
    if (values.empty ())
      return;
    for (std::size_t n = 0; n < kept.size (); ++n)
      values[n] = values[kept[n]];
    values.resize (kept.size ());
    values.shrink_to_fit ();
  };
  std::apply ([&] (auto&... arrays) { (compact (arrays), ...); }, vertexAttributes (mesh));
}

} // namespace pcl::cosection
