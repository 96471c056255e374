// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "method_json.h"

#include "method_options.h"
#include "output_files.h"

#include <pcl/cosection/common/triangle_mesh.h>

#include <algorithm>
#include <numeric>
#include <utility>

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
  Json shares;
  for (const auto& [name, kind] :
       {std::pair ("observed", Provenance::Observed), std::pair ("inferred", Provenance::Inferred),
        std::pair ("hull", Provenance::Hull), std::pair ("intersection", Provenance::Intersection)})
    shares[name] = mesh.provenance.empty ()
                       ? 0.0
                       : static_cast<double> (std::count (mesh.provenance.begin (), mesh.provenance.end (),
                                                          static_cast<std::uint8_t> (kind))) /
                             static_cast<double> (mesh.provenance.size ());
  return (shares);
}

double
meanOf (const std::vector<float>& values)
{
  return (values.empty ()
              ? 0.0
              : std::accumulate (values.begin (), values.end (), 0.0) / static_cast<double> (values.size ()));
}

/** \brief How an expected shape fits the measurements. */
Json
fitJson (const ProposalFit& fit)
{
  return (Json{{"used", fit.used},
               {"distance_m", fit.distance_m},
               {"explained", fit.explained},
               {"confirmed", fit.confirmed},
               {"contradicted", fit.contradicted}});
}

/** \brief \param[in] origin of the object's frame, where that is not the world's */
Json
proposalJson (const ProposalFit& fit, const Eigen::Vector3d& origin)
{
  Json result = fitJson (fit);
  result["number"] = fit.proposal;
  result["scale"] = fit.scale;
  result["T_object_proposal"] = transformJson (fit.T_object_proposal, origin);
  return (result);
}

} // namespace

Json
cameraJson (const PinholeCamera& camera)
{
  return {{"width", camera.width}, {"height", camera.height}, {"fx", camera.fx},
          {"fy", camera.fy},       {"cx", camera.cx},         {"cy", camera.cy}};
}

Json
solverJson (const SolverSummary& solver)
{
  return (Json{{"iterations", solver.iterations}, {"converged", solver.converged ()}, {"energy", solver.energy}});
}

Json
objectJson (const ObjectResult& object, const Eigen::Vector3d& origin)
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
  result["centroid_m"] = toJson (mass.centroid_m + origin);
  result["inertia"] = Json::array (
      {toJson (mass.inertia.row (0)), toJson (mass.inertia.row (1)), toJson (mass.inertia.row (2))});
  result["provenance"] = provenanceShares (object.mesh);
  result["mean_sigma_m"] = meanOf (object.mesh.sigma_m);
  result["penetration_m"] = object.penetration_m;
  result["outlier_points"] = object.outlier_points;
  result["contradicted_share"] = object.contradicted_share;
  if (object.guessed_plane)
  {
    const Eigen::Vector4d& plane = *object.guessed_plane;
    result["guessed_plane"] = {plane[0], plane[1], plane[2], plane[3] - plane.head<3> ().dot (origin)};
  }
  if (object.proposal)
    result["proposal"] = proposalJson (*object.proposal, origin);
  if (object.learned)
    result["learned"] = fitJson (*object.learned);
  result["solver"] = solverJson (object.solver);
  return (result);
}

Json
transformJson (const Eigen::Affine3d& T, const Eigen::Vector3d& origin)
{
  Json rows = Json::array ();
  for (int row = 0; row < 4; ++row)
    rows.push_back ({T (row, 0), T (row, 1), T (row, 2), T (row, 3) + (row < 3 ? origin[row] : 0.0)});
  return (rows);
}

Json
planesJson (const std::vector<Eigen::Vector4d>& planes, const Eigen::Vector3d& origin)
{
  Json list = Json::array ();
  for (const Eigen::Vector4d& p : planes)
    list.push_back ({p[0], p[1], p[2], p[3] - p.head<3> ().dot (origin)});
  return (list);
}

void
addMethod (const CoSectionOptions& method, Json& result)
{
  result["voxel_size_m"] = method.voxel_size_m;
  result["resolution"] = method.resolution;
  result["padding"] = method.padding;
  result["background_voxel_size_m"] = method.background_voxel_size_m;
  result["constraints"] = constraintsOf (method);
  result["priors"] = method.activePriors ().names ();
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

std::vector<std::string>
failureTexts (const std::vector<ObjectResult>& objects)
{
  std::vector<std::pair<std::string, std::string>> reasons; // and the objects
  for (const ObjectResult& object : objects)
    if (!object.error.empty ())
    {
      const auto found = std::find_if (reasons.begin (), reasons.end (),
                                       [&] (const auto& reason) { return (reason.first == object.error); });
      if (found == reasons.end ())
        reasons.emplace_back (object.error, std::to_string (object.id));
      else
        found->second += ", " + std::to_string (object.id);
    }
  std::vector<std::string> texts;
  for (const auto& [reason, ids] : reasons)
    texts.push_back ((ids.find (',') == std::string::npos ? "object " : "objects ") + ids + ": " + reason);
  return (texts);
}

void
saveFailure (const std::string& error, const Json& parameters, const std::vector<std::string>& warnings,
             const std::vector<std::string>& files)
try
{
  const Json summary = {{"error", error},           {"timings_s", Json::object ()},
                        {"parameters", parameters}, {"objects", Json::array ()},
                        {"failed", Json::array ()}, {"warnings", warnings}};
  for (const std::string& file : files)
    if (!file.empty ())
      saveJson (summary, file);
}
catch (const std::exception&)
{
  // the error itself is reported
}
