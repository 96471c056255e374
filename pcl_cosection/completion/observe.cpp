// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "observe.h"

#include "pcl_cosection/completion/grid/volume_layout.h"
#include "pcl_cosection/completion/grid/voxel_size.h"
#include "pcl_cosection/priors/extent_prior.h"
#include "pcl_cosection/priors/shape_fits.h"
#include "pcl_cosection/view/outliers/outlier_points.h"
#include "pcl_cosection/view/outliers/point_groups.h"
#include "pcl_cosection/view/virtual_viewpoint.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace pcl::cosection {
namespace {

constexpr double outlier_reach_voxels = 3.0;  // cutoff of a point in the data term
constexpr double max_outlier_share = 0.2;     // if more points seem to be outliers, all points are kept
constexpr double least_spacings_across = 5.0; // least middle extent of an object, in supported voxels

std::string
nameOf (const ObjectInput& object)
{
  return "object " + std::to_string (object.id);
}

void
checkInput (const Scene& scene, const ObjectInput& object)
{
  const std::size_t poses = object.T_world_object.size (), points = object.points.size ();
  if (poses != 0 && poses != scene.views.size ())
    throw InvalidArgument ("there are " + std::to_string (poses) + " poses for " +
                           std::to_string (scene.views.size ()) + " views");
  if (!firstPose (object).matrix ().allFinite ())
    throw InvalidArgument ("none of its poses is known");
  if (points < scene.options.min_points)
    throw DegenerateInput ("it has " + std::to_string (points) + " points with a normal, at least " +
                           std::to_string (scene.options.min_points) + " are needed");
}

void
measure (const CoSectionOptions& options, Observation& object)
{
  object.box = observedBox (object.points (), options.threads);
  const PointSpacing spacing = measureSpacing (object.points (), object.box);
  object.spacing_m = spacing.supported_m;
  object.voxel_size_m = objectVoxelSize (spacing, object.box, options);
}

/** \brief Marks small groups of points far from all others, which would become separate components. */
std::vector<bool>
findOutliers (const Observation& object)
{
  const std::vector<OrientedPoint>& points = *object.all_points;
  const double reach_m = outlier_reach_voxels * std::max (object.voxel_size_m, object.spacing_m);
  std::vector<bool> outliers = findOutlierPoints (points, object.box.center (), reach_m);
  const auto count = static_cast<double> (std::count (outliers.begin (), outliers.end (), true));
  if (count > max_outlier_share * static_cast<double> (points.size ()))
    outliers.assign (points.size (), false);
  return outliers;
}

/** \brief The views for which the object's pose is known, and T_object_sensor; not those for free space only. */
OcclusionMap::Views
viewsOf (const Scene& scene, const ObjectInput& object)
{
  OcclusionMap::Views views;
  for (std::size_t v = 0; v < scene.views.size (); ++v)
  {
    if (scene.views[v].use == ViewUse::FreeSpace)
      continue;
    const DepthView& view = scene.views[v].depth;
    const Eigen::Isometry3d T_object_sensor = poseAt (object, v).inverse () * view.T_world_sensor;
    const bool has_reading = std::any_of (view.depth.begin (), view.depth.end (),
                                          [] (float z) { return std::isfinite (z); });
    if (T_object_sensor.matrix ().allFinite () && has_reading)
      views.emplace_back (&view, T_object_sensor);
  }
  return views;
}

void
warnIfFarApart (const ObjectInput& input, const Observation& object, CompletionLog& log)
{
  const double gap_m = gapBetweenGroups (object.points (), object.box);
  if (gap_m > 0.0)
    log.warn (nameOf (input) + ": its points lie in groups " + std::to_string (std::lround (100.0 * gap_m)) +
              " cm apart, each smaller than that: a pose may be wrong, or two things have one label");
}

/** \brief Warn if the voxels that the points support are too large for the object. */
void
warnIfCoarse (const ObjectInput& input, const Observation& object, CompletionLog& log)
{
  const double h = object.spacing_m;
  if (object.extents_m[1] > least_spacings_across * h)
    return;
  std::ostringstream text;
  text << std::fixed << std::setprecision (1);
  text << nameOf (input) << ": its points are so far apart that what is finer than " << 1e3 * h
       << " mm does not show, and it is only " << 1e3 * object.extents_m[1]
       << " mm across (points nearer together tell more)";
  log.warn (text.str ());
}

} // namespace

std::vector<Observation>
observeObjects (const Scene& scene, CompletionMode mode, SceneState& state, CompletionLog& log)
{
  const CoSectionOptions& options = scene.options;
  return log.forEachObject ([&] (std::size_t o) {
    const ObjectInput& input = scene.objects[o];
    BodyState& body = state.objects[input.id];
    checkInput (scene, input);
    Observation object;
    object.all_points = &input.points;
    object.fits = std::make_shared<ShapeFits> ();
    measure (options, object);

    std::vector<bool> outliers = findOutliers (object);
    if (!std::equal (body.outliers.begin (), body.outliers.end (), outliers.begin ()))
      body.readPointsAgain ();
    body.outliers = std::move (outliers);
    if (std::any_of (body.outliers.begin (), body.outliers.end (), [] (bool outlier) { return outlier; }))
    {
      for (std::size_t p = 0; p < input.points.size (); ++p)
        if (!body.outliers[p])
          object.inliers.push_back (input.points[p]);
      measure (options, object);
    }
    warnIfFarApart (input, object, log);
    object.extents_m = observedExtents (object.points (), options.threads);
    if (mode == CompletionMode::Once && !fixedVoxelSize (options))
      warnIfCoarse (input, object, log);

    object.views = viewsOf (scene, input);
    if (!options.use_extent_prior)
      return object;
    if (object.views.empty ())
      if (std::optional<DepthView> view = virtualViewpoint (object.points ()))
      {
        object.virtual_view = std::make_shared<const DepthView> (std::move (*view));
        object.views.emplace_back (object.virtual_view.get (), object.virtual_view->T_world_sensor);
        body.hidden.clear (); // the virtual view differs each time
      }
    body.hidden.add (object.views, object.points (), options.threads);
    return object;
  });
}

} // namespace pcl::cosection
