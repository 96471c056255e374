// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "gather_evidence.h"

#include "pcl_cosection/energy/data/measured_surface.h"
#include "pcl_cosection/view/outliers/residual_clusters.h"
#include "pcl_cosection/view/visibility/free_space_votes.h"
#include "pcl_cosection/view/visibility/view_agreement.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

namespace pcl::cosection {
namespace {

// A background point has moved if so many views look through it, and at least so large a share of all that see it.
constexpr int least_free_views = 2;
constexpr double free_share = 0.25;
constexpr double max_contradicted_share = 0.1; // of an object's points; good poses leave 0.03 or less
constexpr double residual_cell_m = 0.02;

void
readPoints (const SceneObject& object)
{
  BodyState& body = *object.body;
  const std::vector<OrientedPoint>& all = object.input->points;
  std::vector<OrientedPoint> fresh;
  fresh.reserve (all.size () - body.points_read);
  for (std::size_t p = body.points_read; p < all.size (); ++p)
    if (!body.outliers[p])
      fresh.push_back (all[p]);
  if (!fresh.empty ())
    body.evidence->addPoints (fresh);
  body.points_read = all.size ();
}

/** \brief Find background points on the object's surface at its pose in their view; for points before its first view,
 * at its pose there. */
void
findPointsOf (const Scene& scene, const SceneObject& object, std::vector<bool>& found)
{
  const auto batches = scene.batches.find (0);
  if (batches == scene.batches.end ())
    return;
  const MeasuredSurface surface (object.points (), object.observation->voxel_size_m);
  const std::size_t first_view = firstView (*object.input);
  std::size_t begin = 0;
  for (const PointBatch& batch : batches->second)
  {
    const std::size_t end = begin + batch.count;
    const bool was_known = batch.view >= static_cast<int> (first_view);
    const Eigen::Isometry3d T_world_object = poseAt (*object.input,
                                                     was_known ? static_cast<std::size_t> (batch.view) : first_view);
    // Before its first view the object may have moved a little.
    const double depth_vox = was_known ? MeasuredSurface::voxels_beside : MeasuredSurface::voxels_deep;
    if (T_world_object.matrix ().allFinite ())
    {
      const Eigen::Isometry3f T = T_world_object.inverse ().cast<float> ();
      for (std::size_t n = begin; n < end; ++n)
      {
        const OrientedPoint& point = scene.background[n];
        found[n] = found[n] || surface.has ({T * point.position, T.linear () * point.normal}, depth_vox);
      }
    }
    begin = end;
  }
}

/** \brief The points of the background without those that moved. */
std::vector<OrientedPoint>
backgroundAtRest (const Scene& scene, const std::vector<SceneObject>& objects)
{
  std::vector<FreeSpaceView> views;
  for (const SceneView& view : scene.views)
    if (view.use != ViewUse::FreeSpace)
      views.emplace_back (view.depth);
  std::vector<Eigen::Vector3f> positions (scene.background.size ());
  std::transform (scene.background.begin (), scene.background.end (), positions.begin (),
                  [] (const OrientedPoint& point) { return point.position; });
  const std::vector<FreeSpaceVotes> votes = voteOnPoints (positions, views, 0.0, scene.options.threads);
  std::vector<bool> moved (votes.size ());
  for (std::size_t n = 0; n < votes.size (); ++n)
    moved[n] = votes[n].free >= least_free_views && votes[n].free >= free_share * votes[n].surface;
  for (const SceneObject& object : objects)
    findPointsOf (scene, object, moved);
  addResidualClusters (scene.background, residual_cell_m, moved);
  std::vector<OrientedPoint> at_rest;
  for (std::size_t n = 0; n < moved.size (); ++n)
    if (!moved[n])
      at_rest.push_back (scene.background[n]);
  return at_rest;
}

void
readBackground (const Scene& scene, CompletionMode mode, const std::vector<SceneObject>& objects,
                const std::vector<BodyState*>& background)
{
  const bool all = !scene.options.leave_out_moved || mode == CompletionMode::Incremental;
  const std::vector<OrientedPoint> at_rest = all ? std::vector<OrientedPoint> () : backgroundAtRest (scene, objects);
  for (BodyState* body : background)
  {
    if (all)
      body->evidence->addPoints (
          {scene.background.begin () + static_cast<std::ptrdiff_t> (body->points_read), scene.background.end ()});
    else
      body->evidence->addPoints (at_rest);
    body->points_read = scene.background.size ();
  }
}

/** \brief Warn if a view looks through many of the object's points. \return the contradicted share */
double
judgeAgreement (const Scene& scene, const SceneObject& object, const ViewAgreement& agreement, CompletionLog& log)
{
  const auto [share, view] = agreement.worst ();
  if (share > max_contradicted_share)
  {
    const std::string& name = scene.views[static_cast<std::size_t> (view)].depth.name;
    log.warn ("object " + std::to_string (object.input->id) + ": " +
              (name.empty () ? "view " + std::to_string (view) : name) + " looks through " +
              std::to_string (std::lround (100.0 * share)) +
              " % of its points there: a pose may be wrong, or it has moved");
  }
  return share;
}

/** \brief One view of a scene, prepared on first use and shared by all bodies that have not read it. */
class SharedView
{
public:
  SharedView (const SceneView& view, std::size_t index, int threads)
      : scene_view_ (view)
      , index_ (index)
      , threads_ (threads)
  {}

