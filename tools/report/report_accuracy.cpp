// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "report_accuracy.h"

#include "report_tables.h"
#include "text_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

using namespace pcl::cosection;

namespace
{

constexpr double degrees = 180.0 / M_PI;

std::string
signedPercent (double share)
{
  return ((share >= 0.0 ? "+" : "") + inPercent (share));
}

std::string
rpeText (const TrajectoryError& error, bool is_rotation)
{
  if (error.rpe_pairs == 0)
    return (dash);
  return (is_rotation ? toText (degrees * error.rpe_rot_rad.rmse) : inMillimetres (error.rpe_trans_m.rmse));
}

/** \brief What a method gives for an object; not all may be known. */
struct Score
{
  double accuracy_m = 0.0, completeness_m = 0.0, f_score = 0.0;

  explicit Score (const MeshComparison& comparison)
      : accuracy_m (comparison.accuracy.mean)
      , completeness_m (comparison.completeness.mean)
      , f_score (comparison.f_score)
  {}
};

/** \brief A row of the comparison: a method and its scores, in the order of the objects. */
struct MethodScores
{
  std::string name, remark;
  std::vector<std::optional<Score>> scores;
};

/** \brief The best of each number in a column, as it is printed. */
struct BestScore
{
  std::string accuracy, completeness, f_score;
};

std::string
scoreMarkup (const Score& score, const BestScore& best)
{
  const auto marked = [] (const std::string& text, const std::string& winner) {
    return (text == winner ? "<b>" + text + "</b>" : text);
  };
  return (marked (inMillimetres (score.accuracy_m), best.accuracy) + " / " +
          marked (inMillimetres (score.completeness_m), best.completeness) + " / " +
          marked (toText (score.f_score), best.f_score));
}

BestScore
bestOf (const std::vector<MethodScores>& methods, std::size_t column)
{
  constexpr double none = std::numeric_limits<double>::infinity ();
  double accuracy_m = none, completeness_m = none, f_score = -none;
  for (const MethodScores& method : methods)
    if (const std::optional<Score>& score = method.scores[column])
    {
      accuracy_m = std::min (accuracy_m, score->accuracy_m);
      completeness_m = std::min (completeness_m, score->completeness_m);
      f_score = std::max (f_score, score->f_score);
    }
  if (accuracy_m == none)
    return {};
  return {inMillimetres (accuracy_m), inMillimetres (completeness_m), toText (f_score)};
}

/** \brief The mean over all objects, in one more column, where all are known. */
void
addMean (MethodScores& method)
{
  Score mean{MeshComparison ()};
  const double count = static_cast<double> (method.scores.size ());
  bool all = !method.scores.empty ();
  for (const std::optional<Score>& score : method.scores)
  {
    all = all && score.has_value ();
    if (!score)
      continue;
    mean.accuracy_m += score->accuracy_m / count;
    mean.completeness_m += score->completeness_m / count;
    mean.f_score += score->f_score / count;
  }
  method.scores.push_back (all ? std::optional<Score> (mean) : std::nullopt);
}

std::string
constraintsOf (const RunFolder& run)
{
  const Json& parameters = member (run.summary, "parameters");
  const std::string preset = textIn (parameters, "preset"), constraints = textIn (parameters, "constraints");
  return ((constraints.empty () ? "" : "constraints: " + constraints) +
          (preset.empty () || preset == "default" ? "" : ", preset " + preset));
}

/** \brief Scores of another run for the true objects of this one's. */
MethodScores
scoresOf (const ComparedRun& other, const std::vector<const ObjectEvaluation*>& objects)
{
  MethodScores method{other.name, constraintsOf (other.run), {}};
  for (const ObjectEvaluation* object : objects)
  {
    std::optional<Score> score;
    if (other.evaluation)
      for (const ObjectEvaluation& candidate : other.evaluation->objects)
        if (candidate.truth_id == object->truth_id)
          score = Score (candidate.mesh.comparison);
    method.scores.push_back (score);
  }
  return (method);
}

void
compareErrors (HtmlWriter& html, const ReportContent& content, const std::vector<const ObjectEvaluation*>& objects)
{
  std::vector<MethodScores> methods{{"this run", constraintsOf (content.run), {}},
                                    {"seen only", "TSDF of all frames, open", {}}};
  std::vector<std::string> header{"Accuracy / completeness (mm) / F"};
  for (const ObjectEvaluation* object : objects)
  {
    header.push_back (object->truth_name);
    methods[0].scores.emplace_back (Score (object->mesh.comparison));
    const auto seen = content.truth->seen.find (object->id);
    methods[1].scores.push_back (seen == content.truth->seen.end () ? std::nullopt
                                                                    : std::optional<Score> (Score (seen->second)));
  }
  for (const ComparedRun& other : content.others)
    methods.push_back (scoresOf (other, objects));
  if (objects.size () > 1)
  {
    header.emplace_back ("Mean");
    for (MethodScores& method : methods)
      addMean (method);
  }
  HtmlTable table (
      html, "Comparison with what was seen" + std::string (content.others.empty () ? "" : " and with other runs"),
      header, "scroll");
  for (const MethodScores& method : methods)
  {
    std::vector<TableCell> cells{
        {method.name, method.remark.empty () ? "" : "<small>" + escapeHtml (method.remark) + "</small>"}};
    for (std::size_t n = 0; n < method.scores.size (); ++n)
      cells.push_back (method.scores[n] ? TableCell{"", scoreMarkup (*method.scores[n], bestOf (methods, n))}
                                        : TableCell{dash});
    table.row (cells);
  }
  table.end ();
  html.element (
      "p", "The best of each number is bold. What was seen alone is accurate and not complete: it has no hidden sides.",
      {{"class", "note"}});
}

/** \brief Without truth: what each run says of itself. */
void
compareSummaries (HtmlWriter& html, const ReportContent& content)
{
  std::vector<std::string> header{"Volume (ml) / inside others (mm)"};
  for (const RunObject& object : content.run.objects)
    header.push_back (nameOf (object, content));
  HtmlTable table (html, "Comparison with other runs", header, "scroll");
  const auto row = [&] (const std::string& name, const RunFolder& run) {
    std::vector<TableCell> cells{{name, "<small>" + escapeHtml (constraintsOf (run)) + "</small>"}};
    for (const RunObject& object : content.run.objects)
    {
      const auto same = std::find_if (run.objects.begin (), run.objects.end (),
                                      [&] (const RunObject& o) { return (o.id == object.id); });
      const ObjectFacts facts = same == run.objects.end () ? factsOf (RunObject ()) : factsOf (*same);
      cells.push_back ({facts.volume_ml + " / " + facts.penetration_mm});
    }
    table.row (cells);
  };
  row ("this run", content.run);
  for (const ComparedRun& other : content.others)
    row (other.name, other.run);
  table.end ();
}

} // namespace

