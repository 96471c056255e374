// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "scene_data.h"

#include "mesh_embedding.h"
#include "scene_directions.h"

#include <algorithm>
#include <cmath>
#include <set>

using namespace pcl::cosection;

namespace
{

constexpr double pose_steps = 1e5;    ///< per metre, and of quaternions
constexpr double eye_distance = 1.15; ///< of the first view, in distances of the first camera

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

/** \brief The stamps of the camera, else of the objects, else 0; no more than \a most. */
std::vector<double>
stampsOf (const RunFolder& run, std::size_t most)
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
  const std::size_t step = (all.size () + most - 1) / most;
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
  return (embedMesh (small, errorsOf (*content.truth, object.id, small, content.threads), content.truth->error_max_m));
}

/** \brief Where the objects are in the middle of the sequence; the background's middle without objects. */
Eigen::Vector3d
targetOf (const RunFolder& run)
{
  Eigen::Vector3d sum = Eigen::Vector3d::Zero ();
  double count = 0.0;
  for (const RunObject& object : run.objects)
  {
    const TriangleMesh& mesh = object.completed.empty () ? object.seen : object.completed;
    if (mesh.empty ())
      continue;
    const Eigen::Isometry3d pose = object.poses.empty () ? Eigen::Isometry3d::Identity () : object.poses[object.poses.size () / 2].pose;
    sum += pose * middleOf (mesh);
    ++count;
  }
  return (count > 0.0 ? Eigen::Vector3d (sum / count) : middleOf (run.background));
}

/** \brief From where the first view is: behind and above the middle camera. */
Eigen::Vector3d
eyeOf (const RunFolder& run, const Eigen::Vector3d& target, const Eigen::Vector3d& up)
{
  if (!run.camera.empty ())
    return (target + eye_distance * (run.camera[run.camera.size () / 2].pose.translation () - target));
  return (target + 1.5 * (up + up.unitOrthogonal ()));
}

} // namespace

Json
sceneData (const ReportContent& content, const SceneBudget& budget)
{
  const RunFolder& run = content.run;
  const std::vector<double> stamps = stampsOf (run, budget.frames);
  const Eigen::Vector3d up = upOf (run), target = targetOf (run);
  Json json;
  json["up"] = toJson (up);
  json["target"] = toJson (target);
  json["eye"] = toJson (eyeOf (run, target, up));
  json["is_frame"] = std::all_of (stamps.begin (), stamps.end (), [] (double stamp) { return (stamp == std::floor (stamp) && stamp < 1e7); });
  json["stamps"] = stamps;
  json["camera"] = run.camera.empty () ? Json () : posesAt (run.camera, stamps);
  if (run.intrinsics)
    json["intrinsics"] = {{"fx", run.intrinsics->fx}, {"fy", run.intrinsics->fy}, {"cx", run.intrinsics->cx},
                          {"cy", run.intrinsics->cy}, {"width", run.intrinsics->width}, {"height", run.intrinsics->height}};
  json["error_max_mm"] = content.truth ? Json (1000.0 * content.truth->error_max_m) : Json ();
  json["background"] = run.background.empty () ? Json () : embedMesh (forDisplay (run.background, budget.background_triangles));
  json["objects"] = Json::array ();
  const std::size_t most = std::min (budget.object_triangles, budget.all_triangles / std::max<std::size_t> (1, run.objects.size ()));
  for (std::size_t n = 0; n < run.objects.size (); ++n)
  {
    const RunObject& object = run.objects[n];
    if (object.completed.empty () && object.seen.empty ())
      continue;
    json["objects"].push_back ({{"id", object.id},
                                {"name", nameOf (object, content)},
                                {"colour", colourOf (n)},
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
