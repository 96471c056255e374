// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "report_data.h"

#include "embedded_page.h"
#include "report_pictures.h"
#include "scene_data.h"

#include <pcl/cosection/evaluation/mesh_comparison.h>
#include <pcl/cosection/evaluation/trajectory_error.h>
#include <pcl/cosection/version.h>

#include <array>

using namespace pcl::cosection;

namespace {

constexpr std::array<const char*, 4> provenance_keys = {"observed", "inferred", "hull", "intersection"};

template <typename Value>
Json
orNull (const std::optional<Value>& value)
{
  return (value ? Json (*value) : Json ());
}

void
report (const ProgressCallback& progress, const std::string& stage, double fraction)
{
  if (progress && !progress (stage, fraction))
    throw Cancelled ("the report was cancelled");
}

/** \brief "constraints: all, preset sharp" */
std::string
constraintsOf (const RunFolder& run)
{
  const Json& parameters = member (run.summary, "parameters");
  const std::string preset = textIn (parameters, "preset"), constraints = textIn (parameters, "constraints");
  return ((constraints.empty () ? "" : "constraints: " + constraints) +
          (preset.empty () || preset == "default" ? "" : ", preset " + preset));
}

/** \brief How the poses and the objects came to be known. */
std::string
methodOf (const RunFolder& run)
{
  const Json& parameters = member (run.summary, "parameters");
  if (!parameters.is_object ())
    return ("");
  const std::string masks = textIn (parameters, "masks"), segmentation = textIn (parameters, "segmentation");
  const std::string constraints = constraintsOf (run);
  std::string text = textIn (parameters, "camera_trajectory").empty () ? "" : "poses given, ";
  if (!run.of_views) // these have labels
    text += !segmentation.empty () ? "segmentation " + segmentation : masks.empty () ? "no masks" : "masks given";
  return (text + (text.empty () || constraints.empty () || constraints[0] == ',' ? "" : ", ") + constraints);
}

/** \brief A parameter in words. */
std::string
valueText (const Json& value)
{
  if (value.is_boolean ())
    return (value.get<bool> () ? "yes" : "no");
  if (value.empty () || (value.is_string () && value.get<std::string> ().empty ()))
    return ("\xE2\x80\x93"); // a dash
  return (value.is_string () ? value.get<std::string> () : value.dump (-1, ' ', false, Json::error_handler_t::replace));
}

Json
parametersOf (const RunFolder& run)
{
  Json list = Json::array ();
  const Json& parameters = member (run.summary, "parameters");
  if (parameters.is_object ())
    for (const auto& [key, value] : parameters.items ())
      list.push_back ({key, valueText (value)});
  return (list);
}

Json
failedObjects (const RunFolder& run)
{
  Json list = Json::array ();
  const Json& failed = member (run.summary, "failed");
  if (failed.is_array ())
    for (const Json& entry : failed)
      list.push_back ({{"id", numberIn (entry, "id").value_or (0.0)}, {"error", textIn (entry, "error")}});
  return (list);
}

/** \brief Shares of the surface by provenance, in its order; empty if they are not known. */
std::vector<double>
provenanceShares (const RunObject& object)
{
  std::vector<double> shares;
  for (const char* key : provenance_keys)
    if (const std::optional<double> share = numberIn (member (object.summary, "provenance"), key))
      shares.push_back (*share);
  if (shares.size () == provenance_keys.size ())
    return (shares);
  if (object.completed.provenance.empty ())
    return {};
  shares.assign (provenance_keys.size (), 0.0);
  for (const std::uint8_t kind : object.completed.provenance)
    if (kind < shares.size ())
      shares[kind] += 1.0 / static_cast<double> (object.completed.provenance.size ());
  return (shares);
}

/** \brief What an object is like: by summary.json, else by its mesh. */
Json
summaryOf (const RunObject& object)
{
  std::optional<double> volume_m3 = numberIn (object.summary, "volume_m3");
  std::optional<bool> closed = flagIn (object.summary, "closed");
  if (!object.completed.empty () && !closed)
  {
    const MeshSummary mesh = summarizeMesh (object.completed);
    closed = mesh.topology.closed_manifold;
    volume_m3 = mesh.volume_m3;
  }
  std::optional<double> frames = numberIn (object.summary, "frames_tracked");
  if (!frames && !object.poses.empty ())
    frames = static_cast<double> (object.poses.size ());
  const Json& solver = member (object.summary, "solver");
  return {{"volume_m3", orNull (volume_m3)},
          {"closed", orNull (closed)},
          {"penetration_m", orNull (numberIn (object.summary, "penetration_m"))},
          {"frames", orNull (frames)},
          {"iterations", orNull (numberIn (solver, "iterations"))},
          {"converged", flagIn (solver, "converged").value_or (true)}};
}

Json
objectData (const RunObject& object, const ReportContent& content)
{
  const std::string name = nameOf (object, content);
  const ObjectDirections directions = directionsOf (object, content.run, upOf (content));
  const auto errors = content.scene.errors.find (object.id);
  Json json = summaryOf (object);
  json["id"] = object.id;
  json["name"] = name;
  json["completed"] = !object.completed.empty ();
  json["is_known"] = !(object.summary.is_null () && object.completed.empty () && object.seen.empty ());
  json["provenance"] = provenanceShares (object);
  json["size_m"] = Json ();
  if (!object.completed.empty ())
  {
    const Eigen::Vector3d size_m = standingSize (object.completed, directions.up);
    json["size_m"] = {size_m.x (), size_m.y (), size_m.z ()};
  }
  json["pictures"] = drawObject (
      object, directions, errors == content.scene.errors.end () ? std::vector<double> () : errors->second.completed,
      content.scene.error_max_m, name);
  return (json);
}

Json
scoreOf (const MeshComparison& comparison)
{
  return {{"accuracy_m", comparison.accuracy.mean},
          {"completeness_m", comparison.completeness.mean},
          {"f_score", comparison.f_score}};
}

Json
errorOf (const TrajectoryError& error)
{
  const bool has_rpe = error.rpe_pairs > 0;
  return {{"ate_m", error.ate_m.rmse},
          {"rpe_m", has_rpe ? Json (error.rpe_trans_m.rmse) : Json ()},
          {"rpe_rad", has_rpe ? Json (error.rpe_rot_rad.rmse) : Json ()},
          {"matched", error.matched},
          {"poses", error.truth_poses}};
}

Json
accuracyData (const RunTruth& truth)
{
  const RunEvaluation& run = truth.evaluation;
  Json objects = Json::array (), missed = Json::array ();
  for (const ObjectEvaluation& object : run.objects)
    objects.push_back ({{"name", object.truth_name},
                        {"score", scoreOf (object.mesh.comparison)},
                        {"volume_error", orNull (object.mesh.volume_error)},
                        {"penetration_m", object.penetration_m},
                        {"trajectory", errorOf (object.trajectory)},
                        {"tracked", object.frames_tracked_visible},
                        {"visible", object.frames_visible}});
  for (const int id : run.missed)
    if (const SceneRecord::Object* object = withId (truth.truth.objects, id))
      missed.push_back (object->name);
  return {{"camera", errorOf (run.camera)},
          {"objects", objects},
          {"background", run.background ? scoreOf (run.background->comparison) : Json ()},
          {"unmatched", run.unmatched},
          {"missed", missed}};
}

/** \brief Scores of this run, of what was seen, and of other runs, for the true objects that this run has. */
Json
compareScores (const ReportContent& content)
{
  const std::vector<ObjectEvaluation>& objects = content.truth->evaluation.objects;
  if (objects.empty () || (content.truth->seen.empty () && content.others.empty ()))
    return (Json ());
  Json columns = Json::array (), scores = Json::array (), seen_scores = Json::array ();
  for (const ObjectEvaluation& object : objects)
  {
    columns.push_back (object.truth_name);
    scores.push_back (scoreOf (object.mesh.comparison));
    const auto seen = content.truth->seen.find (object.id);
    seen_scores.push_back (seen == content.truth->seen.end () ? Json () : scoreOf (seen->second));
  }
  Json methods = {{{"name", "this run"}, {"remark", constraintsOf (content.run)}, {"scores", scores}},
                  {{"name", "seen only"}, {"remark", "TSDF of all frames, open"}, {"scores", seen_scores}}};
  for (const ComparedRun& other : content.others)
  {
    Json other_scores = Json::array ();
    for (const ObjectEvaluation& object : objects)
    {
      other_scores.push_back (Json ());
      if (other.evaluation)
        for (const ObjectEvaluation& candidate : other.evaluation->objects)
          if (candidate.truth_id == object.truth_id)
            other_scores.back () = scoreOf (candidate.mesh.comparison);
    }
    methods.push_back ({{"name", other.name}, {"remark", constraintsOf (other.run)}, {"scores", other_scores}});
  }
  return {{"columns", columns}, {"methods", methods}};
}

/** \brief What this run and others say of themselves, for the objects of this run. */
Json
compareSummaries (const ReportContent& content)
{
  if (content.others.empty () || content.run.objects.empty ())
    return (Json ());
  Json columns = Json::array (), methods = Json::array ();
  for (const RunObject& object : content.run.objects)
    columns.push_back (nameOf (object, content));
  const auto add = [&] (const std::string& name, const RunFolder& run) {
    Json summaries = Json::array ();
    for (const RunObject& object : content.run.objects)
    {
      const RunObject* same = withId (run.objects, object.id);
      summaries.push_back (summaryOf (same == nullptr ? RunObject () : *same));
    }
    methods.push_back ({{"name", name}, {"remark", constraintsOf (run)}, {"summaries", summaries}});
  };
  add ("this run", content.run);
  for (const ComparedRun& other : content.others)
    add (other.name, other.run);
  return {{"columns", columns}, {"methods", methods}};
}

/** \brief Where a point goes that follows poses: stamps and places. */
Json
pathOf (const std::vector<StampedPose>& poses, const Eigen::Isometry3d& T_chart_world, const Eigen::Vector3d& point)
{
  Json path = Json::array ();
  for (const StampedPose& pose : poses)
  {
    const Eigen::Vector3d place = T_chart_world * (pose.pose * point);
    path.push_back ({pose.stamp, place.x (), place.y (), place.z ()});
  }
  return (path);
}

/** \brief Truth is brought into the world of the run. */
Json
trajectoriesOf (const ReportContent& content)
{
  const RunFolder& run = content.run;
  Eigen::Isometry3d T_chart_world = Eigen::Isometry3d::Identity ();
  T_chart_world.linear () = Eigen::Quaterniond::FromTwoVectors (upOf (content), Eigen::Vector3d::UnitZ ())
                                .toRotationMatrix ();
  Eigen::Isometry3d T_chart_truth = T_chart_world;
  if (content.truth)
    T_chart_truth = T_chart_world * content.truth->evaluation.camera.T_truth_estimate.inverse ();
  Json paths = Json::array ();
  if (!run.camera.empty ())
    paths.push_back (
        {{"name", "camera"},
         {"id", 0},
         {"poses", pathOf (run.camera, T_chart_world, Eigen::Vector3d::Zero ())},
         {"truth", content.truth ? pathOf (content.truth->truth.camera, T_chart_truth, Eigen::Vector3d::Zero ())
                                 : Json::array ()}});
  for (const RunObject& object : run.objects)
  {
    if (object.poses.empty ())
      continue;
    const Eigen::Vector3d middle = middleOf (object);
    Json truth = Json::array ();
    if (content.truth)
      if (const ObjectEvaluation* evaluation = withId (content.truth->evaluation.objects, object.id))
        if (const SceneRecord::Object* true_object = withId (content.truth->truth.objects, evaluation->truth_id))
          truth = pathOf (true_object->poses, T_chart_truth, evaluation->mesh.alignment.T_truth_estimate * middle);
    paths.push_back ({{"name", nameOf (object, content)},
                      {"id", object.id},
                      {"poses", pathOf (object.poses, T_chart_world, middle)},
                      {"truth", truth}});
  }
  const bool by_camera = !run.camera.empty () || run.objects.empty ();
  return {{"period", medianPeriod (by_camera ? run.camera : run.objects.front ().poses).value_or (1.0)},
          {"paths", paths}};
}

} // namespace

