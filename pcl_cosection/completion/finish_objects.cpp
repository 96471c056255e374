// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "finish_objects.h"

#include "hulls.h"
#include "joint_solve.h"
#include "neighbours.h"
#include "pcl_cosection/energy/body_mesh.h"
#include "pcl_cosection/energy/expected_error.h"
#include "pcl_cosection/mesh/mesh_attributes.h"
#include "pcl_cosection/priors/guesses.h"
#include "pcl_cosection/priors/proposed/proposed_shape.h"
#include "pcl_cosection/volume/mesh_distance/mesh_surface.h"
#include "place_bodies.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iomanip>
#include <sstream>
#include <string>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr std::size_t most_judged = 1000; // points of an object
constexpr double missed_voxels = 2.0;     // distance of a point from a surface that does not show it
// Share of such points. Of 265 completed views (scanned meshes, YCB-Video, RealSense; also of every third pixel) at
// most 0.12; of a sheet that was thinner than its voxels 0.99.
constexpr double much_missed = 0.25;
// A whole part is lost if more than this share of the points is farther than this share of the object's length from its
// mesh. Of 269 such views it is one, of a sliver of a fork; the others have at most 0.019, sheets on an edge that
// vanish 0.05 and more.
constexpr double missed_part = 0.03, missed_length = 0.2;
// Share of an object's outline. More of it is hidden of 13 among 310 things that are right to 6 mm either way (scanned
// meshes alone and in clutter, YCB-Video, RealSense), and of six among 15 that are wrong by over 10 mm.
constexpr double much_hidden = 0.15;
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

/** \brief Share of the points that a mesh does not show, if these are many, or a whole part; else 0. */
double
missedShare (const std::vector<OrientedPoint>& points, const TriangleMesh& mesh, double voxel_size_m, double length_m)
{
  std::vector<Eigen::Vector3d> some;
  for (std::size_t p = 0; p < points.size (); p += points.size () / most_judged + 1)
    some.push_back (points[p].position.cast<double> ());
  const std::vector<double> distances = SurfaceDistance (mesh).of (some, 1);
  const double missed = 1.0 - shareWithin (distances, missed_voxels * voxel_size_m);
  return missed > much_missed || 1.0 - shareWithin (distances, missed_length * length_m) > missed_part ? missed : 0.0;
}

std::string
lossText (double missed, double voxel_size_m)
{
  std::ostringstream text;
  text << std::fixed << std::setprecision (1) << "its mesh shows only " << std::lround (100.0 * (1.0 - missed))
       << " % of its points: what is thinner than its voxels of " << 1e3 * voxel_size_m
       << " mm, or so near to other things, is lost (give more points, or a smaller voxel size)";
  return text.str ();
}

std::string
hiddenText (double hidden)
{
  return "what is nearer hides " + std::to_string (std::lround (100.0 * hidden)) +
         " % of its outline: what it is like there is a guess (add a view from elsewhere)";
}

std::string
depthText (double depth_m)
{
  return "only one side of it was seen, which is flat: that it reaches " +
         std::to_string (std::lround (1e3 * depth_m)) + " mm behind that is a guess (add a view from elsewhere)";
}

std::string
downText (double depth_m)
{
  return "that it reaches " + std::to_string (std::lround (1e3 * depth_m)) +
         " mm down to a plane is a guess (add a view from elsewhere; if it does not rest on the plane, give "
         "--no-planes)";
}

/** \brief What is lost of an object, and what of it is a guess. */
std::vector<std::string>
remarksOn (const Scene& scene, const SceneObject& object, const ObjectResult& result)
{
  const double voxel_size_m = object.grid ().voxel_size_m;
  std::vector<std::string> remarks;
  if (const double missed = missedShare (object.points (), result.mesh, voxel_size_m, object.observation->extents_m[0]);
      missed > 0.0)
    remarks.push_back (lossText (missed, voxel_size_m));
  const std::vector<Eigen::Vector4d> planes = object.planes ();
  if (const double hidden = hiddenOutline (*object.observation, scene.background.empty (), planes,
                                           *result.signed_distance, much_hidden);
      hidden > much_hidden)
    remarks.push_back (hiddenText (hidden));
  const bool knows_planes = !object.support->inferred;
  if (const double depth_m = depthBehindOnlySide (
          object.points (), knows_planes ? planes : std::vector<Eigen::Vector4d> (), voxel_size_m, result.mesh);
      depth_m > 0.0)
    remarks.push_back (depthText (depth_m));
  if (const double depth_m = knows_planes ? depthDownToPlane (*object.observation, planes, result.mesh) : 0.0;
      depth_m > 0.0)
    remarks.push_back (downText (depth_m));
  return remarks;
}

} // namespace

