// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "report_plots.h"
#include "scene_directions.h"
#include "svg_chart.h"

#include <pcl/cosection/evaluation/trajectory_error.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace pcl::cosection;

namespace
{

constexpr double gap_periods = 1.5;     ///< a longer time between poses interrupts the line
constexpr double least_height_m = 0.02; ///< of a chart over time: noise is not motion
constexpr std::size_t most_open = 6;    ///< charts over time; more are folded away

/** \brief Where something was, in the frame of the charts: x and y level, z up. */
struct Path
{
  std::string name, style;
  std::vector<double> stamps;
  std::vector<Eigen::Vector3d> places;
  std::vector<double> true_stamps;
  std::vector<Eigen::Vector3d> true_places;
};

/** \brief From the world to axes of which the third is up; the world itself if that is up. */
Eigen::Matrix3d
levelled (const Eigen::Vector3d& up)
{
  return (Eigen::Quaterniond::FromTwoVectors (up, Eigen::Vector3d::UnitZ ()).toRotationMatrix ());
}

/** \brief Points of a line, interrupted where poses are missing. */
std::vector<Eigen::Vector2d>
lineOf (const std::vector<double>& stamps, const std::vector<Eigen::Vector3d>& places, double period,
        Eigen::Vector2d (*point) (double, const Eigen::Vector3d&, int), int axis)
{
  std::vector<Eigen::Vector2d> points;
  for (std::size_t n = 0; n < places.size (); ++n)
  {
    if (n > 0 && stamps[n] - stamps[n - 1] > gap_periods * period)
      points.push_back (Eigen::Vector2d::Constant (std::numeric_limits<double>::quiet_NaN ()));
    points.push_back (point (stamps[n], places[n], axis));
  }
  return (points);
}

Eigen::Vector2d
fromAbove (double, const Eigen::Vector3d& place, int)
{
  return (place.head<2> ());
}

Eigen::Vector2d
overTime (double stamp, const Eigen::Vector3d& place, int axis)
{
  return {stamp, place[axis]};
}

void
add (const std::vector<StampedPose>& poses, const Eigen::Isometry3d& T_chart_world, const Eigen::Vector3d& middle,
     std::vector<double>& stamps, std::vector<Eigen::Vector3d>& places)
{
  for (const StampedPose& pose : poses)
  {
    stamps.push_back (pose.stamp);
    places.emplace_back (T_chart_world * (pose.pose * middle));
  }
}

std::vector<Path>
pathsOf (const ReportContent& content)
{
  const RunFolder& run = content.run;
  Eigen::Isometry3d T_chart_world = Eigen::Isometry3d::Identity ();
  T_chart_world.linear () = levelled (upOf (content));
  Eigen::Isometry3d T_chart_truth = T_chart_world;
  if (content.truth)
    T_chart_truth = T_chart_world * content.truth->evaluation.camera.T_truth_estimate.inverse ();
  std::vector<Path> paths;
  if (!run.camera.empty ())
  {
    Path camera{"camera", "s0", {}, {}, {}, {}};
    add (run.camera, T_chart_world, Eigen::Vector3d::Zero (), camera.stamps, camera.places);
    if (content.truth)
      add (content.truth->truth.camera, T_chart_truth, Eigen::Vector3d::Zero (), camera.true_stamps,
           camera.true_places);
    paths.push_back (camera);
  }
  for (const RunObject& object : run.objects)
  {
    if (object.poses.empty ())
      continue;
    const Eigen::Vector3d middle = middleOf (object.completed.empty () ? object.seen : object.completed);
    Path path{nameOf (object, content), styleOf (object.id), {}, {}, {}, {}};
    add (object.poses, T_chart_world, middle, path.stamps, path.places);
    if (content.truth)
      if (const ObjectEvaluation* evaluation = evaluationOf (content.truth->evaluation, object.id))
        for (const SceneRecord::Object& true_object : content.truth->truth.objects)
          if (true_object.id == evaluation->truth_id)
            add (true_object.poses, T_chart_truth, evaluation->mesh.alignment.T_truth_estimate * middle,
                 path.true_stamps, path.true_places);
    paths.push_back (path);
  }
  return (paths);
}

bool
areFrames (const std::vector<Path>& paths)
{
  constexpr double largest_number = 1e7; // larger ones are times
  return (std::all_of (paths.begin (), paths.end (), [] (const Path& path) {
    return (std::all_of (path.stamps.begin (), path.stamps.end (),
                         [] (double stamp) { return (stamp == std::floor (stamp) && stamp < largest_number); }));
  }));
}

/** \brief Times count from the first pose of all. */
void
beginAtZero (std::vector<Path>& paths)
{
  double begin = std::numeric_limits<double>::infinity ();
  for (const Path& path : paths)
    begin = std::min (begin, path.stamps.front ());
  for (Path& path : paths)
    for (std::vector<double>* stamps : {&path.stamps, &path.true_stamps})
      for (double& stamp : *stamps)
        stamp -= begin;
}

/** \brief The truth only as long as the run: charts are about that. */
void
cropTruth (std::vector<Path>& paths)
{
  double begin = std::numeric_limits<double>::infinity (), end = -begin;
  for (const Path& path : paths)
  {
    begin = std::min (begin, path.stamps.front ());
    end = std::max (end, path.stamps.back ());
  }
  for (Path& path : paths)
  {
    Path kept = path;
    kept.true_stamps.clear ();
    kept.true_places.clear ();
    for (std::size_t n = 0; n < path.true_stamps.size (); ++n)
      if (path.true_stamps[n] >= begin && path.true_stamps[n] <= end)
      {
        kept.true_stamps.push_back (path.true_stamps[n]);
        kept.true_places.push_back (path.true_places[n]);
      }
    path = kept;
  }
}

double
periodOf (const std::vector<StampedPose>& poses)
{
  return (medianPeriod (poses).value_or (1.0));
}

void
writeChart (HtmlWriter& html, const LineChart& chart)
{
  html.open ("figure").element ("figcaption", chart.title).markup (drawLineChart (chart)).close ("figure");
}

void
writeKey (HtmlWriter& html, const std::string& style, const std::string& name)
{
  html.open ("li").markup ("<i class=\"key " + style + "\"></i>").text (name).close ("li");
}

} // namespace

