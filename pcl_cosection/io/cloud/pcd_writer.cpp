// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "pcd_writer.h"

#include <pcl/io/pcd_io.h>

namespace pcl::cosection {

std::string
encodePcd (const TriangleMesh& points)
{
  PolygonMesh mesh;
  toPolygonMesh (points, mesh);
  // PCL says what is in the file; it is not PCL that writes it, as its own report of a full disk says little.
  std::string bytes = PCDWriter ().generateHeaderBinary (mesh.cloud, Eigen::Vector4f::Zero (),
                                                         Eigen::Quaternionf::Identity ()) +
                      "DATA binary\n";
  return bytes.append (reinterpret_cast<const char*> (mesh.cloud.data.data ()), mesh.cloud.data.size ());
}

} // namespace pcl::cosection
