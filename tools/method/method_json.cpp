// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "method_json.h"

#include "method_options.h"

#include <pcl/cosection/common/triangle_mesh.h>

#include <array>

using namespace pcl::cosection;
using Json = nlohmann::ordered_json;

namespace {

Json
toJson (const Eigen::Vector3d& v)
{
  return (Json::array ({v.x (), v.y (), v.z ()}));
}

/** \brief Share of the vertices of each provenance. */
Json
provenanceShares (const TriangleMesh& mesh)
{
  std::array<std::size_t, 4> counts{};
  for (const std::uint8_t p : mesh.provenance)
    if (p < counts.size ())
      ++counts[p];
  const auto share = [&] (Provenance p) {
    return (mesh.provenance.empty () ? 0.0
                                     : static_cast<double> (counts[static_cast<std::size_t> (p)]) /
                                           static_cast<double> (mesh.provenance.size ()));
  };
  return (Json{{"observed", share (Provenance::Observed)},
               {"inferred", share (Provenance::Inferred)},
               {"hull", share (Provenance::Hull)},
               {"intersection", share (Provenance::Intersection)}});
}

} // namespace

Json
solverJson (const SolverSummary& solver)
{
  return (Json{{"iterations", solver.iterations}, {"converged", solver.converged ()}, {"energy", solver.energy}});
}

Json
objectJson (const ObjectResult& object)
{
  const MeshTopology topology = computeTopology (object.mesh);
  const MassProperties mass = computeMassProperties (object.mesh);
  Json result;
  result["id"] = object.id;
  result["label"] = object.id;
  if (object.signed_distance)
  {
    const VoxelGrid& grid = object.signed_distance->grid;
    result["voxel_size_m"] = grid.voxel_size_m;
    result["dimensions"] = {grid.dims.x (), grid.dims.y (), grid.dims.z ()};
  }
  result["vertices"] = object.mesh.vertices.size ();
  result["closed"] = topology.closed_manifold;
  result["euler"] = topology.euler;
  result["volume_m3"] = mass.volume_m3;
  result["centroid_m"] = toJson (mass.centroid_m);
  result["inertia"] = Json::array (
      {toJson (mass.inertia.row (0)), toJson (mass.inertia.row (1)), toJson (mass.inertia.row (2))});
  result["provenance"] = provenanceShares (object.mesh);
  result["penetration_m"] = object.penetration_m;
  result["outlier_points"] = object.outlier_points;
  result["contradicted_share"] = object.contradicted_share;
  if (object.guessed_plane)
    result["guessed_plane"] = std::vector<double> (object.guessed_plane->data (), object.guessed_plane->data () + 4);
  result["solver"] = solverJson (object.solver);
  return (result);
}

void
addMethod (const CoSectionOptions& method, Json& result)
{
  result["voxel_size_m"] = method.voxel_size_m;
  result["resolution"] = method.resolution;
  result["padding"] = method.padding;
  result["background_voxel_size_m"] = method.background_voxel_size_m;
  result["constraints"] = constraintsOf (method);
  result["find_planes"] = method.use_planes;
  result["alpha"] = method.alpha;
  result["beta_hull"] = method.beta_hull;
  result["beta_inter"] = method.beta_inter;
  result["sigma_vox"] = method.sigma_vox;
  result["weighting"] = method.weighting == Weighting::Sum ? "sum" : "mean";
  result["solver"] = method.solver.type == SolverType::FastJacobi ? "fast-jacobi" : "multigrid";
  result["max_iterations"] = method.solver.max_iterations;
  result["tolerance_vox"] = method.solver.tolerance_vox;
  result["threads"] = method.threads;
  result["max_memory_bytes"] = method.max_memory_bytes;
}