  void show (BodyState& body, ViewAgreement* agreement, const Eigen::Isometry3d& T_body_sensor)
  {
    if (body.views_read > index_)
      return;
    body.views_read = index_ + 1;
    if (!T_body_sensor.matrix ().allFinite ())
      return;
    if (!view_)
      view_.emplace (scene_view_.depth);
    body.evidence->addView (*view_, T_body_sensor, scene_view_.use == ViewUse::Full);
    if (agreement)
      agreement->add (static_cast<int> (index_), *view_, T_body_sensor, threads_);
  }

private:
  const SceneView& scene_view_;
  std::size_t index_;
  int threads_;
  std::optional<FreeSpaceView> view_;
};

} // namespace

std::vector<double>
gatherEvidence (const Scene& scene, CompletionMode mode, const std::vector<SceneObject>& objects,
                const std::vector<BodyState*>& background, CompletionLog& log)
{
  const bool use_hull = scene.options.use_hull;
  log.timed ("data_term", [&] {
    for (const SceneObject& object : objects)
      log.guard (object.index, [&] { readPoints (object); });
    readBackground (scene, mode, objects, background);
  });
  return log.timed ("constraints", [&] {
    std::vector<std::optional<ViewAgreement>> agreement (objects.size ());
    if (mode == CompletionMode::Once && use_hull)
      for (std::size_t o = 0; o < objects.size (); ++o)
        agreement[o].emplace (objects[o].points ());
    for (std::size_t v = 0; v < scene.views.size (); ++v)
    {
      const Eigen::Isometry3d& T_world_sensor = scene.views[v].depth.T_world_sensor;
      SharedView view (scene.views[v], v, scene.options.threads);
      for (BodyState* body : background)
        if (scene.views[v].use != ViewUse::FreeSpace)
          view.show (*body, nullptr, T_world_sensor);
      for (std::size_t o = 0; o < objects.size (); ++o)
        if (const SceneObject& object = objects[o]; use_hull && !log.failed (object.index))
          log.guard (object.index, [&] {
            view.show (*object.body, agreement[o] ? &*agreement[o] : nullptr,
                       poseAt (*object.input, v).inverse () * T_world_sensor);
          });
      log.report ("free space", 0.05 * static_cast<double> (v + 1) / static_cast<double> (scene.views.size ()));
    }
    std::vector<double> contradicted (scene.objects.size (), 0.0);
    for (std::size_t o = 0; o < objects.size (); ++o)
      if (agreement[o] && !log.failed (objects[o].index))
        contradicted[objects[o].index] = judgeAgreement (scene, objects[o], *agreement[o], log);
    return contradicted;
  });
}

} // namespace pcl::cosection
