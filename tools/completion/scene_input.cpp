// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "scene_input.h"

#include "label_agreement.h"
#include "object_poses.h"
#include "scene_warnings.h"

#include "pcl_cosection/segmentation/clusters/cloud_segmentation.h"
#include "pcl_cosection/view/organized_cloud.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/mesh_io.h>
#include <pcl/cosection/io/pcd_view.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

using namespace pcl::cosection;

namespace {

constexpr std::size_t min_points = 100;
constexpr std::size_t specks = min_points / 2; ///< points of what may be no object, as a row of mixed pixels
constexpr std::size_t most_skipped = 20;       ///< labels, that are named
constexpr float large_extent = 100.0f;         ///< metres; what is larger is probably not in metres

std::string
tooFew (std::uint32_t label, const LabelledView::Points& object)
{
  std::string text = "label " + std::to_string (label) + (label == 0 ? " (background)" : "") + " is skipped: ";
  if (object.readings >= min_points)
    text += "of its " + std::to_string (object.readings) + " valid points only " +
            std::to_string (object.points.size ()) + " have a reliable normal";
  else
    text += "it has " + std::to_string (object.readings) + " valid points";
  return (text + ", at least " + std::to_string (min_points) + " are needed");
}

/** \brief A view that says nothing, in the place of a file without rays. */
DepthView
silentView ()
{
  DepthView view;
  view.camera = {1, 1, 1.0, 1.0, 0.0, 0.0};
  view.depth.assign (1, std::numeric_limits<float>::quiet_NaN ());
  return (view);
}

/** \brief Whether a view is one that was given before: it says nothing new of free space and background. */
bool
isRepeated (const DepthView& view, const std::vector<DepthView>& earlier)
{
  return std::any_of (earlier.begin (), earlier.end (), [&] (const DepthView& other) {
    return other.T_world_sensor.matrix () == view.T_world_sensor.matrix () &&
           std::equal (other.depth.begin (), other.depth.end (), view.depth.begin (), view.depth.end (),
                       [] (float a, float b) { return a == b || (std::isnan (a) && std::isnan (b)); });
  });
}

/** \brief Add what a file shows of free space, and for each view the number of the file. \param[in] needed a file
 * without rays gets a view that says nothing, as poses come one per view */
void
addViews (LabelledView& read, std::size_t input, bool needed, std::vector<DepthView>& views,
          std::vector<std::size_t>& inputs)
{
  if (!read.view && !needed)
    return;
  read.other_views.insert (read.other_views.begin (), read.view ? std::move (*read.view) : silentView ());
  for (DepthView& view : read.other_views)
  {
    views.push_back (std::move (view));
    inputs.push_back (input);
  }
}

using Labels = std::map<std::uint32_t, LabelledView::Points>;

/** \brief Add what a view has of each label, in the frame of the object. */
void
merge (const std::string& path, std::size_t index, LabelledView& view, const ObjectPoses& poses, Labels& labels,
       std::vector<std::string>& warnings)
{
  for (auto& [label, object] : view.objects)
  {
    const std::vector<Eigen::Isometry3d> T_world_object = posesOf (poses, label);
    if (!T_world_object.empty () && !T_world_object[index].matrix ().allFinite ())
    {
      warnings.push_back (path + ": its points of label " + std::to_string (label) +
                          " are left out, the object's trajectory has no pose for view " + std::to_string (index));
      continue;
    }
    if (!T_world_object.empty ())
      transform (T_world_object[index].inverse (), object.points);
    LabelledView::Points& merged = labels[label];
    merged.readings += object.readings;
    if (merged.points.empty ())
      merged.points = std::move (object.points);
    else
      merged.points.insert (merged.points.end (), object.points.begin (), object.points.end ());
  }
}

TriangleMesh
readObstacle (const std::string& path, const Eigen::Vector3d& origin, const SceneReaders& readers,
              std::vector<std::string>& warnings)
{
  TriangleMesh mesh = readers.obstacle (path, origin);
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& v : mesh.vertices)
    box.extend (v);
  if (box.sizes ().maxCoeff () > large_extent)
    warnings.push_back (path + ": is larger than " + std::to_string (static_cast<int> (large_extent)) +
                        " m; obstacles are in metres, in the world frame");
  try
  {
    CoSection ().addObstacle (mesh); // refuses what bounds nothing
  }
  catch (const InvalidArgument& error)
  {
    throw InvalidArgument (path + ": " + error.what ());
  }
  return (mesh);
}

