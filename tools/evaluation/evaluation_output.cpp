// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "evaluation_output.h"

#include <algorithm>
#include <cstdio>

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

/** \brief Null if there are no errors, rather than zero. */
void
addErrors (const std::string& name, const std::string& unit, const ErrorStatistics& statistics, double factor,
           bool are_known, Json& json)
{
  for (const auto& [kind, value] : {std::pair ("_rmse_", statistics.rmse), std::pair ("_mean_", statistics.mean),
                                    std::pair ("_median_", statistics.median), std::pair ("_max_", statistics.max)})
    json[name + kind + unit] = are_known ? Json (factor * value) : Json ();
}

std::string
formatted (const char* format, double value)
{
  char text[32];
  std::snprintf (text, sizeof (text), format, value);
  return (text);
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
  json["volume_m3"] = orNull (summary.volume_m3);
  if (summary.point_spacing_m)
    json["point_spacing_m"] = *summary.point_spacing_m;
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
  addErrors ("ate", "m", error.ate_m, 1.0, true, json);
  addErrors ("rpe_trans", "m", error.rpe_trans_m, 1.0, error.rpe_pairs > 0, json);
  addErrors ("rpe_rot", "deg", error.rpe_rot_rad, degrees_per_rad, error.rpe_pairs > 0, json);
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
          counted (topology.components, "part"));
}

void
TextTable::print (Terminal& terminal) const
{
  std::vector<std::size_t> widths;
  for (const auto& row : rows_)
    for (std::size_t n = 0; n < row.size (); ++n)
    {
      widths.resize (std::max (widths.size (), n + 1), 0);
      widths[n] = std::max (widths[n], row[n].size ());
    }
  for (const auto& row : rows_)
  {
    std::string line;
    for (std::size_t n = 0; n < row.size (); ++n)
    {
      const std::string space (widths[n] - row[n].size (), ' ');
      line += n == 0 ? row[n] + space : "  " + space + row[n];
    }
    line.erase (line.find_last_not_of (' ') + 1);
    terminal.result (line);
  }
}

std::string
toText (double value, int digits)
{
  const double magnitude = std::abs (value) > 0.0 ? std::floor (std::log10 (std::abs (value))) : 0.0;
  const int decimals = std::clamp (digits - 1 - static_cast<int> (magnitude), 0, digits);
  char text[64];
  std::snprintf (text, sizeof (text), std::abs (value) < 1e9 ? "%.*f" : "%.*g", decimals, value);
  return (text);
}

std::string
inMillimetres (double metres)
{
  return (toText (1000.0 * metres));
}

std::string
inMillilitres (double cubic_metres)
{
  return (toText (1e6 * cubic_metres));
}

std::string
inPercent (double share)
{
  return (formatted ("%.1f %%", 100.0 * share));
}

std::string
toShortText (double value)
{
  return (formatted ("%.14g", value));
}

std::string
toField (const std::optional<double>& value)
{
  return (value ? formatted ("%.9g", *value) : "");
}
