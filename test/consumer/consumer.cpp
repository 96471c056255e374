// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/version.h>
#include <pcl/cosection/volume/iso_surface.h>

#include <iostream>

/** \brief Signed distance of a sphere around the middle of a grid. */
pcl::cosection::SignedDistanceField
sphere (int resolution, double radius_m)
{
  pcl::cosection::SignedDistanceField field;
  field.grid.dims.setConstant (resolution);
  field.grid.voxel_size_m = 0.01;
  const Eigen::Vector3d centre = field.grid.center (resolution / 2, resolution / 2, resolution / 2);
  for (int k = 0; k < resolution; ++k)
    for (int j = 0; j < resolution; ++j)
      for (int i = 0; i < resolution; ++i)
        field.values.push_back (static_cast<float> ((field.grid.center (i, j, k) - centre).norm () - radius_m));
  return (field);
}

int
main ()
{
  const auto mesh = pcl::cosection::extractIsoSurface (sphere (32, 0.1));
  std::cout << "pcl_cosection " << PCL_COSECTION_VERSION << ": " << mesh.triangles.size () << " triangles\n";
  return (mesh.empty () ? 1 : 0);
}