/** \brief How to read a view: with the memory that the points of earlier ones leave. */
PcdViewOptions
optionsOf (std::size_t view, const Settings& settings, const Labels& labels)
{
  PcdViewOptions options = settings.reading;
  if (!settings.viewpoints.empty ())
    options.viewpoint = settings.viewpoints[view];
  std::size_t used = 0;
  for (const auto& [label, object] : labels)
    used += object.points.size () * sizeof (OrientedPoint);
  if (options.max_memory_bytes > 0)
    options.max_memory_bytes -= std::min (used, options.max_memory_bytes - 1);
  return (options);
}

/** \brief A mesh of any frame. */
TriangleMesh
readProposal (const std::string& path)
{
  return (loadMesh (path, localOrigin (path)));
}

/** \brief The meshes that may be the shape of an object. */
std::vector<TriangleMesh>
proposalsOf (int id, const Settings& settings, const SceneReaders& readers)
{
  std::vector<TriangleMesh> proposals;
  for (const auto& [label, name] : settings.proposals)
    if (label == id)
      proposals.push_back (readers.proposal (name));
  return proposals;
}

/** \brief Warn of proposals for objects that are not there. */
void
warnOfUnknown (const Settings& settings, SceneInput& scene)
{
  for (const auto& [id, file] : settings.proposals)
    if (scene.objects.count (id) == 0)
      scene.warnings.push_back ("--proposal " + std::to_string (id) + "=" + file + ": there is no object " +
                                std::to_string (id));
}

/** \brief The labels of objects that are found in a file. \throws DegenerateInput if there are none */
std::vector<std::uint32_t>
findLabels (const std::string& path, const Settings& settings, const PcdViewOptions& reading,
            std::vector<std::string>& warnings)
{
  ObjectSegmentationOptions options;
  options.threads = settings.method.threads;
  if (settings.max_object_size_m > 0.0)
    options.max_object_size_m = settings.max_object_size_m;
  ObjectSegmentation found;
  std::string hint;
  try
  {
    const OrganizedCloud cloud = readOrganizedCloud (path, reading, true);
    if (hint = hintOfUnit (cloud.points); !hint.empty ())
      hint = "; it " + hint;
    found = segmentCloud (cloud, options);
  }
  catch (const DegenerateInput& error)
  {
    const std::string reason = error.what () + hint;
    throw DegenerateInput (reason.rfind (path, 0) == 0 ? reason : path + ": " + reason);
  }
  std::map<std::uint32_t, std::size_t> counts;
  for (const std::uint32_t label : found.labels)
    ++counts[label];
  const auto small = std::count_if (counts.begin (), counts.end (), [] (const auto& label) {
    return label.first > 0 && label.second < min_points && label.second > specks;
  });
  if (small > 0)
    warnings.push_back (path + ": " + std::to_string (small) + " of the objects that were found " +
                        (small == 1 ? "is" : "are") + " left out, with fewer than " + std::to_string (min_points) +
                        " points");
  for (std::uint32_t& label : found.labels)
    if (counts[label] < min_points) // small components, which come last
    {
      found.objects = std::min (found.objects, label == 0 ? found.objects : label - 1);
      label = 0;
    }
  for (const std::string& warning : warningsOf (found, options))
    warnings.push_back (path + ": " + warning);
  if (found.objects == 0)
    throw DegenerateInput (path +
                           ": no object was found on its planes; give labels, --max-object-size, or try "
                           "pcl_cosection_segment with other sizes" +
                           hint);
  if (!settings.save_labels.empty ())
    copyWithLabels (path, found.labels, settings.save_labels);
  return std::move (found.labels);
}

/** \brief Take the background and the objects of which there are enough points. */
void
addObjects (const Settings& settings, const SceneReaders& readers, const ObjectPoses& poses, Labels& labels,
            SceneInput& scene)
{
  std::size_t skipped = 0;
  for (auto& [label, object] : labels)
  {
    const int id = static_cast<int> (label);
    if (object.points.size () < min_points)
    {
      if (skipped++ < most_skipped)
        scene.warnings.push_back (tooFew (label, object));
    }
    else if (label == 0)
      scene.background = std::move (object.points);
    else
    {
      if (const auto warning = tooLong (label, object.points))
        scene.warnings.push_back (*warning);
      scene.objects[id] = {id, std::move (object.points), posesOf (poses, label), proposalsOf (id, settings, readers)};
    }
  }
  if (skipped > most_skipped)
    scene.warnings.push_back (std::to_string (skipped - most_skipped) +
                              " more labels are skipped, as they have too few "
                              "points; are these the labels of objects?");
}

} // namespace