std::vector<ErrorSources>
errorSourcesOf (const SceneObject& object, const BodyEnergy& energy, const TriangleMesh& mesh)
{
  const Observation& observation = *object.observation;
  const SensorViews views = observation.virtual_view ? SensorViews () : observation.views;
  return errorSources (energy, object.points (), views, observation.extents_m[0], mesh);
}

std::vector<ObjectResult>
finishObjects (const Scene& scene, const std::vector<SceneObject>& objects, const std::vector<BodyEnergy>& energies,
               const std::vector<SignedDistanceField::ConstPtr>& background, const std::vector<Obstacle>& obstacles,
               UpdateOutput output, std::size_t used_bytes, CompletionLog& log)
{
  std::vector<ObjectResult> results (objects.size ());
  std::vector<std::vector<std::string>> remarks (objects.size ());
  forEachObjectAtOnce (objects, scene.options.threads, log, [&] (std::size_t o) {
    const SceneObject& object = objects[o];
    const BodySolution& solution = object.body->solution;
    ObjectResult& result = results[o];
    result.signed_distance = std::make_shared<SignedDistanceField> (solvedField (energies[o], solution));
    if (output != UpdateOutput::Meshes)
      return;
    result.mesh = closedMesh (energies[o], solution);
    if (result.mesh.empty ())
      throw DegenerateInput ("its measurements determine no closed surface, or lie inside another body");
    markInferred (object, result.mesh);
    remarks[o] = remarksOn (scene, object, result);
    transferAttributes (object.points (), energies[o].grid, result.mesh);
    attachExpectedErrors (errorSourcesOf (object, energies[o], result.mesh), result.mesh);
    if (scene.options.compute_bounds)
      result.inner_bound = innerMesh (energies[o], solution, object.points ());
  });
  for (std::size_t o = 0; o < objects.size (); ++o)
    for (const std::string& remark : remarks[o])
      log.warn ("object " + std::to_string (objects[o].input->id) + ": " + remark);
  if (output == UpdateOutput::Meshes)
  {
    used_bytes += bytesOf (obstacles);
    for (const SignedDistanceField::ConstPtr& field : background)
      used_bytes += bytesOf (*field);
    addHulls (scene, objects, used_bytes, results, log);
  }
  const std::vector<std::uint8_t> alive = aliveObjects (objects, log);
  const std::vector<std::vector<std::size_t>> neighbours = neighboursOf (objects);
  if (scene.options.use_intersection)
    forEachObjectAtOnce (objects, scene.options.threads, log, [&] (std::size_t o) {
      const SignedDistanceField& field = *results[o].signed_distance;
      double deepest = penetrationOfSurroundings (scene, objects[o], field, background, obstacles);
      for (const std::size_t p : neighbours[o])
        if (alive[p])
          deepest = std::max (deepest,
                              penetration (field, *results[p].signed_distance,
                                           relativePoses (*objects[o].input, objects[o].grid (), objects[p].input),
                                           scene.options.threads));
      results[o].penetration_m = deepest;
    });
  return results;
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
             std::vector<ObjectResult> finished, const CompletionLog& log)
{
  SceneResult result;
  result.objects.resize (scene.objects.size ());
  for (std::size_t n = 0; n < objects.size (); ++n)
  {
    const std::size_t o = objects[n].index;
    if (log.failed (o))
      continue;
    ObjectResult& object = result.objects[o];
    object = std::move (finished[n]);
    object.outlier_points = observations[o].outliers ();
    object.contradicted_share = contradicted[o];
    if (support[o].inferred)
      object.guessed_plane = support[o].planes.front ();
    if (const ProposedShapes* shapes = observations[o].proposed.get ())
    {
      if (shapes->best)
        object.proposal = shapes->best->fit;
      if (shapes->learned)
        object.learned = shapes->learned->fit;
    }
    object.solver = solvers[n];
  }
  for (std::size_t o = 0; o < scene.objects.size (); ++o)
  {
    result.objects[o].id = scene.objects[o].id;
    result.objects[o].error = log.error (o);
  }
  result.background = std::move (background.mesh);
  result.background_pieces = std::move (background.pieces);
  result.planes = differentPlanes (scene, observations, support);
  result.timings_s = log.timings ();
  result.warnings = log.warnings ();
  return result;
}

} // namespace pcl::cosection
