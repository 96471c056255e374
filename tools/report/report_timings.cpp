// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "report_plots.h"
#include "report_tables.h"
#include "svg_chart.h"
#include "text_table.h"

#include <algorithm>

namespace
{

/** \brief A stage of a run, as summary.json and as a reader calls it. */
struct Stage
{
  const char* key;
  const char* name;
  bool is_part = false;   ///< of the stage before that is none
  bool is_beside = false; ///< at the same time as others
};

constexpr Stage stages[] = {
    {"read", "waiting for images"},
    {"segmentation", "masks, segmentation, association"},
    {"raycast", "projecting models"},
    {"tracking", "tracking"},
    {"integration", "integrating depth"},
    {"keyframes", "keyframes: points and free space"},
    {"updates", "completing at keyframes, beside the rest", false, true},
    {"final_solve", "completing"},
    {"data_term", "data term", true},
    {"constraints", "constraints", true},
    {"solve", "solving", true},
    {"mesh", "meshes", true},
    {"write", "writing"},
};

void
writeStage (HtmlTable& table, const std::string& name, double seconds, double total_s, const std::string& style)
{
  table.row (
      {{name}, {toText (seconds)}, {"", drawBar ({{style, seconds / total_s}}, inPercent (seconds / total_s), 300)}});
}

} // namespace

bool
writeTimings (HtmlWriter& html, const ReportContent& content)
{
  const Json& timings = member (content.run.summary, "timings_s");
  const std::optional<double> total_s = numberIn (timings, "total");
  if (!total_s || !(*total_s > 0.0))
    return (false);
  HtmlTable table (html, "Times per stage", {"Stage", "Seconds", "Share of all"}, "plain bars");
  double known_s = 0.0;
  for (const Stage& stage : stages)
  {
    const std::optional<double> seconds = numberIn (timings, stage.key);
    if (!seconds || *seconds < 1e-6)
      continue;
    if (!stage.is_part && !stage.is_beside)
      known_s += *seconds;
    writeStage (table, (stage.is_part ? "\xC2\xA0\xC2\xA0\xC2\xA0" : "") + std::string (stage.name), *seconds, *total_s,
                stage.is_part     ? "part"
                : stage.is_beside ? "beside"
                                  : "stage");
  }
  for (const auto& [key, value] : timings.items ())
    if (key != "total" && value.is_number () &&
        std::none_of (std::begin (stages), std::end (stages),
                      [&, &key = key] (const Stage& stage) { return (key == stage.key); }))
      writeStage (table, key, value.get<double> (), *total_s, "stage");
  if (*total_s - known_s > 0.005 * *total_s)
    writeStage (table, "the rest", *total_s - known_s, *total_s, "rest");
  table.row ({{"all"}, {toText (*total_s)}, {""}});
  table.end ();
  if (const std::optional<double> rate = numberIn (content.run.summary, "frames_per_second"))
    html.element ("p", toText (*rate) + " frames per second until the last completion, with reading.",
                  {{"class", "note"}});
  return (true);
}
