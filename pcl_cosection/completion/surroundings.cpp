// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "surroundings.h"

#include "pcl_cosection/common/boxes.h"
#include "pcl_cosection/priors/resting_planes.h"
#include "pcl_cosection/view/sensor_noise.h"
#include "pcl_cosection/view/support_plane.h"
#include "place_bodies.h"
#include <pcl/cosection/volume/mesh_distance.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <string>

namespace pcl::cosection {
namespace {

constexpr double plane_inlier_voxels = 2.0;
constexpr double plane_inlier_sigmas = 3.0; // of depth noise, if that is more
// Of the longest side: a support plane is searched so far away if none is visible near the object. What a camera above
// sees of a bottle is a quarter as wide as the bottle is high.
constexpr double hidden_plane_reach = 4.0;
constexpr double same_plane_cosine = 0.999;
constexpr double same_plane_voxels = 2.0;
constexpr std::size_t most_samples = 2000; // of an object's points
constexpr double cut_voxels = 2.0;         // noise alone puts no point so deep
constexpr double max_share_behind = 0.05;  // of an object's points, behind a given plane or in an obstacle

/** \brief The plane with its normal towards the side of most of the object's points. */
Eigen::Vector4d
towards (const ObjectInput& object, const Observation& observation, const Eigen::Vector4d& plane)
{
  const Eigen::Vector4d local = transformPlane (plane, firstPose (object));
  std::size_t above = 0;
  for (const OrientedPoint& p : observation.points ())
    above += local.head<3> ().dot (p.position.cast<double> ()) + local[3] > 0.0;
  return 2 * above < observation.points ().size () ? Eigen::Vector4d (-plane) : plane;
}

bool
isAtRest (const ObjectInput& object)
{
  return std::all_of (object.T_world_object.begin (), object.T_world_object.end (),
                      [&] (const Eigen::Isometry3d& T) { return T.isApprox (firstPose (object)); });
}

/** \brief Whether a given plane may bound an object: what moves may come near it. */
bool
isInReach (const ObjectInput& object, const Observation& observation, const Eigen::Vector4d& plane)
{
  const double distance_m = std::abs (heightOver (plane, firstPose (object) * observation.box.center ()));
  return !isAtRest (object) || distance_m <= (hidden_plane_reach + 0.5) * observation.box.sizes ().maxCoeff ();
}

/** \brief The points of an object in the world frame. */
std::vector<OrientedPoint>
worldPoints (const ObjectInput& object, const Observation& observation)
{
  std::vector<OrientedPoint> points = observation.points ();
  const Eigen::Isometry3f T = firstPose (object).cast<float> ();
  for (OrientedPoint& p : points)
    p = {T * p.position, T.linear () * p.normal};
  return points;
}

/** \brief Warn if all given planes are too far from all objects to bound any. */
void
warnOfDistantPlanes (const Scene& scene, const std::vector<Observation>& observations, CompletionLog& log)
{
  bool any_in_reach = scene.planes.empty ();
  for (std::size_t o = 0; o < scene.objects.size (); ++o)
    for (const Eigen::Vector4d& plane : scene.planes)
      any_in_reach = any_in_reach || log.failed (o) || isInReach (scene.objects[o], observations[o], plane);
  if (!any_in_reach && !scene.objects.empty ())
    log.warn ("the planes that were given are left out, as they are far from all objects: are their coefficients in "
              "metres, in the world frame, and is the sign of the last one right?");
}

/** \brief Warn if a given plane or obstacle contains too many of the object's points.
 * \param[in] isCut whether it contains a point (object frame) */
template <typename IsCut>
void
warnIfCut (const ObjectInput& object, const Observation& observation, IsCut&& isCut, const std::string& where,
           CompletionLog& log)
{
  const std::vector<OrientedPoint>& points = observation.points ();
  const std::size_t stride = (points.size () + most_samples - 1) / most_samples;
  std::size_t cut = 0, all = 0;
  for (std::size_t p = 0; p < points.size (); p += stride, ++all)
    cut += isCut (points[p].position.cast<double> ());
  const double share = static_cast<double> (cut) / static_cast<double> (all);
  if (share > max_share_behind)
    log.warn ("object " + std::to_string (object.id) + ": " + std::to_string (std::lround (100.0 * share)) +
              " % of its points lie " + where);
}

void
warnIfCutByPlanes (const Scene& scene, const ObjectInput& object, const Observation& observation, CompletionLog& log)
{
  for (const Eigen::Vector4d& plane : givenPlanes (scene, object, observation))
  {
    const Eigen::Vector4d local = transformPlane (plane, firstPose (object));
    const auto is_cut = [&] (const Eigen::Vector3d& p) {
      return local.head<3> ().dot (p) + local[3] < -cut_voxels * observation.voxel_size_m;
    };
    warnIfCut (object, observation, is_cut, "behind a plane that was given", log);
  }
}

void
warnIfCutByObstacles (const SceneObject& object, const std::vector<Obstacle>& obstacles, CompletionLog& log)
{
  const auto is_inside = [&] (const Eigen::Vector3d& p) {
    for (const Obstacle& obstacle : obstacles)
      for (const Eigen::Isometry3d& T_field_world : obstacle.T_field_world)
        for (const Eigen::Isometry3d& T_world_object : object.T_world_object)
          if (const auto u = obstacle.field->sampleSupported (T_field_world * (T_world_object * p));
              u && *u < -cut_voxels * object.observation->voxel_size_m)
            return true;
    return false;
  };
  if (!obstacles.empty ())
    warnIfCut (*object.input, *object.observation, is_inside,
               "inside a body that was given (an open mesh is solid behind its triangles)", log);
}

/** \brief A mesh as signed distance fields on boxes around the objects. \throws MemoryLimitExceeded */
std::vector<Obstacle>
sampleMesh (const MeshObstacle& obstacle, const std::vector<SceneObject>& objects, double voxel_size_m, double band_m,
            std::size_t used_bytes, const CoSectionOptions& options)
{
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant (2.0 * voxel_size_m);
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const SceneObject& object : objects)
    for (const Eigen::Isometry3d& T_world_object : object.T_world_object)
      for (const Eigen::Isometry3d& T_mesh_world : obstacle.T_mesh_world)
      {
        Eigen::AlignedBox3d box;
        for (const Eigen::Vector3d& corner : corners (object.grid ()))
          box.extend (T_mesh_world * T_world_object * corner);
        boxes.emplace_back (box.min () - margin, box.max () + margin);
      }
  std::vector<Obstacle> sampled;
  for (const Eigen::AlignedBox3d& box : uniteOverlapping (std::move (boxes)))
  {
    const VoxelGrid grid = layoutBox (box, voxel_size_m);
    checkMemory (grid, options.max_memory_bytes, used_bytes);
    sampled.push_back (
        {std::make_shared<SignedDistanceField> (sampleSignedDistance (obstacle.mesh, grid, band_m, options.threads)),
         obstacle.T_mesh_world});
  }
  return sampled;
}

/** \brief Let an object stand on the level top of another one, if it does and both are at rest. */
void
standOnOther (const Scene& scene, const std::vector<Observation>& observations, std::size_t o, const CompletionLog& log,
              std::vector<SupportPlanes>& support)
{
  if (support[o].planes.empty () || !scene.options.activePriors ().extrusion || !isAtRest (scene.objects[o]))
    return;
  const auto boxOf = [&] (std::size_t n) { return observations[n].box.transformed (firstPose (scene.objects[n])); };
  const std::vector<OrientedPoint> points = worldPoints (scene.objects[o], observations[o]);
  for (std::size_t other = 0; other < observations.size () && !support[o].top; ++other)
  {
    if (other == o || log.failed (other) || !isAtRest (scene.objects[other]))
      continue;
    const double tolerance_m = plane_inlier_voxels *
                               std::max (observations[o].voxel_size_m, observations[other].voxel_size_m);
    if (boxOf (o).exteriorDistance (boxOf (other)) > tolerance_m)
      continue;
    const std::vector<OrientedPoint> of_other = worldPoints (scene.objects[other], observations[other]);
    for (const Eigen::Vector4d& below : support[o].planes)
      if (!support[o].top)
        support[o].top = levelTopBelow (points, of_other, below, tolerance_m);
    if (support[o].top)
      for (const OrientedPoint& p : points)
      {
        const Eigen::Vector3d place = p.position.cast<double> (), up = support[o].top->head<3> ();
        support[other].feet.push_back (
            {(place - heightOver (*support[o].top, place) * up).cast<float> (), up.cast<float> ()});
      }
  }
}

} // namespace