Eigen::Vector4d
relativeTo (const Eigen::Vector3d& origin, const Eigen::Vector4d& plane)
{
  return {plane[0], plane[1], plane[2], plane[3] + plane.head<3> ().dot (origin)};
}

void
transform (const Eigen::Isometry3d& T_target_points, std::vector<OrientedPoint>& points)
{
  for (OrientedPoint& point : points)
  {
    point.position = (T_target_points * point.position.cast<double> ()).cast<float> ();
    point.normal = (T_target_points.linear () * point.normal.cast<double> ()).cast<float> ();
  }
}

SceneReaders
SceneReaders::ofFiles ()
{
  return {readPcdView, [] (const std::string& path, const Eigen::Vector3d& origin) { return loadMesh (path, origin); },
          readProposal, readPoses};
}

SceneInput
readScene (const Settings& settings, const ProgressCallback& progress, const SceneReaders& readers)
{
  SceneInput scene;
  const std::size_t files = settings.inputs.size () + settings.free_space.size ();
  const ObjectPoses poses = readers.poses (settings.object_trajectories, files);
  Labels labels;
  LabelAgreement agreement;
  std::vector<std::size_t> inputs; // of each view, the file that it is of
  std::size_t begun = 0;
  const auto read = [&] (const std::string& path) {
    if (!progress ("reading " + std::filesystem::path (path).filename ().string (),
                   static_cast<double> (begun) / static_cast<double> (files)))
      throw Cancelled ("interrupted");
    PcdViewOptions options = optionsOf (begun++, settings, labels);
    if (begun > 1)
      options.origin = {scene.origin.x (), scene.origin.y (), scene.origin.z ()};
    if (settings.segment && begun == 1)
      options.labels = findLabels (path, settings, options, scene.warnings);
    LabelledView view = readers.view (path, options);
    scene.origin = view.origin;
    std::move (view.warnings.begin (), view.warnings.end (), std::back_inserter (scene.warnings));
    return (view);
  };
  for (const std::string& path : settings.inputs)
  {
    LabelledView view = read (path);
    if (const auto warning = wholeScene (view))
      scene.warnings.push_back (path + ": " + *warning);
    if (poses.empty ())
      if (const auto warning = agreement.add (view))
        scene.warnings.push_back (path + ": " + *warning);
    if (poses.empty () && view.view && isRepeated (*view.view, scene.views))
    {
      view.view.reset ();
      view.other_views.clear ();
      view.objects.erase (0);
    }
    merge (path, begun - 1, view, relativeTo (scene.origin, poses), labels, scene.warnings);
    addViews (view, begun - 1, !poses.empty (), scene.views, inputs);
  }
  for (const std::string& path : settings.free_space)
  {
    LabelledView view = read (path);
    if (!view.view)
      throw DegenerateInput (path +
                             ": shows no free space: it is no image of a pinhole camera, nor seen from its VIEWPOINT");
    addViews (view, begun - 1, true, scene.free_space, inputs);
  }
  for (const std::string& file : settings.obstacles)
    scene.obstacles.push_back (readObstacle (file, scene.origin, readers, scene.warnings));
  scene.view_inputs.assign (inputs.begin (), inputs.begin () + static_cast<std::ptrdiff_t> (scene.views.size ()));
  const ObjectPoses relative_poses = ofInputs (inputs, relativeTo (scene.origin, poses));

  addObjects (settings, readers, relative_poses, labels, scene);
  warnOfUnknown (settings, scene);
  if (scene.objects.empty ())
  {
    std::string reason = "no object to complete";
    if (labels.size () == 1 && labels.count (0) == 1)
      reason += settings.reading.ignored_labels.empty ()
                    ? ": all points have label 0, the background"
                    : ": all points but those that --ignore leaves out have label 0, the background";
    else if (!scene.warnings.empty ())
      reason += ": " + scene.warnings.back ();
    throw DegenerateInput (reason);
  }
  for (const Eigen::Vector4d& plane : settings.planes)
    scene.planes.push_back (relativeTo (scene.origin, plane));
  const std::optional<std::string> distant = distantPlanes (scene);
  if (distant)
    scene.planes.clear (); // objects would reach down to them
  for (const auto& warning : {smallBackground (scene), objectLikeBackground (scene, settings.reading.background_labels),
                              distant, largeVoxels (scene, settings.method.voxel_size_m)})
    if (warning)
      scene.warnings.push_back (*warning);
  for (const auto& [label, file] : settings.object_trajectories)
    if (labels.count (static_cast<std::uint32_t> (label)) == 0)
      scene.warnings.push_back (file + ": is not used, there is no object " + std::to_string (label));
  return (scene);
}
