// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "pcl_cosection/common/parallel.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/volume/iso_surface.h>
#include <pcl/cosection/volume/tsdf_volume.h>

namespace pcl::cosection {
namespace {

constexpr TriangleMesh::Colour colour_unknown = {128, 128, 128};

} // namespace

TriangleMesh
TsdfVolume::surfaceMesh (double min_weight) const
{
  if (!(min_weight >= 0.0))
    throw InvalidArgument ("TSDF volume: the least weight of a surface must not be negative");
  std::vector<std::uint8_t> supported (grid ().size ());
  const std::size_t slice = static_cast<std::size_t> (grid ().dims.x ()) * grid ().dims.y ();
  parallelFor (0, grid ().dims.z (), threadsForVoxels (options_.threads, grid ().size ()), [&] (int k) {
    for (std::size_t v = k * slice; v < (k + 1) * slice; ++v)
      supported[v] = static_cast<std::uint8_t> (weights_[v] > 0.0f && weights_[v] >= min_weight);
  });
  TriangleMesh mesh = extractOpenIsoSurface (field_, supported, options_.threads);
  if (!colours_.empty ())
  {
    mesh.colours.resize (mesh.vertices.size ());
    parallelFor (0, static_cast<int> (mesh.vertices.size ()), options_.threads, [&] (int v) {
      mesh.colours[v] = colour (mesh.vertices[v].cast<double> ()).value_or (colour_unknown);
    });
  }
  return mesh;
}

} // namespace pcl::cosection