std::vector<Eigen::Vector4d>
SupportPlanes::all () const
{
  std::vector<Eigen::Vector4d> all = planes;
  if (top)
    all.push_back (*top);
  return all;
}

std::vector<Eigen::Vector4d>
SceneObject::planes () const
{
  return planesAtPoses (*input, observation->box.center (), support->all (), T_world_object);
}

ObjectSetting
settingOf (const Scene& scene, const ObjectInput& object)
{
  return {scene.hasNothingAround (), scene.background, firstPose (object).inverse (), scene.options.activePriors (),
          scene.options.threads};
}

std::vector<Eigen::Vector4d>
givenPlanes (const Scene& scene, const ObjectInput& object, const Observation& observation)
{
  std::vector<Eigen::Vector4d> planes;
  for (const Eigen::Vector4d& plane : scene.planes)
    if (isInReach (object, observation, plane))
      planes.push_back (towards (object, observation, plane));
  return planes;
}

std::vector<Eigen::Vector4d>
boundingPlanes (const Scene& scene, const ObjectInput& object, const Observation& observation)
{
  std::vector<Eigen::Vector4d> planes = givenPlanes (scene, object, observation);
  if (!scene.options.use_planes || scene.background.empty ())
    return planes;
  std::vector<OrientedPoint> points = observation.points ();
  for (OrientedPoint& p : points)
    p.position = (firstPose (object) * p.position.cast<double> ()).cast<float> ();
  SupportPlaneOptions options;
  options.noise_m = observation.virtual_view ? 0.0 : noiseAt (observation.box.center (), observation.views);
  options.inlier_distance_m = std::max (plane_inlier_sigmas * options.noise_m,
                                        plane_inlier_voxels * observation.voxel_size_m);
  std::vector<Eigen::Vector4d> found = findSupportPlanes (scene.background, points, options);
  if (found.empty ()) // other things may hide the background nearby
  {
    options.reach = hidden_plane_reach;
    found = findSupportPlanes (scene.background, points, options);
  }
  planes.insert (planes.end (), found.begin (), found.end ());
  return planes;
}

