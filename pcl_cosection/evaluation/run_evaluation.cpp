// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/evaluation/run_evaluation.h>

#include "pcl_cosection/volume/mesh_distance/mesh_surface.h"
#include "rigid_alignment.h"
#include "run_penetration.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/rendering/rasterizer.h>

#include <algorithm>

namespace pcl::cosection {
namespace {

constexpr std::size_t refinement_points = 5000;
constexpr std::size_t median_frames = 400;
constexpr std::size_t match_samples = 500;
constexpr std::size_t match_frames = 7;
constexpr double match_reach = 0.05; ///< of the true object's diagonal: nearer surfaces coincide
constexpr double least_overlap = 0.1;
constexpr double visibility_width_px = 160.0; ///< of the pictures that are drawn to find out what is visible
constexpr double least_visible_share = 0.001;

/** \brief An object as the camera sees it, and its surface, which others are laid upon. */
struct ViewedObject
{
  ViewedObject (const SceneRecord::Object& object, std::vector<StampedPose> poses)
      : object (&object)
      , poses (std::move (poses))
      , distance (object.mesh)
      , points (sampleSurface (object.mesh, match_samples))
      , diagonal_m (summarizeMesh (object.mesh).box.diagonal ().norm ())
  {}

  double shareNear (const ViewedObject& other, const Eigen::Isometry3d& T_this_other, double reach_m, int threads) const
  {
    std::vector<Eigen::Vector3d> moved;
    for (const Eigen::Vector3d& p : other.points)
      moved.push_back (T_this_other * p);
    return shareWithin (distance.of (moved, threads), reach_m);
  }