void
writeAccuracy (HtmlWriter& html, const ReportContent& content)
{
  const RunEvaluation& run = content.truth->evaluation;
  html.element ("p", "Camera: ATE " + inMillimetres (run.camera.ate_m.rmse) + " mm, RPE " +
                         rpeText (run.camera, false) + " mm and " + rpeText (run.camera, true) + "\xC2\xB0, " +
                         std::to_string (run.camera.matched) + " of " + counted (run.camera.truth_poses, "pose") + '.');
  HtmlTable table (html, "Accuracy",
                   {"Object", "Accuracy (mm)", "Completeness (mm)", "F at 10 mm", "Volume", "Inside others (mm)",
                    "ATE (mm)", "RPE (mm)", "RPE (\xC2\xB0)", "Tracked / visible"});
  for (const ObjectEvaluation& o : run.objects)
    table.row ({{o.truth_name},
                {inMillimetres (o.mesh.comparison.accuracy.mean)},
                {inMillimetres (o.mesh.comparison.completeness.mean)},
                {toText (o.mesh.comparison.f_score)},
                {o.mesh.volume_error ? signedPercent (*o.mesh.volume_error) : dash},
                {inMillimetres (o.penetration_m)},
                {inMillimetres (o.trajectory.ate_m.rmse)},
                {rpeText (o.trajectory, false)},
                {rpeText (o.trajectory, true)},
                {std::to_string (o.frames_tracked_visible) + " / " + std::to_string (o.frames_visible)}});
  if (run.background)
    table.row ({{"background"},
                {inMillimetres (run.background->comparison.accuracy.mean)},
                {inMillimetres (run.background->comparison.completeness.mean)},
                {toText (run.background->comparison.f_score)},
                {dash},
                {dash},
                {dash},
                {dash},
                {dash},
                {dash}});
  table.end ();
  html.element (
      "p",
      "Accuracy: mean distance from the completed mesh to the true one; completeness: from the true one to it; F: "
      "F-score at 10 mm. ATE and RPE: root mean squares of the absolute and the relative error of the trajectory, of "
      "objects in the camera's frame. "
      "Volume: the error of it.",
      {{"class", "note"}});
  for (const int id : run.unmatched)
    html.element ("p", "Object " + std::to_string (id) + " is none of the true objects.", {{"class", "note"}});
  for (const int id : run.missed)
    for (const SceneRecord::Object& object : content.truth->truth.objects)
      if (object.id == id)
        html.element ("p", "The true object " + object.name + " was not found.", {{"class", "note"}});
}

bool
writeComparison (HtmlWriter& html, const ReportContent& content)
{
  if (content.truth)
  {
    std::vector<const ObjectEvaluation*> objects;
    for (const ObjectEvaluation& object : content.truth->evaluation.objects)
      objects.push_back (&object);
    if (objects.empty () || (content.truth->seen.empty () && content.others.empty ()))
      return (false);
    compareErrors (html, content, objects);
    return (true);
  }
  if (content.others.empty () || content.run.objects.empty ())
    return (false);
  compareSummaries (html, content);
  return (true);
}