std::vector<SupportPlanes>
findObjectPlanes (const Scene& scene, const std::vector<Observation>& observations, CompletionLog& log)
{
  const CoSectionOptions& options = scene.options;
  std::vector<SupportPlanes> support (scene.objects.size ());
  warnOfDistantPlanes (scene, observations, log);
  for (std::size_t o = 0; options.use_intersection && o < support.size (); ++o)
  {
    if (log.failed (o))
      continue;
    const ObjectInput& object = scene.objects[o];
    support[o].planes = boundingPlanes (scene, object, observations[o]);
    warnIfCutByPlanes (scene, object, observations[o], log);
    standOnOther (scene, observations, o, log, support);
    if (!support[o].planes.empty () || !scene.hasNothingAround () || !options.activePriors ().plane)
      continue;
    const ObjectSetting setting = settingOf (scene, object);
    if (const auto plane = inferSupportPlane (observations[o], setting))
      support[o] = {{transformPlane (*plane, firstPose (object).inverse ())}, true, std::nullopt, {}};
  }
  return support;
}

std::vector<Eigen::Vector4d>
differentPlanes (const Scene& scene, const std::vector<Observation>& observations,
                 const std::vector<SupportPlanes>& support)
{
  std::vector<Eigen::Vector4d> different;
  for (std::size_t o = 0; o < support.size (); ++o)
  {
    if (support[o].inferred || support[o].planes.empty ())
      continue;
    const Eigen::Vector3d center = firstPose (scene.objects[o]) * observations[o].box.center ();
    for (const Eigen::Vector4d& plane : support[o].planes)
    {
      const bool known = std::any_of (different.begin (), different.end (), [&] (const Eigen::Vector4d& other) {
        return plane.head<3> ().dot (other.head<3> ()) > same_plane_cosine &&
               std::abs ((plane - other).head<3> ().dot (center) + plane[3] - other[3]) <
                   same_plane_voxels * observations[o].voxel_size_m;
      });
      if (!known)
        different.push_back (plane);
    }
  }
  return different;
}

std::vector<Obstacle>
sampleObstacles (const Scene& scene, const std::vector<SceneObject>& objects, std::size_t used_bytes,
                 CompletionLog& log)
{
  std::vector<Obstacle> obstacles = scene.obstacles;
  if (!scene.options.use_intersection || objects.empty ())
    return obstacles;
  double smallest = std::numeric_limits<double>::infinity ();
  double largest = 0.0;
  for (const SceneObject& object : objects)
  {
    smallest = std::min (smallest, object.observation->voxel_size_m);
    largest = std::max (largest, object.observation->voxel_size_m);
  }
  used_bytes += bytesOf (obstacles);
  const double band_m = scene.options.max_bound_vox * largest + 2.0 * smallest;
  for (const MeshObstacle& mesh : scene.mesh_obstacles)
  {
    std::vector<Obstacle> sampled;
    log.guardPart ("a body given as a mesh",
                   [&] { sampled = sampleMesh (mesh, objects, smallest, band_m, used_bytes, scene.options); });
    used_bytes += bytesOf (sampled);
    std::move (sampled.begin (), sampled.end (), std::back_inserter (obstacles));
  }
  for (const SceneObject& object : objects)
    warnIfCutByObstacles (object, obstacles, log);
  return obstacles;
}

} // namespace pcl::cosection
