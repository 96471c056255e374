// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "completion/mesh_distance.h"
#include "completion_scene.h"

#include <pcl/cosection/volume/iso_surface.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

namespace pcl::cosection::test {

/** \brief Sensor poses around the table, each far from those before it. */
inline Eigen::Isometry3d
around (int n)
{
  const double angle = 0.4 + n * 0.8 * M_PI;
  return lookAt ({0.45 * std::sin (angle), -0.45 * std::cos (angle), 0.28 + 0.03 * n}, {0.0, 0.0, 0.04});
}

/** \brief What one view from the front shows of a shape on the table. */
inline RenderedView
seenFromTheFront (const Distance& shape)
{
  AnalyticScene table;
  table.add (0, tableScene (Shape::Sphere).shape (0));
  table.add (1, shape);
  return table.render (tableCamera (), fromTheFront ());
}

/** \brief Complete object 1 of a scene from the views of several sensors. */
inline ObjectResult
completeFrom (const AnalyticScene& scene, const std::vector<int>& sensors, const CoSectionOptions& options)
{
  CoSection task (options);
  std::vector<OrientedPoint> object, background;
  for (const int n : sensors)
  {
    const RenderedView seen = scene.render (tableCamera (), around (n));
    task.addView (seen.view);
    const auto append = [&seen] (int label, std::vector<OrientedPoint>& points) {
      const auto found = seen.points.find (label);
      if (found != seen.points.end ())
        points.insert (points.end (), found->second.begin (), found->second.end ());
    };
    append (1, object);
    append (0, background);
  }
  if (!background.empty ())
    task.setBackground (background);
  task.addObject ({1, object, {}});
  return task.reconstruct ().objects.at (0);
}

/** \brief Mean distance of a mesh to the true surface and back, the larger of both, metres. */
inline double
meanError (const TriangleMesh& mesh, const Distance& truth)
{
  constexpr double reach_m = 0.04;
  double sum = 0.0, all = 0.0;
  for (const TriangleMesh::Triangle& t : mesh.triangles)
  {
    sum += area (mesh, t) * std::abs (truth (centroid (mesh, t)));
    all += area (mesh, t);
  }
  if (!(all > 0.0))
    return reach_m;
  const TriangleMesh surface = extractIsoSurface (sampleField (truth, 0.15, 0.004));
  return std::max (sum / all, meanDistance (surface, mesh, reach_m));
}

} // namespace pcl::cosection::test
