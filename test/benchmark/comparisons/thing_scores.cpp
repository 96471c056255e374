// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "thing_scores.h"

#include <pcl/cosection/evaluation/mesh_comparison.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

using namespace pcl::cosection;

double
ThingScores::meanError () const
{
  return std::accumulate (errors_m.begin (), errors_m.end (), 0.0) / static_cast<double> (errors_m.size ());
}

double
ThingScores::worstError () const
{
  return *std::max_element (errors_m.begin (), errors_m.end ());
}

double
ThingScores::meanVolumeError () const
{
  double sum = 0.0;
  for (const double volume : volumes)
    sum += std::abs (volume - 1.0);
  return sum / static_cast<double> (volumes.size ());
}

void
measureThings (const SceneRecord& truth, const std::vector<ObjectResult>& meshes,
               std::map<std::string, ThingScores>& scores)
{
  for (const SceneRecord::Object& object : truth.objects)
  {
    const auto mesh = std::find_if (meshes.begin (), meshes.end (),
                                    [&] (const ObjectResult& r) { return r.id == object.id; });
    if (mesh == meshes.end () || mesh->mesh.empty () || object.mesh.empty ())
    {
      std::printf ("no mesh of %s\n", object.name.c_str ());
      continue;
    }
    const TriangleMesh true_mesh = transformMesh (object.mesh, object.poses.front ().pose);
    const MeshComparison comparison = compareMeshes (true_mesh, mesh->mesh);
    for (const std::string& row : {object.name, std::string ("all")})
    {
      scores[row].errors_m.push_back (0.5 * (comparison.accuracy.mean + comparison.completeness.mean));
      scores[row].volumes.push_back (computeMassProperties (mesh->mesh).volume_m3 /
                                     computeMassProperties (true_mesh).volume_m3);
    }
  }
}
