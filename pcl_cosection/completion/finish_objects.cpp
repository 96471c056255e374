// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "finish_objects.h"

#include "pcl_cosection/completion/grid/place_bodies.h"
#include "pcl_cosection/energy/body_mesh.h"
#include "pcl_cosection/mesh/mesh_attributes.h"
#include "penetration.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr double inferred_reach_voxels = 2.0; // vertices so near to an inferred plane are bounded by it

/** \brief Mark vertices that an inferred plane bounds as inferred, as such a plane is no body. */
void
markInferred (const SceneObject& object, TriangleMesh& mesh)
{
  if (!object.support->inferred)
    return;
  const Eigen::Vector4d plane = transformPlane (object.support->planes.front (), firstPose (*object.input));
  for (std::size_t v = 0; v < mesh.vertices.size (); ++v)
    if (mesh.provenance[v] == static_cast<std::uint8_t> (Provenance::Intersection) &&
        std::abs (plane.head<3> ().dot (mesh.vertices[v].cast<double> ()) + plane[3]) <
            inferred_reach_voxels * object.observation->voxel_size_m)
      mesh.provenance[v] = static_cast<std::uint8_t> (Provenance::Inferred);
}

void
addMeshes (const SceneObject& object, const BodyEnergy& energy, FinishedObject& finished)
{
  const BodySolution& solution = object.body->solution;
  finished.mesh = closedMesh (energy, solution);
  if (finished.mesh.empty ())
    throw DegenerateInput ("its measurements determine no closed surface, or lie inside another body");
  markInferred (object, finished.mesh);
  transferAttributes (object.points (), energy.grid, finished.mesh);
  if (energy.options.compute_bounds)
    finished.inner_bound = innerMesh (energy, solution, object.points ());
}

} // namespace

std::vector<FinishedObject>
finishObjects (const Scene& scene, const std::vector<SceneObject>& objects, const std::vector<BodyEnergy>& energies,
               const std::vector<SignedDistanceField::ConstPtr>& background, const std::vector<Obstacle>& obstacles,
               UpdateOutput output, std::size_t used_bytes, CompletionLog& log)
{
  std::vector<FinishedObject> finished (objects.size ());
  const auto forEach = [&] (auto&& f) {
    for (std::size_t o = 0; o < objects.size (); ++o)
      if (!log.failed (objects[o].index))
        log.guard (objects[o].index, [&] { f (o); });
  };
  forEach ([&] (std::size_t o) {
    finished[o].field = std::make_shared<SignedDistanceField> (solvedField (energies[o], objects[o].body->solution));
    if (output == UpdateOutput::Meshes)
      addMeshes (objects[o], energies[o], finished[o]);
  });
  if (output == UpdateOutput::Meshes)
  {
    std::vector<const TriangleMesh*> meshes;
    std::vector<const SignedDistanceField*> fields;
    for (const FinishedObject& object : finished)
    {
      meshes.push_back (&object.mesh);
      fields.push_back (object.field.get ());
    }
    used_bytes += bytesOf (obstacles);
    for (const SignedDistanceField::ConstPtr& field : background)
      used_bytes += bytesOf (*field);
    std::vector<HullMeshes> hulls = findHulls (scene, objects, meshes, fields, used_bytes, log);
    for (std::size_t o = 0; o < objects.size (); ++o)
      finished[o].hulls = std::move (hulls[o]);
  }
  if (scene.options.use_intersection)
    forEach ([&] (std::size_t o) {
      const SignedDistanceField& field = *finished[o].field;
      double deepest = penetrationOfSurroundings (scene, objects[o], field, background, obstacles);
      for (std::size_t p = 0; p < objects.size (); ++p)
        if (p != o && !log.failed (objects[p].index))
          deepest = std::max (deepest,
                              penetration (field, *finished[p].field,
                                           relativePoses (*objects[o].input, objects[o].grid (), objects[p].input),
                                           scene.options.threads));
      finished[o].penetration_m = deepest;
    });
  return finished;
}

void
dropFailed (const Scene& scene, const CompletionLog& log, SceneState& state)
{
  for (std::size_t o = 0; o < scene.objects.size (); ++o)
    if (log.failed (o))
      state.objects[scene.objects[o].id] = {};
}

SceneResult
sceneResult (const Scene& scene, const std::vector<Observation>& observations,
             const std::vector<SupportPlanes>& support, const std::vector<SceneObject>& objects,
             const std::vector<double>& contradicted, Background background, const std::vector<SolverSummary>& solvers,
             std::vector<FinishedObject> finished, const CompletionLog& log)
{
  SceneResult result;
  result.objects.resize (scene.objects.size ());
  for (std::size_t o = 0; o < scene.objects.size (); ++o)
  {
    result.objects[o].id = scene.objects[o].id;
    result.objects[o].error = log.error (o);
  }
  for (std::size_t n = 0; n < objects.size (); ++n)
  {
    const std::size_t o = objects[n].index;
    if (log.failed (o))
      continue;
    ObjectResult& object = result.objects[o];
    object.mesh = std::move (finished[n].mesh);
    object.hull = std::move (finished[n].hulls.hull);
    object.inner_bound = std::move (finished[n].inner_bound);
    object.outer_bound = std::move (finished[n].hulls.outer_bound);
    object.signed_distance = finished[n].field;
    object.outlier_points = observations[o].outliers ();
    object.contradicted_share = contradicted[o];
    if (support[o].inferred)
      object.guessed_plane = support[o].planes.front ();
    object.solver = solvers[n];
    object.penetration_m = finished[n].penetration_m;
  }
  result.background = std::move (background.mesh);
  result.background_pieces = std::move (background.pieces);
  result.planes = differentPlanes (scene, observations, support);
  result.timings_s = log.timings ();
  result.warnings = log.warnings ();
  return result;
}

} // namespace pcl::cosection
