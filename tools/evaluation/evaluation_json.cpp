// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "evaluation_json.h"

using namespace pcl::cosection;

namespace {

/** \brief NAME_m is the mean. */
void
addDistances (const std::string& name, const ErrorStatistics& statistics, Json& json)
{
  json[name + "_m"] = statistics.mean;
  json[name + "_median_m"] = statistics.median;
  json[name + "_p95_m"] = statistics.p95;
  json[name + "_max_m"] = statistics.max;
}

void
addErrors (const std::string& name, const std::string& unit, const ErrorStatistics& statistics, double factor,
           Json& json)
{
  json[name + "_rmse_" + unit] = factor * statistics.rmse;
  json[name + "_mean_" + unit] = factor * statistics.mean;
  json[name + "_median_" + unit] = factor * statistics.median;
  json[name + "_max_" + unit] = factor * statistics.max;
}

} // namespace

Json
toJson (const Eigen::Isometry3d& pose)
{
  const Eigen::Quaterniond q (pose.linear ());
  const Eigen::Vector3d t = pose.translation ();
  return (Json::array ({t.x (), t.y (), t.z (), q.x (), q.y (), q.z (), q.w ()}));
}

Json
toJson (const MeshSummary& summary)
{
  Json json;
  json["vertices"] = summary.vertices;
  json["triangles"] = summary.triangles;
  json["closed"] = summary.topology.closed_manifold;
  json["boundary_edges"] = summary.topology.boundary_edges;
  json["non_manifold_edges"] = summary.topology.non_manifold_edges;
  json["non_manifold_vertices"] = summary.topology.non_manifold_vertices;
  json["euler"] = summary.topology.euler;
  json["parts"] = summary.topology.components;
  json["area_m2"] = summary.area_m2;
  json["volume_m3"] = summary.volume_m3 ? Json (*summary.volume_m3) : Json ();
  return (json);
}

void
addComparison (const MeshComparison& comparison, double f_threshold_m, Json& json)
{
  addDistances ("accuracy", comparison.accuracy, json);
  addDistances ("completeness", comparison.completeness, json);
  json["f_score"] = comparison.f_score;
  json["precision"] = comparison.precision;
  json["recall"] = comparison.recall;
  json["f_threshold_m"] = f_threshold_m;
}

void
addTrajectoryError (const TrajectoryError& error, Json& json)
{
  addErrors ("ate", "m", error.ate_m, 1.0, json);
  addErrors ("rpe_trans", "m", error.rpe_trans_m, 1.0, json);
  addErrors ("rpe_rot", "deg", error.rpe_rot_rad, degrees_per_rad, json);
  if (error.rpe_pairs == 0) // not an error of zero
    for (const char* name : {"rpe_trans_rmse_m", "rpe_trans_mean_m", "rpe_trans_median_m", "rpe_trans_max_m",
                             "rpe_rot_rmse_deg", "rpe_rot_mean_deg", "rpe_rot_median_deg", "rpe_rot_max_deg"})
      json[name] = nullptr;
  json["rpe_pairs"] = error.rpe_pairs;
  json["rpe_left_out"] = error.rpe_left_out;
  json["matched"] = error.matched;
  json["truth_poses"] = error.truth_poses;
  json["estimate_poses"] = error.estimate_poses;
  json["truth_span_s"] = {error.truth_begin_s, error.truth_end_s};
  json["estimate_span_s"] = {error.estimate_begin_s, error.estimate_end_s};
  json["largest_gap_s"] = error.largest_gap_s;
  json["path_m"] = error.path_m;
  json["max_difference_s"] = error.max_difference_s;
  json["T_truth_estimate"] = toJson (error.T_truth_estimate);
  json["notes"] = error.notes;
}

std::string
describeTopology (const MeshTopology& topology)
{
  std::string text = topology.closed_manifold ? "closed" : topology.boundary_edges > 0 ? "open" : "not a manifold";
  if (topology.boundary_edges > 0)
    text += ", " + std::to_string (topology.boundary_edges) + " boundary edges";
  if (topology.non_manifold_edges > 0)
    text += ", " + std::to_string (topology.non_manifold_edges) + " non-manifold edges";
  if (topology.non_manifold_edges == 0 && topology.non_manifold_vertices > 0)
    text += ", " + std::to_string (topology.non_manifold_vertices) + " non-manifold vertices";
  return (text + ", Euler characteristic " + std::to_string (topology.euler) + ", " +
          std::to_string (topology.components) + (topology.components == 1 ? " part" : " parts"));
}
