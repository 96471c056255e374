// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "energy_terms.h"

#include "pcl_cosection/common/lattice_cells.h"
#include "pcl_cosection/view/outliers/point_clusters.h"
#include "pcl_cosection/view/visibility/free_space_votes.h"
#include "shown_bodies.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>

namespace pcl::cosection {
namespace {

// A background point has moved if so many views look through it, and at least so large a share of all that see it.
constexpr int least_free_views = 2;
constexpr double free_share = 0.25;
constexpr double max_contradicted_share = 0.1; // of an object's points; good poses leave 0.03 or less
constexpr double most_turned_away = 0.5;       // of the normals of points that views see: noise turns few
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

/** \brief Decides whether a point belongs to the surface of a body, by the body's measured points. */
class MeasuredSurface
{
public:
  /** \param[in] points must outlive this */
  MeasuredSurface (const std::vector<OrientedPoint>& points, double voxel_size_m)
      : points_ (points)
      , voxel_size_m_ (voxel_size_m)
  {
    for (std::size_t n = 0; n < points.size (); ++n)
      if (const auto cell = cellOf (points[n].position.cast<double> () / (near_voxels * voxel_size_m)))
        cells_[keyOf (*cell)].push_back (static_cast<std::uint32_t> (n));
  }

  /** \brief Whether \a point, the body's frame, lies near a point of the body whose normal differs by at most 60
   * degrees: along that normal, and beside it. */
  bool has (const OrientedPoint& point) const
  {
    constexpr float same_side = 0.5f; // cosine between normals
    const auto place = cellOf (point.position.cast<double> () / (near_voxels * voxel_size_m_));
    if (!place)
      return false;
    const auto near_m = static_cast<float> (near_voxels * voxel_size_m_);
    const auto isNear = [&] (std::uint32_t n) {
      const OrientedPoint& own = points_[n];
      const Eigen::Vector3f way = point.position - own.position;
      const float height = own.normal.dot (way);
      return std::abs (height) < near_m && way.squaredNorm () - height * height < near_m * near_m &&
             own.normal.dot (point.normal) > same_side;
    };
    for (int k = 0; k < 27; ++k)
    {
      const auto cell = cells_.find (keyOf (neighbourOf (*place, k)));
      if (cell != cells_.end () && std::any_of (cell->second.begin (), cell->second.end (), isNear))
        return true;
    }
    return false;
  }

private:
  static constexpr double near_voxels = 2.0;

