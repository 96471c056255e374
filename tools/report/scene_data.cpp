// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "scene_data.h"

#include "embedding.h"

#include "pcl_cosection/visualization/scene_legend.h"
#include "pcl_cosection/volume/mesh_distance/mesh_surface.h"
#include <pcl/cosection/visualization/scene_picture.h>

#include <algorithm>
#include <cmath>
#include <set>

using namespace pcl::cosection;

namespace {

constexpr std::size_t background_triangles = 60000;
constexpr std::size_t object_triangles = 24000; ///< of a completed mesh; two thirds of that of what was seen
constexpr std::size_t all_triangles = 240000;   ///< of all objects' completed meshes together
constexpr std::size_t most_frames = 1500;       ///< the trajectory is thinned evenly
constexpr double nearer = 0.8;                  ///< than a picture of everything: one may turn and move
constexpr double pose_steps = 1e5;              ///< per metre, and of quaternions

/** \brief Written with few digits. */
Json
shortNumbers (const std::vector<double>& values)
{
  Json json = Json::array ();
  for (const double value : values)
    json.push_back (std::round (value * pose_steps) / pose_steps + 0.0); // not -0
  return (json);
}

Json
toJson (const Eigen::Vector3d& v)
{
  return (shortNumbers ({v.x (), v.y (), v.z ()}));
}

Json
toJson (const Eigen::Isometry3d* pose)
{
  if (pose == nullptr)
    return (Json ());
  const Eigen::Vector3d t = pose->translation ();
  const Eigen::Quaterniond q (pose->linear ());
  return (shortNumbers ({t.x (), t.y (), t.z (), q.x (), q.y (), q.z (), q.w ()}));
}

/** \brief The stamps of the camera, else of the objects, else 0; not too many. */
std::vector<double>
stampsOf (const RunFolder& run)
{
  std::set<double> all;
  for (const StampedPose& pose : run.camera)
    all.insert (pose.stamp);
  if (all.empty ())
    for (const RunObject& object : run.objects)
      for (const StampedPose& pose : object.poses)
        all.insert (pose.stamp);
  if (all.empty ())
    all.insert (0.0);
  const std::size_t step = (all.size () + most_frames - 1) / most_frames;
  std::vector<double> stamps;
  std::size_t n = 0;
  for (const double stamp : all)
    if (n++ % step == 0)
      stamps.push_back (stamp);
  return (stamps);
}

/** \brief The pose of each stamp; without any poses, the origin. */
Json
posesAt (const std::vector<StampedPose>& poses, const std::vector<double>& stamps)
{
  const Eigen::Isometry3d origin = Eigen::Isometry3d::Identity ();
  Json json = Json::array ();
  for (const double stamp : stamps)
    json.push_back (toJson (poses.empty () ? &origin : poseAt (poses, stamp)));
  return (json);
}

Json
shown (const ReportContent& content, const RunObject& object, const TriangleMesh& mesh, std::size_t most_triangles)
{
  if (mesh.empty ())
    return (Json ());
  const TriangleMesh small = forDisplay (mesh, most_triangles);
  if (!content.truth)
    return (embedMesh (small));
  return (embedMesh (small, errorsOf (*content.truth, object.id, small, content.threads), content.scene.error_max_m));
}

/** \brief From where the first view is; without trajectories, around what is there. */
Viewpoint
firstView (const ReportContent& content)
{
  const bool has_objects = std::any_of (content.scene.run.objects.begin (), content.scene.run.objects.end (),
                                        [] (const SceneRecord::Object& object) { return (!object.mesh.empty ()); });
  if (!content.scene.run.camera.empty () && (has_objects || !content.run.background.empty ()))
  {
    Viewpoint view = overview (content.scene);
    view.eye = view.target + nearer * (view.eye - view.target);
    return (view);
  }
  Eigen::AlignedBox3d box;
  for (const RunObject& object : content.run.objects)
    box.extend (vertexBox (object.completed.empty () ? object.seen : object.completed));
  if (box.isEmpty ())
    box = vertexBox (content.run.background);
  if (box.isEmpty ())
    box.extend (Eigen::Vector3d::Zero ());
  Viewpoint view;
  view.target = box.center ();
  view.eye = box.center () + std::max (1e-3, box.diagonal ().norm ()) * Eigen::Vector3d (0.8, -1.0, 0.75);
  view.up = Eigen::Vector3d::UnitZ ();
  return (view);
}

} // namespace

Json
sceneData (const ReportContent& content)
{
  const RunFolder& run = content.run;
  const std::vector<double> stamps = stampsOf (run);
  const Viewpoint view = firstView (content);
  Json json;
  json["up"] = toJson (view.up);
  json["target"] = toJson (view.target);
  json["eye"] = toJson (view.eye);
  json["is_frame"] = std::all_of (stamps.begin (), stamps.end (),
                                  [] (double stamp) { return (stamp == std::floor (stamp) && stamp < 1e7); });
  json["stamps"] = stamps;
  json["camera"] = run.camera.empty () ? Json () : posesAt (run.camera, stamps);
  if (run.intrinsics)
    json["intrinsics"] = {{"fx", run.intrinsics->fx},       {"fy", run.intrinsics->fy},
                          {"cx", run.intrinsics->cx},       {"cy", run.intrinsics->cy},
                          {"width", run.intrinsics->width}, {"height", run.intrinsics->height}};
  json["error_max_mm"] = content.truth ? Json (1000.0 * content.scene.error_max_m) : Json ();
  json["background"] = run.background.empty () ? Json ()
                                               : embedMesh (forDisplay (run.background, background_triangles));
  json["objects"] = Json::array ();
  const std::size_t most = std::min (object_triangles, all_triangles / std::max<std::size_t> (1, run.objects.size ()));
  for (const RunObject& object : run.objects)
  {
    if (object.completed.empty () && object.seen.empty ())
      continue;
    json["objects"].push_back ({{"id", object.id},
                                {"name", nameOf (object, content)},
                                {"colour", instanceColour (object.id)},
                                {"poses", posesAt (object.poses, stamps)},
                                {"completed", shown (content, object, object.completed, most)},
                                {"seen", shown (content, object, object.seen, 2 * most / 3)}});
  }
  return (json);
}

std::string
asScriptText (const Json& json)
{
  std::string text;
  for (const char c : json.dump (-1, ' ', false, Json::error_handler_t::replace))
    if (c == '<') // only in texts: </script> and <!-- would mean something
      text += "\\u003c";
    else
      text += c;
  return (text);
}
