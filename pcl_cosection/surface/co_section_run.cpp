// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "co_section_run.h"

#include "mesh_colours.h"
#include "volume_layout.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/surface/support_plane.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pcl
{
namespace cosection
{

namespace
{

constexpr double background_voxels_per_object_voxel = 2.0;
constexpr double background_only_resolution = 128.0; // voxels along the longest side, if there is no object
constexpr double plane_inlier_voxels = 2.0;
constexpr double min_plane_inlier_m = 0.004;
constexpr double default_padding = 0.3; // of the longest side, where views and prior do not say how far a shape reaches
constexpr double same_pose_voxels = 0.5;
constexpr double same_plane_cosine = 0.999;
constexpr double same_plane_m = 0.005;

std::vector<Eigen::Vector3d>
corners (const Eigen::AlignedBox3d& box)
{
  std::vector<Eigen::Vector3d> points;
  for (int c = 0; c < 8; ++c)
    points.push_back (box.corner (static_cast<Eigen::AlignedBox3d::CornerType> (c)));
  return points;
}

} // namespace

CoSectionRun::CoSectionRun (const CoSection::Impl& scene, const ProgressCallback& progress)
: scene_ (scene), progress_ (progress)
{}

void
CoSectionRun::report (const std::string& stage, double fraction) const
{
  if (progress_ && !progress_ (stage, std::min (1.0, fraction)))
    throw Cancelled ("cancelled");
}

Eigen::Isometry3d
CoSectionRun::pose (const Object& object, std::size_t view) const
{
  const auto& poses = object.input->T_world_object;
  return poses.empty () ? Eigen::Isometry3d::Identity () : poses[std::min (view, poses.size () - 1)];
}

std::vector<Eigen::Isometry3d>
CoSectionRun::relativePoses (const Object& of, const Object* to) const
{
  const std::size_t times =
      std::max<std::size_t> (1, std::max (of.input->T_world_object.size (), to ? to->input->T_world_object.size () : 0));
  const std::vector<Eigen::Vector3d> probes = corners (boxOf (of.volume->grid ()));
  const double same = same_pose_voxels * of.volume->grid ().voxel_size_m;
  std::vector<Eigen::Isometry3d> poses;
  for (std::size_t t = 0; t < times; ++t)
  {
    const Eigen::Isometry3d T = (to ? pose (*to, t).inverse () : Eigen::Isometry3d::Identity ()) * pose (of, t);
    const auto moved = [&] (const Eigen::Isometry3d& other) {
      return std::any_of (probes.begin (), probes.end (),
                          [&] (const Eigen::Vector3d& p) { return (T * p - other * p).norm () > same; });
    };
    if (std::all_of (poses.begin (), poses.end (), moved))
      poses.push_back (T);
  }
  return poses;
}

void
CoSectionRun::observeObjects ()
{
  result_.objects.resize (scene_.objects.size ());
  objects_.resize (scene_.objects.size ());
  for (std::size_t i = 0; i < objects_.size (); ++i)
  {
    Object& object = objects_[i];
    object.input = &scene_.objects[i];
    object.result = &result_.objects[i];
    object.result->id = object.input->id;
  }
  for (Object& object : objects_)
    guarded (object, [&] {
      if (!object.input->T_world_object.empty () && object.input->T_world_object.size () != scene_.views.size ())
        throw InvalidArgument ("there are " + std::to_string (object.input->T_world_object.size ()) + " poses for " +
                               std::to_string (scene_.views.size ()) + " views");
      object.observed = observedBox (object.input->points);
      object.voxel_size_m = objectVoxelSize (object.input->points, object.observed, scene_.options);
    });
}

Eigen::AlignedBox3d
CoSectionRun::volumeBox (const Object& object) const
{
  const CoSectionOptions& options = scene_.options;
  if (options.padding > 0.0 || !options.use_extent_prior || !options.use_hull || scene_.views.empty ())
  {
    const double fraction = options.padding > 0.0 ? options.padding : default_padding;
    const Eigen::Vector3d pad =
        Eigen::Vector3d::Constant (fraction * object.observed.sizes ().maxCoeff () + 2.0 * object.voxel_size_m);
    return {object.observed.min () - pad, object.observed.max () + pad};
  }
  std::vector<std::pair<const DepthView*, Eigen::Isometry3d>> views;
  std::vector<Eigen::Vector4d> planes;
  for (std::size_t v = 0; v < scene_.views.size (); ++v)
  {
    const DepthView& view = scene_.views[v].view ();
    views.emplace_back (&view, pose (object, v).inverse () * view.T_world_sensor);
    for (const Eigen::Vector4d& plane : object.planes)
      planes.push_back (transformPlane (plane, pose (object, v)));
  }
  return possibleBox (object.input->points, object.observed, object.voxel_size_m, views, planes, options.threads);
}

void
CoSectionRun::createVolumes ()
{
  for (Object& object : objects_)
    if (object.alive ())
      guarded (object, [&] {
        const VoxelGrid grid = layoutBox (volumeBox (object), object.voxel_size_m, scene_.options);
        object.volume = std::make_unique<ShapeVolume> (grid, scene_.options);
      });
}

Eigen::Vector4d
CoSectionRun::towards (const Object& object, const Eigen::Vector4d& plane) const
{
  const Eigen::Vector4d local = transformPlane (plane, pose (object, 0));
  std::ptrdiff_t above = 0;
  for (const OrientedPoint& p : object.input->points)
    above += local.head<3> ().dot (p.position.cast<double> ()) + local[3] > 0.0 ? 1 : -1;
  return above < 0 ? Eigen::Vector4d (-plane) : plane;
}

void
CoSectionRun::findPlanes ()
{
  if (!scene_.options.use_intersection)
    return;
  for (Object& object : objects_)
  {
    if (!object.alive ())
      continue;
    for (const Eigen::Vector4d& plane : scene_.planes)
      object.planes.push_back (towards (object, plane));
    if (scene_.options.use_planes && !scene_.background.empty ())
    {
      std::vector<OrientedPoint> points = object.input->points;
      for (OrientedPoint& p : points)
        p.position = (pose (object, 0) * p.position.cast<double> ()).cast<float> ();
      SupportPlaneOptions options;
      options.inlier_distance_m =
          std::max (min_plane_inlier_m, plane_inlier_voxels * object.voxel_size_m);
      for (const Eigen::Vector4d& plane : findSupportPlanes (scene_.background, points, options))
        object.planes.push_back (plane);
    }
    const Eigen::Vector3d center = pose (object, 0) * object.observed.center ();
    for (const Eigen::Vector4d& plane : object.planes)
    {
      const bool known = std::any_of (result_.planes.begin (), result_.planes.end (), [&] (const Eigen::Vector4d& other) {
        return plane.head<3> ().dot (other.head<3> ()) > same_plane_cosine &&
               std::abs ((plane - other).head<3> ().dot (center) + plane[3] - other[3]) < same_plane_m;
      });
      if (!known)
        result_.planes.push_back (plane);
    }
  }
}

void
CoSectionRun::solveBackground ()
{
  if (scene_.background.empty ())
    return;
  std::vector<Eigen::AlignedBox3d> boxes;
  std::vector<PlaneContinuation> planes;
  double voxel = scene_.options.background_voxel_size_m;
  double smallest = std::numeric_limits<double>::infinity ();
  for (const Object& object : objects_)
  {
    if (!object.alive ())
      continue;
    Eigen::AlignedBox3d box;
    for (const Eigen::Isometry3d& T : relativePoses (object, nullptr))
      for (const Eigen::Vector3d& corner : corners (boxOf (object.volume->grid ())))
        box.extend (T * corner);
    boxes.push_back (box);
    smallest = std::min (smallest, object.volume->grid ().voxel_size_m);
    for (const Eigen::Vector4d& plane : object.planes)
      planes.push_back ({plane, box});
  }
  // Where planes of several objects overlap the last one counts; it must not depend on the objects' order.
  std::sort (planes.begin (), planes.end (), [] (const PlaneContinuation& a, const PlaneContinuation& b) {
    const auto key = [] (const PlaneContinuation& p) {
      return std::array<double, 7>{p.plane[0], p.plane[1], p.plane[2], p.plane[3],
                                   p.region.min ().x (), p.region.min ().y (), p.region.min ().z ()};
    };
    return key (a) < key (b);
  });
  if (boxes.empty ())
  {
    Eigen::AlignedBox3d box;
    for (const OrientedPoint& p : scene_.background)
      if (p.position.allFinite ())
        box.extend (p.position.cast<double> ());
    boxes.push_back (box);
    smallest = box.sizes ().maxCoeff () / background_only_resolution / background_voxels_per_object_voxel;
  }
  if (voxel <= 0.0)
    voxel = background_voxels_per_object_voxel * smallest;
  boxes = uniteOverlapping (std::move (boxes));
  for (const Eigen::AlignedBox3d& box : boxes)
  {
    try
    {
      ShapeVolume volume (layoutBox (box, voxel, scene_.options), scene_.options);
      timed ("data_term", [&] { volume.addPoints (scene_.background); });
      timed ("constraints", [&] {
        for (const FreeSpaceView& view : scene_.views)
          volume.addView (view, view.view ().T_world_sensor);
        volume.prepare (planes);
      });
      if (!volume.hasData ())
        continue;
      timed ("solve", [&] {
        volume.solve (Resolution::Full, [this] (const std::string&, double f) {
          report ("background", 0.3 * f);
          return true;
        });
      });
      timed ("mesh", [&] {
        TriangleMesh mesh = volume.trimmedMesh ();
        transferColours (scene_.background, volume.grid (), mesh);
        appendMesh (result_.background, mesh);
      });
      background_.push_back (volume.solvedField ());
    }
    catch (const Cancelled&)
    {
      throw;
    }
    catch (const Error& e)
    {
      result_.warnings.push_back (std::string ("the background was left out: ") + e.what ());
    }
  }
}

void
CoSectionRun::prepareObject (Object& object)
{
  std::vector<std::pair<const DepthView*, Eigen::Isometry3d>> views;
  timed ("data_term", [&] { object.volume->addPoints (object.input->points); });
  timed ("constraints", [&] {
    for (std::size_t v = 0; v < scene_.views.size (); ++v)
    {
      const DepthView& view = scene_.views[v].view ();
      const Eigen::Isometry3d T_object_sensor = pose (object, v).inverse () * view.T_world_sensor;
      views.emplace_back (&view, T_object_sensor);
      if (scene_.options.use_hull)
        object.volume->addView (scene_.views[v], T_object_sensor);
    }
    if (scene_.options.use_hull && scene_.options.carve_free_space && !views.empty ())
    {
      FreeSpaceCarving carving (object.volume->grid (), scene_.options.revise_votes, scene_.options.threads);
      for (std::size_t v = 0; v < views.size (); ++v)
        carving.add (scene_.views[v], views[v].second);
      object.volume->setCarving (carving);
    }
    object.volume->prepare ();
    if (!object.volume->hasData ())
      throw DegenerateInput ("no usable measurements: all of its points lie in space that was seen free");
    if (scene_.options.use_extent_prior)
      object.volume->addExtentPrior (object.input->points, views);
    if (scene_.options.use_contact_prior && !views.empty ())
      for (const Eigen::Isometry3d& T_world_object : relativePoses (object, nullptr))
        for (const Eigen::Vector4d& plane : object.planes)
          object.volume->addContactPrior (object.input->points, transformPlane (plane, T_world_object),
                                          views.front ().second.translation ());
  });
  object.told = object.volume->measuredField ();
}

void
CoSectionRun::finishObject (Object& object)
{
  object.field = object.volume->solvedField ();
  object.result->mesh = object.volume->closedMesh ();
  if (object.result->mesh.empty ())
    throw DegenerateInput ("its measurements determine no closed surface");
  transferColours (object.input->points, object.volume->grid (), object.result->mesh);
  object.result->signed_distance = std::make_shared<SignedDistanceField> (object.field);
}

SceneResult
CoSectionRun::run ()
{
  report ("measurements", 0.0);
  observeObjects ();
  timed ("constraints", [&] {
    findPlanes ();
    createVolumes ();
  });
  solveBackground ();
  for (Object& object : objects_)
    if (object.alive ())
      guarded (object, [&] { prepareObject (object); });
  solveObjects ();
  timed ("mesh", [&] {
    for (Object& object : objects_)
      if (object.alive ())
        guarded (object, [&] { finishObject (object); });
    for (Object& object : objects_)
      if (object.alive () && scene_.options.use_intersection)
        object.result->penetration_m = penetration (object);
  });
  report ("done", 1.0);
  return std::move (result_);
}

} // namespace cosection
} // namespace pcl
