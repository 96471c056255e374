// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "object_matching.h"

#include "pcl_cosection/evaluation/surface_distance.h"
#include "surface_samples.h"

#include <algorithm>

namespace pcl::cosection {
namespace {

constexpr std::size_t match_samples = 500;
constexpr std::size_t match_frames = 7;
constexpr double match_reach = 0.05; ///< of the true object's diagonal: nearer surfaces coincide
constexpr double least_overlap = 0.1;

/** \brief A mesh that others are laid upon. */
struct Shape
{
  explicit Shape (const TriangleMesh& mesh)
      : distance (mesh)
      , points (sampleSurface (mesh, match_samples))
      , diagonal_m (summarizeMesh (mesh).box.diagonal ().norm ())
  {}

  double shareNear (const Shape& other, const Eigen::Isometry3d& T_this_other, double reach_m, int threads) const
  {
    std::vector<Eigen::Vector3d> moved;
    for (const Eigen::Vector3d& p : other.points)
      moved.push_back (T_this_other * p);
    const std::vector<double> distances = distance.of (moved, threads);
    return static_cast<double> (
               std::count_if (distances.begin (), distances.end (), [reach_m] (double d) { return d <= reach_m; })) /
           static_cast<double> (distances.size ());
  }

  SurfaceDistance distance;
  std::vector<Eigen::Vector3d> points;
  double diagonal_m;
};

double
overlapAt (const Shape& truth, const Shape& estimate, const Eigen::Isometry3d& T_truth_estimate, int threads)
{
  const double reach_m = match_reach * truth.diagonal_m;
  const double of_estimate = truth.shareNear (estimate, T_truth_estimate, reach_m, threads);
  const double of_truth = estimate.shareNear (truth, T_truth_estimate.inverse (), reach_m, threads);
  return of_estimate + of_truth > 0.0 ? 2.0 * of_estimate * of_truth / (of_estimate + of_truth) : 0.0;
}

} // namespace

std::vector<ViewedObject>
viewObjects (const SceneRecord& scene, double max_difference_s, const char* whose, std::vector<std::string>& warnings)
{
  std::vector<ViewedObject> viewed;
  for (const SceneRecord::Object& object : scene.objects)
  {
    ViewedObject view;
    view.object = &object;
    for (const PosePair& pair : associatePoses (scene.camera, object.poses, max_difference_s))
      view.poses.push_back ({object.poses[pair.estimate].stamp,
                             scene.camera[pair.truth].pose.inverse () * object.poses[pair.estimate].pose});
    const std::string name = std::string (whose) + " " + object.name;
    if (object.mesh.empty ())
      warnings.push_back (name + " has no mesh: it is left out");
    else if (view.poses.empty ())
      warnings.push_back (name + " has no pose at a time when the camera has one: it is left out");
    else
      viewed.push_back (std::move (view));
  }
  return viewed;
}

std::vector<ObjectMatch>
matchObjects (const std::vector<ViewedObject>& truth, const std::vector<ViewedObject>& estimate,
              double max_difference_s, int threads)
{
  std::vector<Shape> truth_shapes, estimate_shapes;
  for (const ViewedObject& t : truth)
    truth_shapes.emplace_back (t.object->mesh);
  for (const ViewedObject& e : estimate)
    estimate_shapes.emplace_back (e.object->mesh);

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
            overlapAt (truth_shapes[t], estimate_shapes[e],
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

} // namespace pcl::cosection