  const std::vector<OrientedPoint>& points_;
  double voxel_size_m_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_; // points by cell of near_voxels
};

/** \brief Find background points on the object's surface at its pose in their view; for points before its first view,
 * in its volume at its pose there: nothing told then what of this is the object's. */
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
    if (T_world_object.matrix ().allFinite ())
    {
      const Eigen::Isometry3f T = T_world_object.inverse ().cast<float> ();
      for (std::size_t n = begin; n < end; ++n)
      {
        const OrientedPoint& point = scene.background[n];
        const Eigen::Vector3f place = T * point.position;
        found[n] = found[n] || (was_known ? surface.has ({place, T.linear () * point.normal})
                                          : object.grid ().nearest (place.cast<double> ()).has_value ());
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
  for (const UsedView& view : scene.views)
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
                BackgroundBodies& background)
{
  const bool all = !scene.options.leave_out_moved || mode == CompletionMode::Incremental;
  if (!all)
    background.at_rest = backgroundAtRest (scene, objects);
  for (BodyState* body : background.bodies)
  {
    if (all)
      body->evidence->addPoints (
          {scene.background.begin () + static_cast<std::ptrdiff_t> (body->points_read), scene.background.end ()});
    else
      body->evidence->addPoints (*background.at_rest);
    body->points_read = scene.background.size ();
  }
}

/** \brief Warn if a view looks through many of the object's points. \return the contradicted share */
double
judgeAgreement (const Scene& scene, const SceneObject& object, const ViewAgreement& agreement, CompletionLog& log)
{
  const std::string object_name = "object " + std::to_string (object.input->id);
  if (agreement.nothingSeen ())
    log.warn (object_name +
              ": no view sees its points, or looks through them: are the camera, the pose and the unit of "
              "the views right?");
  if (const double turned = agreement.turnedAwayShare (); turned > most_turned_away)
    log.warn (object_name + ": " + std::to_string (std::lround (100.0 * turned)) +
              " % of its normals point away from the views that see them; they must point out of it");
  const auto [share, view] = agreement.worst ();
  if (share > max_contradicted_share)
  {
    const std::string& name = scene.views[static_cast<std::size_t> (view)].depth.name;
    log.warn (object_name + ": " + (name.empty () ? "view " + std::to_string (view) : name) + " looks through " +
              std::to_string (std::lround (100.0 * share)) +
              " % of its points there: a pose may be wrong, or it has moved");
  }
  return share;
}

/** \brief Mark where priors have added targets. \param[in] measured the weights before */
void
markTargets (const std::vector<float>& measured, BodyEnergy& energy)
{
  energy.expects_distance.resize (measured.size ());
  std::transform (measured.begin (), measured.end (), energy.problem.weight.begin (), energy.expects_distance.begin (),
                  [] (float before, float after) { return after != before; });
}

/** \brief Whether points lie on all sides of a place, along \a up and along two directions across it. */
bool
isBetween (const std::vector<OrientedPoint>& points, const Eigen::Vector3d& place, const Eigen::Vector3d& up)
{
  Eigen::Matrix3f axes;
  axes << up.cast<float> (), up.unitOrthogonal ().cast<float> (), up.cross (up.unitOrthogonal ()).cast<float> ();
  Eigen::AlignedBox3f box;
  for (const OrientedPoint& p : points)
    box.extend (axes.transpose () * p.position);
  return box.contains (axes.transpose () * place.cast<float> ());
}

/** \brief ObjectSetting::is_of_other. */
std::function<bool (const Eigen::Vector3d&, const Eigen::Vector3d&)>
placesOfOthers (const std::vector<SceneObject>& objects, std::size_t own, const std::vector<std::uint8_t>& alive)
{
  // Poses are compared when a place is asked for: most objects ask for none.
  using Other = std::pair<const SceneObject*, std::vector<Eigen::Isometry3d>>; // T_other_object
  const auto others = std::make_shared<std::optional<std::vector<Other>>> ();
  return [&objects, own, &alive, others] (const Eigen::Vector3d& place, const Eigen::Vector3d& up) {
    if (!*others)
    {
      others->emplace ();
      for (std::size_t o = 0; o < objects.size (); ++o)
        if (o != own && alive[o])
          (*others)->emplace_back (&objects[o],
                                   relativePoses (*objects[own].input, objects[own].grid (), objects[o].input));
    }
    return std::any_of ((*others)->begin (), (*others)->end (), [&] (const Other& other) {
      return std::any_of (other.second.begin (), other.second.end (), [&] (const Eigen::Isometry3d& T_other_object) {
        const Eigen::Vector3d at = T_other_object * place;
        return other.first->observation->box.contains (at) &&
               isBetween (other.first->points (), at, T_other_object.linear () * up);
      });
    });
  };
}

} // namespace

std::vector<double>
gatherEvidence (const Scene& scene, CompletionMode mode, const std::vector<SceneObject>& objects,
                BackgroundBodies& background, CompletionLog& log)
{
  const bool use_hull = scene.options.use_hull;
  log.timed ("data_term", [&] {
    forEachObject (objects, log, [&] (std::size_t o) { readPoints (objects[o]); });
    readBackground (scene, mode, objects, background);
  });
  return log.timed ("constraints", [&] {
    std::vector<std::optional<ViewAgreement>> agreement (objects.size ());
    if (mode == CompletionMode::Once && use_hull)
      for (std::size_t o = 0; o < objects.size (); ++o)
        agreement[o].emplace (objects[o].points ());
    for (std::size_t v = 0; v < scene.views.size (); ++v)
    {
      const bool is_full = scene.views[v].use == ViewUse::Full;
      const DepthView& depth = scene.views[v].depth;
      std::optional<FreeSpaceView> view; // prepared on first use, and shared by all bodies that have not read it
      const auto show = [&] (BodyState& body, int id, std::optional<ViewAgreement>* with,
                             const Eigen::Isometry3d& T_body_sensor) {
        if (body.views_read > v)
          return;
        body.views_read = v + 1;
        if (!T_body_sensor.matrix ().allFinite ())
          return;
        if (!view)
          view.emplace (depth, bodiesShown (scene, v));
        body.evidence->addView (*view, T_body_sensor, is_full, id);
        if (with && *with)
          (*with)->add (static_cast<int> (v), *view, T_body_sensor, scene.options.threads);
      };
      if (is_full)
      {
        for (BodyState* body : background.bodies)
          show (*body, 0, nullptr, depth.T_world_sensor);
        if (background.blocks)
          for (auto& [place, block] : background.blocks->blocks)
            show (block.body, 0, nullptr, depth.T_world_sensor);
      }
      if (use_hull)
        forEachObject (objects, log, [&] (std::size_t o) {
          show (*objects[o].body, objects[o].input->id, &agreement[o],
                poseAt (*objects[o].input, v).inverse () * depth.T_world_sensor);
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

std::vector<BodyEnergy>
objectEnergies (const Scene& scene, CompletionMode mode, const std::vector<SceneObject>& objects, CompletionLog& log)
{
  std::vector<BodyEnergy> energies (objects.size ());
  const std::vector<std::uint8_t> alive = aliveObjects (objects, log);
  log.timed ("constraints", [&] {
    forEachObjectAtOnce (objects, scene.options.threads, log, [&] (std::size_t o) {
      const SceneObject& object = objects[o];
      BodyState& body = *object.body;
      BodyEnergy energy = makeBodyEnergy (*body.evidence);
      if (mode == CompletionMode::Once)
        body.evidence.reset ();
      if (!energy.hasData ())
        throw DegenerateInput ("no usable measurements: all of its points lie in space that was seen free");
      ObjectSetting setting = settingOf (scene, *object.input);
      setting.is_of_other = placesOfOthers (objects, o, alive);
      const Eigen::Isometry3f T_object_world = firstPose (*object.input).inverse ().cast<float> ();
      for (const OrientedPoint& foot : object.support->feet)
        setting.under_others.push_back ({T_object_world * foot.position, T_object_world.linear () * foot.normal});
      const std::vector<float> measured = energy.problem.weight;
      addPriors (*object.observation, setting, object.planes (), energy);
      markTargets (measured, energy);
      energies[o] = std::move (energy);
    });
  });
  return energies;
}

} // namespace pcl::cosection
