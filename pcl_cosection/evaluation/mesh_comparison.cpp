// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/evaluation/mesh_comparison.h>

#include "pcl_cosection/mesh/moved_mesh.h"
#include "pcl_cosection/volume/mesh_distance/mesh_surface.h"
#include "point_set.h"
#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

namespace pcl::cosection {

void
MeshComparisonOptions::validate () const
{
  if (samples < 1 || samples > static_cast<std::size_t> (std::numeric_limits<int>::max ()))
    throw InvalidArgument ("samples must be at least 1 and fit into 31 bits, but is " + std::to_string (samples));
  if (!(f_threshold_m > 0.0 && std::isfinite (f_threshold_m)))
    throw InvalidArgument ("f_threshold_m must be a positive number of metres");
  if (threads < 0)
    throw InvalidArgument ("threads must not be negative");
}

ErrorStatistics
errorStatistics (std::vector<double> values)
{
  ErrorStatistics result;
  if (values.empty ())
    return result;
  std::sort (values.begin (), values.end ());
  const auto quantile = [&values] (double share) {
    const double place = share * static_cast<double> (values.size () - 1);
    const auto below = static_cast<std::size_t> (place);
    const std::size_t above = std::min (below + 1, values.size () - 1);
    return values[below] + (place - static_cast<double> (below)) * (values[above] - values[below]);
  };
  double sum = 0.0, squares = 0.0;
  for (const double value : values)
  {
    sum += value;
    squares += value * value;
  }
  const auto count = static_cast<double> (values.size ());
  result.mean = sum / count;
  result.rmse = std::sqrt (squares / count);
  result.median = quantile (0.5);
  result.p95 = quantile (0.95);
  result.max = values.back ();
  return result;
}

MeshComparison
compareMeshes (const TriangleMesh& truth, const TriangleMesh& reconstruction, const MeshComparisonOptions& options)
{
  options.validate ();
  for (const auto& [mesh, name] : {std::pair (&truth, "truth"), std::pair (&reconstruction, "reconstruction")})
    if (isPointSet (*mesh))
      requirePoints (*mesh);
    else
      requireSurface (*mesh, name);
  const auto distances = [&] (const TriangleMesh& from, const TriangleMesh& to) {
    const std::vector<Eigen::Vector3d> points = isPointSet (from) ? somePoints (from, options.samples)
                                                                  : sampleSurface (from, options.samples, options.seed);
    return isPointSet (to) ? distancesToPoints (to, points, 1, options.threads)
                           : SurfaceDistance (to).of (points, options.threads);
  };
  const std::vector<double> to_truth = distances (reconstruction, truth);
  const std::vector<double> to_reconstruction = distances (truth, reconstruction);

  MeshComparison result;
  result.accuracy = errorStatistics (to_truth);
  result.completeness = errorStatistics (to_reconstruction);
  result.precision = shareWithin (to_truth, options.f_threshold_m);
  result.recall = shareWithin (to_reconstruction, options.f_threshold_m);
  if (result.precision + result.recall > 0.0)
    result.f_score = 2.0 * result.precision * result.recall / (result.precision + result.recall);
  return result;
}

MeshSummary
summarizeMesh (const TriangleMesh& mesh)
{
  MeshSummary summary;
  if (isPointSet (mesh))
  {
    summary.vertices = mesh.vertices.size ();
    summary.point_spacing_m = spacingOf (mesh);
    summary.box = vertexBox (mesh);
    return summary;
  }
  requireSurface (mesh, "summarizeMesh");
  summary.triangles = mesh.triangles.size ();
  summary.topology = computeTopology (mesh);
  summary.area_m2 = surfaceArea (mesh);
  if (summary.topology.closed_manifold)
    summary.volume_m3 = computeMassProperties (mesh).volume_m3;
  std::vector<bool> used (mesh.vertices.size (), false);
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t v : triangle)
      used[v] = true;
  for (std::size_t v = 0; v < used.size (); ++v)
    if (used[v])
    {
      ++summary.vertices;
      summary.box.extend (mesh.vertices[v].cast<double> ());
    }
  return summary;
}

std::vector<std::string>
frameWarnings (const MeshSummary& truth, const MeshSummary& reconstruction)
{
  std::vector<std::string> warnings;
  const double ratio = reconstruction.box.diagonal ().norm () / truth.box.diagonal ().norm ();
  constexpr double largest = 5.0;                // of what is seen of one thing, and the thing
  constexpr double least = 200.0, most = 5000.0; // around the factor of metres and millimetres
  if (const double factor = std::max (ratio, 1.0 / ratio); factor > largest && std::isfinite (factor))
  {
    const bool is_thousand = factor > least && factor < most;
    std::ostringstream text;
    text.precision (3);
    text << "the reconstruction is " << factor << " times as " << (ratio > 1.0 ? "large" : "small") << " as the truth: "
         << (is_thousand ? "one is in millimetres, the other in metres?" : "in another unit, or of another thing?");
    warnings.push_back (text.str ());
  }
  if (!truth.box.intersects (reconstruction.box))
    warnings.emplace_back ("the boxes of truth and reconstruction do not overlap: frames or units differ?");
  return warnings;
}

TriangleMesh
transformMesh (TriangleMesh mesh, const Eigen::Isometry3d& T_target_mesh)
{
  return movedMesh (std::move (mesh), T_target_mesh);
}

} // namespace pcl::cosection