Json
reportData (const ReportContent& content, const ProgressCallback& progress)
{
  const RunFolder& run = content.run;
  std::vector<std::string> warnings = content.warnings;
  const std::vector<std::string> warnings_of_run = textsIn (run.summary, "warnings");
  warnings.insert (warnings.end (), warnings_of_run.begin (), warnings_of_run.end ());
  const Json& timings = member (run.summary, "timings_s");
  Json data = {{"version", PCL_COSECTION_VERSION},
               {"title", titleOf (content)},
               {"path", run.path},
               {"date", run.date},
               {"method", methodOf (run)},
               {"truth_folder", content.truth_folder},
               {"licence", std::string (three_library.text.empty () ? "" : three_notice.text)},
               {"failure", run.failure},
               {"has_summary", !run.summary.is_null ()},
               {"has_seen", !content.scene.tsdf.empty ()},
               {"failed", failedObjects (run)},
               {"warnings", warnings},
               {"events", textsIn (run.summary, "events")},
               {"frames", orNull (numberIn (run.summary, "frames"))},
               {"frames_per_second", orNull (numberIn (run.summary, "frames_per_second"))},
               {"timings_s", timings.is_object () ? timings : Json::object ()},
               {"parameters", parametersOf (run)},
               {"has_background", !run.background.empty ()},
               {"error_max_m", content.truth ? Json (content.scene.error_max_m) : Json ()}};
  report (progress, "drawing objects", 0.0);
  data["scene_pictures"] = run.objects.empty () ? Json::array () : drawScenePanels (content);
  data["objects"] = Json::array ();
  for (const RunObject& object : run.objects)
  {
    data["objects"].push_back (objectData (object, content));
    report (progress, "drawing objects",
            0.1 + 0.4 * static_cast<double> (data["objects"].size ()) / static_cast<double> (run.objects.size ()));
  }
  report (progress, "embedding meshes", 0.5);
  const bool has_meshes = !run.background.empty () || !run.objects.empty ();
  data["scene"] = has_meshes && !three_library.text.empty () ? sceneData (content) : Json ();
  report (progress, "writing tables", 0.95);
  data["accuracy"] = content.truth ? accuracyData (*content.truth) : Json ();
  data["comparison"] = content.truth ? compareScores (content) : compareSummaries (content);
  data["trajectories"] = trajectoriesOf (content);
  return (data);
}
