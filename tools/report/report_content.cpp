// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "report_content.h"

#include "embedding.h"

#include "pcl_cosection/volume/mesh_distance/mesh_surface.h"
#include <pcl/cosection/visualization/scene_picture.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include <filesystem>

using namespace pcl::cosection;

namespace {

constexpr double stamp_tolerance = 1e-6;

/** \brief An object whose true surface is known; else null. */
const SceneRecord::Object*
trueObject (const SceneRecord& truth, int id)
{
  const SceneRecord::Object* object = withId (truth.objects, id);
  return (object == nullptr || object->mesh.empty () ? nullptr : object);
}

} // namespace

std::string
nameOf (const RunObject& object, const ReportContent& content)
{
  if (content.truth)
    if (const ObjectEvaluation* evaluation = withId (content.truth->evaluation.objects, object.id))
      return (evaluation->truth_name);
  const std::string name = textIn (object.summary, "class");
  const bool is_number = name.find_first_not_of ("0123456789") == std::string::npos; // of a class without a name
  return ((is_number ? "object" : name) + " " + std::to_string (object.id));
}

Eigen::Vector3d
upOf (const ReportContent& content)
{
  return (content.run.camera.empty () ? Eigen::Vector3d (Eigen::Vector3d::UnitZ ()) : upDirection (content.scene));
}

std::string
lastPartOf (const std::string& path)
{
  std::filesystem::path part = std::filesystem::path (path).lexically_normal ();
  if (!part.has_filename ())
    part = part.parent_path ();
  if (part.filename () == "." || part.filename () == "..")
  {
    std::error_code failure;
    part = std::filesystem::weakly_canonical (part, failure);
  }
  return (part.filename ().empty () ? path : part.filename ().string ());
}

std::string
titleOf (const ReportContent& content)
{
  const std::string dataset = textIn (member (content.run.summary, "parameters"), "dataset");
  return (lastPartOf (dataset.empty () ? content.run.path : dataset));
}

RunTruth
compareWithTruth (const RunScene& run, const std::string& dataset, int threads)
{
  RunTruth result;
  ReadingNotes notes;
  result.truth = run.of_views ? readTruthOfViews (dataset, run.run.camera, notes) : readTruth (dataset, notes);
  RunOptions options;
  options.threads = threads;
  options.comparison.threads = threads;
  result.evaluation = evaluateRun (result.truth, run.run, options);
  result.notes = notes.warnings;
  result.notes.insert (result.notes.end (), result.evaluation.warnings.begin (), result.evaluation.warnings.end ());
  for (const ObjectEvaluation& object : result.evaluation.objects)
  {
    const SceneRecord::Object* true_object = trueObject (result.truth, object.truth_id);
    const TriangleMesh& seen = run.surface (object.id, SurfaceMode::Tsdf);
    if (true_object != nullptr && !seen.empty ())
      result.seen[object.id] = compareMeshes (
          true_object->mesh, transformMesh (seen, object.mesh.alignment.T_truth_estimate), options.comparison);
  }
  return (result);
}

std::vector<double>
errorsOf (const RunTruth& truth, int id, const TriangleMesh& mesh, int threads)
{
  const ObjectEvaluation* evaluation = withId (truth.evaluation.objects, id);
  const SceneRecord::Object* true_object = evaluation == nullptr ? nullptr
                                                                 : trueObject (truth.truth, evaluation->truth_id);
  if (true_object == nullptr)
    return {};
  return (vertexDistances (transformMesh (mesh, evaluation->mesh.alignment.T_truth_estimate),
                           SurfaceDistance (true_object->mesh), threads));
}

const Eigen::Isometry3d*
poseAt (const std::vector<StampedPose>& poses, double stamp)
{
  const auto found = std::lower_bound (poses.begin (), poses.end (), stamp - stamp_tolerance,
                                       [] (const StampedPose& pose, double value) { return (pose.stamp < value); });
  return (found == poses.end () || found->stamp > stamp + stamp_tolerance ? nullptr : &found->pose);
}

Eigen::Vector3d
middleOf (const RunObject& object)
{
  const Eigen::AlignedBox3d box = vertexBox (object.completed.empty () ? object.seen : object.completed);
  return (box.isEmpty () ? Eigen::Vector3d (Eigen::Vector3d::Zero ()) : Eigen::Vector3d (box.center ()));
}

Eigen::Vector3d
standingSize (const TriangleMesh& mesh, const Eigen::Vector3d& up)
{
  if (mesh.vertices.empty ())
    return (Eigen::Vector3d::Zero ());
  const Eigen::Vector3d x = up.unitOrthogonal (), y = up.cross (x);
  std::vector<cv::Point2f> horizontal;
  Eigen::AlignedBox1d heights;
  for (const Eigen::Vector3f& vertex : mesh.vertices)
  {
    const Eigen::Vector3d v = vertex.cast<double> ();
    horizontal.emplace_back (static_cast<float> (v.dot (x)), static_cast<float> (v.dot (y)));
    heights.extend (Eigen::AlignedBox1d::VectorType (v.dot (up)));
  }
  const cv::Size2f area = cv::minAreaRect (horizontal).size;
  return {std::max (area.width, area.height), std::min (area.width, area.height), heights.sizes ()[0]};
}

ObjectDirections
directionsOf (const RunObject& object, const RunFolder& run, const Eigen::Vector3d& up)
{
  ObjectDirections directions;
  const Eigen::Vector3d middle = middleOf (object);
  Eigen::Vector3d mean_up = Eigen::Vector3d::Zero (), front = Eigen::Vector3d::Zero ();
  for (const StampedPose& pose : object.poses)
    if (const Eigen::Isometry3d* camera = poseAt (run.camera, pose.stamp))
    {
      const Eigen::Isometry3d T_object_world = pose.pose.inverse ();
      mean_up += T_object_world.linear () * up;
      front += (T_object_world * camera->translation () - middle).normalized ();
    }
  if (mean_up.norm () > 1e-6)
    directions.up = mean_up.normalized ();
  if (front.norm () > 1e-6)
    directions.front = front.normalized ();
  if (directions.up.cross (directions.front).norm () < 0.1) // straight from above: from a side that is one
    directions.front = (directions.up + directions.up.unitOrthogonal ()).normalized ();
  return (directions);
}
