// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// compare_poisson CLOUD.pcd POISSON.ply [MESH.ply ...]: surface of one object by pcl::Poisson (depth 6, its defaults)
// from the same oriented points that pcl_cosection reads, and a row of a table for it and for each mesh given.

#include "completion/mesh_distance.h"
#include "rivals.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/mesh_io.h>
#include <pcl/cosection/io/pcd_view.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

using namespace pcl::cosection;

namespace {

constexpr double reach_m = 0.1;

std::vector<OrientedPoint>
readPoints (const std::string& path)
{
  const LabelledView view = readPcdView (path);
  for (const std::string& warning : view.warnings)
    std::cerr << warning << '\n';
  if (view.objects.size () != 1)
    throw DegenerateInput (path + " has several labels");
  return view.objects.begin ()->second.points;
}

/** \brief Farthest that \a mesh reaches beyond the box of the points, metres. */
double
reachBeyond (const TriangleMesh& mesh, const std::vector<OrientedPoint>& points)
{
  Eigen::AlignedBox3f box;
  for (const OrientedPoint& p : points)
    box.extend (p.position);
  float most = 0.0f;
  for (const Eigen::Vector3f& v : mesh.vertices)
    most = std::max ({most, (box.min () - v).maxCoeff (), (v - box.max ()).maxCoeff ()});
  return most;
}

void
printRow (const std::string& name, const TriangleMesh& mesh, const std::vector<OrientedPoint>& points)
{
  const test::MeshDistance distance (mesh, reach_m);
  std::vector<double> distances;
  for (const OrientedPoint& p : points)
    distances.push_back (distance (p.position.cast<double> ()));
  std::sort (distances.begin (), distances.end ());
  double sum = 0.0;
  for (const double d : distances)
    sum += d;
  const MeshTopology topology = computeTopology (mesh);
  std::printf ("| %s | %zu | %s | %d | %.2f | %.1f | %.1f | %.0f |\n", name.c_str (), mesh.triangles.size (),
               topology.closed_manifold ? "yes" : "no", topology.components,
               1e3 * computeMassProperties (mesh).volume_m3, 1e3 * sum / static_cast<double> (distances.size ()),
               1e3 * distances[distances.size () * 95 / 100], 1e3 * reachBeyond (mesh, points));
}

} // namespace

int
main (int argc, char** argv)
{
  if (argc < 3)
  {
    std::cerr << "Usage: compare_poisson CLOUD.pcd POISSON.ply [MESH.ply ...]\n";
    return 2;
  }
  try
  {
    const std::vector<OrientedPoint> points = readPoints (argv[1]);
    const TriangleMesh surface = test::poissonSurface (points);
    saveMesh (surface, argv[2]);
    std::printf ("| mesh | triangles | closed | parts | volume, litres | points to mesh, mean mm | 95 %%, mm | reach "
                 "beyond the points, mm |\n"
                 "|---|---|---|---|---|---|---|---|\n");
    printRow ("pcl::Poisson", surface, points);
    for (int i = 3; i < argc; ++i)
      printRow (argv[i], loadPlyMesh (argv[i]), points);
    return 0;
  }
  catch (const std::exception& error)
  {
    std::cerr << "compare_poisson: " << error.what () << '\n';
    return 1;
  }
}
