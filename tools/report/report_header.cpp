// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "report_header.h"

#include "report_tables.h"
#include "text_table.h"

#include <algorithm>

using namespace pcl::cosection;

namespace
{

/** \brief "3 objects and the background, from 100 frames in 34.2 s." */
std::string
sentence (const RunFolder& run)
{
  const std::size_t completed = static_cast<std::size_t> (std::count_if (
      run.objects.begin (), run.objects.end (), [] (const RunObject& object) { return (!object.completed.empty ()); }));
  std::string text = counted (completed, "completed object") + (run.background.empty () ? "" : " and the background");
  if (completed == 0)
    text = run.background.empty () ? "Nothing was completed" : "The background";
  const std::optional<double> frames = numberIn (run.summary, "frames"),
                              seconds = numberIn (member (run.summary, "timings_s"), "total");
  if (frames)
    text += " from " + counted (static_cast<std::size_t> (std::max (0.0, *frames)), "frame");
  if (seconds)
    text += " in " + toText (*seconds) + " s";
  return (text + '.');
}

/** \brief How the poses and the objects came to be known. */
std::string
method (const Json& parameters)
{
  if (!parameters.is_object ())
    return ("");
  const std::string masks = textIn (parameters, "masks"), segmentation = textIn (parameters, "segmentation");
  const std::string constraints = textIn (parameters, "constraints"), preset = textIn (parameters, "preset");
  std::string text = textIn (parameters, "camera_trajectory").empty () ? "" : "poses given, ";
  text += !segmentation.empty () ? "segmentation " + segmentation : masks.empty () ? "no masks" : "masks given";
  if (!constraints.empty ())
    text += ", constraints: " + constraints;
  return (text + (preset.empty () || preset == "default" ? "" : ", preset " + preset));
}

void
writeFact (HtmlWriter& html, const std::string& value, const std::string& unit, const std::string& name)
{
  html.open ("div").element ("dt", name).open ("dd").text (value);
  if (!unit.empty ())
    html.element ("small", unit);
  html.close ("dd").close ("div");
}

void
writeFacts (HtmlWriter& html, const ReportContent& content)
{
  const std::vector<RunObject>& objects = content.run.objects;
  html.open ("dl", {{"class", "facts"}});
  std::size_t completed = 0, closed = 0;
  double deepest_m = 0.0;
  bool knows_depth = false;
  for (const RunObject& object : objects)
  {
    if (object.completed.empty ())
      continue;
    ++completed;
    closed += factsOf (object).is_closed.value_or (false) ? 1 : 0;
    if (const std::optional<double> depth_m = numberIn (object.summary, "penetration_m"))
    {
      deepest_m = std::max (deepest_m, *depth_m);
      knows_depth = true;
    }
  }
  if (completed > 0)
    writeFact (html, std::to_string (closed) + " of " + std::to_string (completed), "", "closed");
  if (content.truth && !content.truth->evaluation.objects.empty ())
  {
    double accuracy_m = 0.0, completeness_m = 0.0;
    const double count = static_cast<double> (content.truth->evaluation.objects.size ());
    for (const ObjectEvaluation& object : content.truth->evaluation.objects)
    {
      accuracy_m += object.mesh.comparison.accuracy.mean / count;
      completeness_m += object.mesh.comparison.completeness.mean / count;
    }
    writeFact (html, inMillimetres (accuracy_m), "mm", "mean accuracy");
    writeFact (html, inMillimetres (completeness_m), "mm", "mean completeness");
  }
  if (content.truth)
    writeFact (html, inMillimetres (content.truth->evaluation.camera.ate_m.rmse), "mm", "camera ATE");
  if (knows_depth)
    writeFact (html, inMillimetres (deepest_m), "mm", "deepest overlap");
  if (const std::optional<double> rate = numberIn (content.run.summary, "frames_per_second"))
    writeFact (html, toText (*rate), "/s", "frames");
  html.close ("dl");
}

/** \brief What must not be overlooked. */
void
writeBanner (HtmlWriter& html, const ReportContent& content)
{
  const Json& failed = member (content.run.summary, "failed");
  const std::size_t warnings = content.warnings.size () + textsIn (content.run.summary, "warnings").size ();
  if (!content.run.failure.empty ())
    html.open ("p", {{"class", "banner failed"}, {"role", "alert"}})
        .element ("strong", "The run failed: ")
        .text (content.run.failure)
        .close ("p");
  else if (content.run.summary.is_null ())
    html.open ("p", {{"class", "banner failed"}, {"role", "alert"}})
        .element ("strong", "The run is incomplete: ")
        .text ("it has no summary; below is what it left.")
        .close ("p");
  if (failed.is_array () && !failed.empty ())
    html.element ("p", counted (failed.size (), "object") + " failed; see the table of objects.",
                  {{"class", "banner failed"}});
  if (warnings > 0)
    html.open ("p", {{"class", "banner"}})
        .element ("a", counted (warnings, "warning"), {{"href", "#warnings"}})
        .close ("p");
}

} // namespace

void
writeHeader (HtmlWriter& html, const ReportContent& content)
{
  const Json& parameters = member (content.run.summary, "parameters");
  html.open ("header").element ("p", "pcl_cosection report", {{"class", "kicker"}}).element ("h1", titleOf (content));
  html.element ("p", sentence (content.run), {{"class", "lead"}});
  html.open ("p", {{"class", "note"}});
  const std::string how = method (parameters);
  html.text (how).text (how.empty () || content.run.date.empty () ? "" : " \xC2\xB7 ").text (content.run.date);
  html.text (how.empty () && content.run.date.empty () ? "" : " \xC2\xB7 ")
      .text ("run ")
      .element ("code", content.run.path);
  if (!content.truth_folder.empty ())
    html.text (" \xC2\xB7 truth ").element ("code", content.truth_folder);
  html.close ("p");
  writeBanner (html, content);
  writeFacts (html, content);
  html.close ("header");
}