  const SceneRecord::Object* object;
  std::vector<StampedPose> poses; ///< T_camera_object, where the camera has a pose too
  SurfaceDistance distance;
  std::vector<Eigen::Vector3d> points;
  double diagonal_m;
};

/** \brief The objects of a scene that have a mesh and poses together with the camera. */
std::vector<ViewedObject>
viewObjects (const SceneRecord& scene, double max_difference_s, const char* whose, std::vector<std::string>& warnings)
{
  std::vector<ViewedObject> viewed;
  for (const SceneRecord::Object& object : scene.objects)
  {
    std::vector<StampedPose> poses;
    for (const PosePair& pair : associatePoses (scene.camera, object.poses, max_difference_s))
      poses.push_back ({object.poses[pair.estimate].stamp,
                        scene.camera[pair.truth].pose.inverse () * object.poses[pair.estimate].pose});
    const std::string name = std::string (whose) + " " + object.name;
    if (object.mesh.empty ())
      warnings.push_back (name + " has no mesh: it is left out");
    else if (poses.empty ())
      warnings.push_back (name + " has no pose at a time when the camera has one: it is left out");
    else
      viewed.emplace_back (object, std::move (poses));
  }
  return viewed;
}

double
overlapAt (const ViewedObject& truth, const ViewedObject& estimate, const Eigen::Isometry3d& T_truth_estimate,
           int threads)
{
  const double reach_m = match_reach * truth.diagonal_m;
  const double of_estimate = truth.shareNear (estimate, T_truth_estimate, reach_m, threads);
  const double of_truth = estimate.shareNear (truth, T_truth_estimate.inverse (), reach_m, threads);
  return of_estimate + of_truth > 0.0 ? 2.0 * of_estimate * of_truth / (of_estimate + of_truth) : 0.0;
}

struct ObjectMatch
{
  std::size_t truth = 0; ///< indices
  std::size_t estimate = 0;
  double overlap = 0.0;
};

/** \brief Match one to one, by ascending index of the estimate. */
std::vector<ObjectMatch>
matchObjects (const std::vector<ViewedObject>& truth, const std::vector<ViewedObject>& estimate,
              double max_difference_s, int threads)
{
  std::vector<ObjectMatch> candidates;
  for (std::size_t t = 0; t < truth.size (); ++t)
    for (std::size_t e = 0; e < estimate.size (); ++e)
    {
      const auto pairs = associatePoses (truth[t].poses, estimate[e].poses, max_difference_s);
      std::vector<double> overlaps;
      const std::size_t frames = std::min (pairs.size (), match_frames);
      for (std::size_t n = 0; n < frames; ++n)
      {
        const PosePair& pair = pairs[frames > 1 ? n * (pairs.size () - 1) / (frames - 1) : 0];
        overlaps.push_back (
            overlapAt (truth[t], estimate[e],
                       truth[t].poses[pair.truth].pose.inverse () * estimate[e].poses[pair.estimate].pose, threads));
      }
      const double overlap = errorStatistics (overlaps).median;
      if (overlap >= least_overlap)
        candidates.push_back ({t, e, overlap});
    }
  std::stable_sort (candidates.begin (), candidates.end (),
                    [] (const ObjectMatch& a, const ObjectMatch& b) { return a.overlap > b.overlap; });
  std::vector<ObjectMatch> matches;
  for (const ObjectMatch& candidate : candidates)
    if (std::none_of (matches.begin (), matches.end (), [&] (const ObjectMatch& m) {
          return m.truth == candidate.truth || m.estimate == candidate.estimate;
        }))
      matches.push_back (candidate);
  std::sort (matches.begin (), matches.end (),
             [] (const ObjectMatch& a, const ObjectMatch& b) { return a.estimate < b.estimate; });
  return matches;
}

PinholeCamera
reduced (const PinholeCamera& camera)
{
  const double factor = std::min (1.0, visibility_width_px / camera.width);
  return {std::max (1, static_cast<int> (camera.width * factor)),
          std::max (1, static_cast<int> (camera.height * factor)),
          camera.fx * factor,
          camera.fy * factor,
          (camera.cx + 0.5) * factor - 0.5,
          (camera.cy + 0.5) * factor - 0.5};
}

/** \brief The stamps at which each object of a scene is visible: it covers at least a thousandth of the picture, behind
 * others and the background. Without intrinsics, all stamps at which it and the camera have a pose. */
std::vector<std::vector<double>>
visibleStamps (const SceneRecord& scene, double max_difference_s)
{
  // By frame of the camera, the index of each object's pose.
  std::vector<std::vector<std::optional<std::size_t>>> poses (scene.objects.size ());
  for (std::size_t n = 0; n < scene.objects.size (); ++n)
  {
    poses[n].resize (scene.camera.size ());
    for (const PosePair& pair : associatePoses (scene.camera, scene.objects[n].poses, max_difference_s))
      poses[n][pair.truth] = pair.estimate;
  }
  std::vector<std::vector<double>> stamps (scene.objects.size ());
  for (std::size_t frame = 0; frame < scene.camera.size (); ++frame)
  {
    std::vector<std::size_t> pixels (scene.objects.size (), 0);
    std::size_t least = 0;
    if (scene.intrinsics)
    {
      const PinholeCamera camera = reduced (*scene.intrinsics);
      Rasterizer rasterizer (camera, scene.camera[frame].pose);
      if (!scene.background.empty ())
        rasterizer.draw (scene.background, static_cast<int> (scene.objects.size ()));
      for (std::size_t n = 0; n < scene.objects.size (); ++n)
        if (poses[n][frame] && !scene.objects[n].mesh.empty ())
          rasterizer.draw (scene.objects[n].mesh, static_cast<int> (n), scene.objects[n].poses[*poses[n][frame]].pose);
      for (const std::int32_t id : rasterizer.image ().ids)
        if (id >= 0 && id < static_cast<std::int32_t> (pixels.size ()))
          ++pixels[static_cast<std::size_t> (id)];
      least = std::max<std::size_t> (1, static_cast<std::size_t> (least_visible_share * camera.width * camera.height));
    }
    for (std::size_t n = 0; n < scene.objects.size (); ++n)
      if (poses[n][frame] && pixels[n] >= least)
        stamps[n].push_back (scene.camera[frame].stamp);
  }
  return stamps;
}

/** \brief At most \a count of \a values, evenly spread. */
template <typename Value>
std::vector<Value>
thinned (const std::vector<Value>& values, std::size_t count)
{
  if (values.size () <= count)
    return values;
  std::vector<Value> result;
  for (std::size_t n = 0; n < count; ++n)
    result.push_back (values[n * values.size () / count]);
  return result;
}

/** \brief The vertices that were measured; all if nothing is known of that. */
std::vector<Eigen::Vector3d>
observedPoints (const TriangleMesh& mesh)
{
  std::vector<Eigen::Vector3d> points;
  const bool is_known = mesh.provenance.size () == mesh.vertices.size ();
  for (std::size_t v = 0; v < mesh.vertices.size (); ++v)
    if (!is_known || mesh.provenance[v] == static_cast<std::uint8_t> (Provenance::Observed))
      points.push_back (mesh.vertices[v].cast<double> ());
  return thinned (points, refinement_points);
}

/** \brief Bring a mesh into the frame of the truth by the median of poses, and refine that on its surface. */
MeshEvaluation
evaluateMesh (const TriangleMesh& truth, const TriangleMesh& estimate,
              const std::vector<Eigen::Isometry3d>& T_truth_estimate, const Eigen::Vector3d& centre,
              const RunOptions& options)
{
  MeshEvaluation result;
  FrameAlignment& alignment = result.alignment;
  alignment.frames = T_truth_estimate.size ();
  alignment.T_truth_estimate = medianPose (thinned (T_truth_estimate, median_frames), centre);
  std::vector<Eigen::Vector3d> points = observedPoints (estimate);
  for (Eigen::Vector3d& p : points)
    p = alignment.T_truth_estimate * p;
  if (options.refine && !points.empty ())
  {
    RefinementOptions refinement = options.refinement;
    refinement.threads = options.threads;
    alignment.refinement = refineAlignment (points, SurfaceDistance (truth), refinement);
    alignment.T_truth_estimate = alignment.refinement.correction * alignment.T_truth_estimate;
  }
  const TriangleMesh moved = transformMesh (estimate, alignment.T_truth_estimate);
  MeshComparisonOptions comparison = options.comparison;
  comparison.threads = options.threads;
  result.comparison = compareMeshes (truth, moved, comparison);
  result.truth = summarizeMesh (truth);
  result.estimate = summarizeMesh (moved);
  if (result.truth.volume_m3 && result.estimate.volume_m3 && *result.truth.volume_m3 != 0.0)
    result.volume_error = *result.estimate.volume_m3 / *result.truth.volume_m3 - 1.0;
  return result;
}

ObjectEvaluation
evaluateObject (const ViewedObject& truth, const ViewedObject& estimate, double max_difference_s,
                const RunOptions& options)
{
  ObjectEvaluation result;
  result.id = estimate.object->id;
  result.truth_id = truth.object->id;
  result.truth_name = truth.object->name;
  std::vector<Eigen::Isometry3d> poses;
  for (const PosePair& pair : associatePoses (truth.poses, estimate.poses, max_difference_s))
    poses.push_back (truth.poses[pair.truth].pose.inverse () * estimate.poses[pair.estimate].pose);
  result.mesh = evaluateMesh (truth.object->mesh, estimate.object->mesh, poses,
                              summarizeMesh (estimate.object->mesh).box.center (), options);

  std::vector<StampedPose> in_true_frame = estimate.poses;
  for (StampedPose& pose : in_true_frame)
    pose.pose = pose.pose * result.mesh.alignment.T_truth_estimate.inverse ();
  TrajectoryOptions trajectory = options.trajectory;
  trajectory.max_difference_s = max_difference_s;
  trajectory.alignment = TrajectoryAlignment::None;
  result.trajectory = compareTrajectories (truth.poses, in_true_frame, trajectory);
  result.frames_tracked = estimate.object->poses.size ();
  return result;
}

/** \brief How many of \a stamps have a pose. */
std::size_t
countTracked (const std::vector<double>& stamps, const std::vector<StampedPose>& poses, double max_difference_s)
{
  std::vector<StampedPose> wanted;
  for (const double stamp : stamps)
    wanted.push_back ({stamp, Eigen::Isometry3d::Identity ()});
  return associatePoses (wanted, poses, max_difference_s).size ();
}

void
addPenetration (const std::vector<PairPenetration>& pairs, ObjectEvaluation& object)
{
  bool is_known = true;
  for (const PairPenetration& pair : pairs)
    if (pair.first == object.id || pair.second == object.id)
    {
      object.penetration_m = std::max (object.penetration_m, pair.depth_m);
      if (pair.volume_m3)
        object.penetration_m3 = std::max (object.penetration_m3.value_or (0.0), *pair.volume_m3);
      else if (pair.depth_m > 0.0)
        is_known = false;
    }
  if (!is_known)
    object.penetration_m3.reset ();
}

void
evaluateBackground (const SceneRecord& truth, const SceneRecord& estimate, double max_difference_s,
                    const RunOptions& options, RunEvaluation& result)
{
  if (estimate.background.empty ())
    result.warnings.emplace_back ("the estimate has no background: it is left out");
  else if (truth.background.empty ())
    result.warnings.emplace_back ("the truth has no background: that of the estimate is not compared");
  if (estimate.background.empty () || truth.background.empty ())
    return;
  std::vector<Eigen::Isometry3d> poses;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero ();
  for (const PosePair& pair : associatePoses (truth.camera, estimate.camera, max_difference_s))
  {
    poses.push_back (truth.camera[pair.truth].pose * estimate.camera[pair.estimate].pose.inverse ());
    centre += estimate.camera[pair.estimate].pose.translation ();
  }
  result.background = evaluateMesh (truth.background, estimate.background, poses,
                                    centre / static_cast<double> (poses.size ()), options);
}

void
warnOfRefinement (const std::string& name, const FrameAlignment& alignment, std::vector<std::string>& warnings)
{
  if (alignment.refinement.limited)
    warnings.push_back (
        name + ": the refinement of its alignment wants to go beyond its limits; poses and mesh may not fit together");
}

} // namespace

void
RunOptions::validate () const
{
  comparison.validate ();
  trajectory.validate ();
  penetration.validate ();
  refinement.validate ();
  if (volume_frames < 1)
    throw InvalidArgument ("volume_frames must be at least 1");
  if (threads < 0)
    throw InvalidArgument ("threads must not be negative");
}

RunEvaluation
evaluateRun (const SceneRecord& truth, const SceneRecord& estimate, const RunOptions& options)
{
  options.validate ();
  RunEvaluation result;
  result.camera = compareTrajectories (truth.camera, estimate.camera, options.trajectory);
  const double max_difference_s = result.camera.max_difference_s;

  const auto true_objects = viewObjects (truth, max_difference_s, "true object", result.warnings);
  const auto objects = viewObjects (estimate, max_difference_s, "estimated object", result.warnings);
  const auto matches = matchObjects (true_objects, objects, max_difference_s, options.threads);
  if (options.measure_penetration)
    result.penetrations = measurePenetrations (estimate, max_difference_s, options);
  const auto visible = visibleStamps (truth, max_difference_s);
  if (!truth.intrinsics)
    result.warnings.emplace_back ("the truth has no calibration: objects count as visible whenever they have a pose");
  for (const ObjectMatch& match : matches)
  {
    const ViewedObject& of_truth = true_objects[match.truth];
    const ViewedObject& of_estimate = objects[match.estimate];
    ObjectEvaluation object = evaluateObject (of_truth, of_estimate, max_difference_s, options);
    object.overlap = match.overlap;
    const auto& stamps = visible[static_cast<std::size_t> (of_truth.object - truth.objects.data ())];
    object.frames_visible = stamps.size ();
    object.frames_tracked_visible = countTracked (stamps, of_estimate.object->poses, max_difference_s);
    addPenetration (result.penetrations, object);
    warnOfRefinement ("object " + of_estimate.object->name, object.mesh.alignment, result.warnings);
    result.objects.push_back (std::move (object));
  }
  for (const SceneRecord::Object& object : estimate.objects)
    if (std::none_of (result.objects.begin (), result.objects.end (),
                      [&] (const ObjectEvaluation& o) { return o.id == object.id; }))
      result.unmatched.push_back (object.id);
  for (const SceneRecord::Object& object : truth.objects)
    if (std::none_of (result.objects.begin (), result.objects.end (),
                      [&] (const ObjectEvaluation& o) { return o.truth_id == object.id; }))
      result.missed.push_back (object.id);
  evaluateBackground (truth, estimate, max_difference_s, options, result);
  if (result.background)
    warnOfRefinement ("background", result.background->alignment, result.warnings);
  return result;
}

} // namespace pcl::cosection