bool
writeTrajectories (HtmlWriter& html, const ReportContent& content)
{
  std::vector<Path> paths = pathsOf (content);
  if (paths.empty ())
    return (false);
  cropTruth (paths);
  const bool frames = areFrames (paths);
  if (!frames)
    beginAtZero (paths);
  const double period = periodOf (content.run.camera.empty () ? content.run.objects.front ().poses
                                                              : content.run.camera);
  const std::string time = frames ? "frame" : "time (s)";

  html.open ("ul", {{"class", "legend"}});
  for (const Path& path : paths)
    writeKey (html, path.style, path.name);
  if (content.truth)
    html.open ("li").markup ("<i class=\"key truth\"></i>").text ("truth").close ("li");
  html.close ("ul").open ("ul", {{"class", "legend"}}).element ("li", "Over time:");
  static const char* const axes[] = {"x", "y", "z (up)"};
  static const char* const axis_styles[] = {"ax", "ay", "az"};
  for (int axis = 0; axis < 3; ++axis)
    writeKey (html, axis_styles[axis], axes[axis]);
  html.close ("ul").open ("div", {{"class", "charts"}});

  LineChart above{"From above", "x (m)", "y (m)", {}, true, 480};
  for (const Path& path : paths)
  {
    above.series.push_back ({path.style, lineOf (path.stamps, path.places, period, fromAbove, 0), false, true});
    if (content.truth)
      above.series.push_back (
          {"truth", lineOf (path.true_stamps, path.true_places, period, fromAbove, 0), true, false});
  }
  writeChart (html, above);
  for (std::size_t n = 0; n < paths.size (); ++n)
  {
    const Path& path = paths[n];
    if (n == most_open)
      html.close ("div")
          .open ("details")
          .element ("summary", "Charts of " + counted (paths.size () - most_open, "more object"))
          .open ("div", {{"class", "charts"}});
    LineChart chart{path.name + ": moved since the beginning", time, "moved (m)", {}, false, 220, least_height_m};
    for (int axis = 0; axis < 3; ++axis)
    {
      const auto since = [&] (std::vector<Eigen::Vector3d> places) {
        for (Eigen::Vector3d& place : places)
          place -= path.places.front ();
        return (places);
      };
      if (!path.true_places.empty ())
        chart.series.push_back (
            {"truth", lineOf (path.true_stamps, since (path.true_places), period, overTime, axis), true, false});
      chart.series.push_back (
          {axis_styles[axis], lineOf (path.stamps, since (path.places), period, overTime, axis), false, false});
    }
    writeChart (html, chart);
  }
  html.close ("div");
  if (paths.size () > most_open)
    html.close ("details");
  html.element (
      "p",
      "Rings are beginnings, dots are ends; where nothing was tracked the line is interrupted. Of objects, the middle "
      "of the mesh is shown.",
      {{"class", "note"}});
  return (true);
}
