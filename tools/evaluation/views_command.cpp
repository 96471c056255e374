// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "views_command.h"

#include "certainty.h"
#include "common_options.h"
#include "evaluation_output.h"
#include "option_values.h"
#include "output_files.h"

#include "pcl_cosection/common/files.h"
#include "pcl_cosection/evaluation/pictures/error_picture.h"
#include "pcl_cosection/rendering/picture.h"
#include "pcl_cosection/volume/mesh_distance/mesh_surface.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/mesh_io.h>

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <sstream>

namespace fs = std::filesystem;

using namespace pcl::cosection;

namespace {

constexpr double volume_tolerance = 0.25;   // relative
constexpr double bound_tolerance_m = 0.001; // truth so near to an outer bound is inside: the noise of a reading

struct ViewsSettings : CommonOptions, SurfaceOptions
{
  double gross_m = 0.006;
  std::string pictures; ///< folder
  int worst = 8;        ///< pictures
};

/** \brief One true object and what was made of it. */
struct ViewedObject : ViewedFiles
{
  bool is_missing = true;
  MeshComparison comparison; ///< at the threshold
  double f_half = 0.0;       ///< F-score at half of the threshold
  bool closed = false;
  std::optional<double> volume_ratio;
  std::vector<VertexError> errors;   ///< beside the expected ones, if the result has those
  std::vector<std::string> warnings; ///< about frames and units
  std::optional<double> in_outer;    ///< share of the truth inside the outer bound, if there is one

  double worse_m () const { return (std::max (comparison.accuracy.mean, comparison.completeness.mean)); }

  bool isGross (double gross_m) const { return (is_missing || worse_m () > gross_m); }
};

const ProgramText&
viewsText ()
{
  static const ProgramText text = {
      "pcl_cosection_evaluate views",
      "completed objects of many scenes against their true meshes",
      "pcl_cosection_evaluate views [OPTIONS] TRUTH RESULT",
      "Compares the completed objects of many scenes with their true meshes.",
      {"TRUTH/SCENE/truth_LABEL.ply or truth_LABEL_NAME.ply are true meshes, as pcl_cosection_simulate --meshes writes "
       "them (names also in names.txt); RESULT/SCENE/object_LABEL.ply are those of pcl_cosection, in the same frame. "
       "An "
       "object without a result, or worse than --gross in accuracy or completeness, is a gross error. If results have "
       "sigma_m, the errors of their vertices are compared with it; outer bounds, object_LABEL_outer.ply, with the "
       "truth."},
      {
          {"pcl_cosection_evaluate views scenes completed", "a line for each object, and a summary"},
          {"pcl_cosection_evaluate views --pictures worst --worst 10 scenes completed",
           "also pictures of the ten worst objects"},
      },
      {"f-threshold = 0.01", "gross = 0.006"},
  };
  return (text);
}

/** \brief Compare the expected errors of a result with the true ones, and its outer bound with the truth. */
void
checkCertainty (const ViewsSettings& settings, const TriangleMesh& truth, ViewedObject& object)
{
  const fs::path result = object.result;
  if (result.extension () == ".ply")
    object.errors = vertexErrors (SurfaceDistance (truth), loadPlyMesh (object.result), settings.threads);
  const fs::path outer = result.parent_path () / (result.stem ().string () + "_outer.ply");
  if (fs::exists (outer))
    object.in_outer = shareInside (truth, loadPlyMesh (outer.string ()), bound_tolerance_m, settings.samples,
                                   settings.seed);
}

void
compareObject (const ViewsSettings& settings, ViewedObject& object)
{
  const TriangleMesh truth = loadMesh (object.truth);
  if (!fs::exists (object.result))
    return;
  const TriangleMesh mesh = loadMesh (object.result);
  MeshComparisonOptions options = settings.comparison (settings.threads);
  options.f_threshold_m *= 0.5;
  object.f_half = compareMeshes (truth, mesh, options).f_score;
  object.comparison = compareMeshes (truth, mesh, settings.comparison (settings.threads));
  const MeshSummary expected = summarizeMesh (truth), found = summarizeMesh (mesh);
  object.warnings = frameWarnings (expected, found);
  object.closed = found.topology.closed_manifold;
  if (expected.volume_m3 && found.volume_m3 && *expected.volume_m3 > 0.0)
    object.volume_ratio = *found.volume_m3 / *expected.volume_m3;
  checkCertainty (settings, truth, object);
  object.is_missing = false;
}

/** \brief What all objects are like; missing ones have no distances, and F-scores of 0. */
struct Summary
{
  Summary (const std::vector<ViewedObject>& objects, double gross_m) : count (objects.size ())
  {
    std::vector<double> accuracies, completenesses;
    for (const ViewedObject& object : objects)
    {
      gross += object.isGross (gross_m);
      f_half += object.f_half / static_cast<double> (count);
      f += object.comparison.f_score / static_cast<double> (count);
      if (object.is_missing)
      {
        ++missing;
        continue;
      }
      errors.insert (errors.end (), object.errors.begin (), object.errors.end ());
      if (object.in_outer)
        in_outer.push_back (*object.in_outer);
      closed += object.closed;
      wrong_volume += object.volume_ratio && std::abs (*object.volume_ratio - 1.0) > volume_tolerance;
      accuracies.push_back (object.comparison.accuracy.mean);
      completenesses.push_back (object.comparison.completeness.mean);
    }
    accuracy = errorStatistics (accuracies);
    completeness = errorStatistics (completenesses);
  }

  std::size_t count, missing = 0, closed = 0, gross = 0, wrong_volume = 0;
  double f_half = 0.0, f = 0.0;
  ErrorStatistics accuracy, completeness; // of the objects' means
  std::vector<VertexError> errors;        // of all vertices
  std::vector<double> in_outer;           // of the objects that have an outer bound
};

void
print (const ViewsSettings& settings, const std::vector<ViewedObject>& objects, const Summary& summary,
       Terminal& terminal)
{
  const std::string half = "F " + toShortText (500.0 * settings.f_threshold_m) + " mm";
  const std::string whole = "F " + toShortText (1000.0 * settings.f_threshold_m) + " mm";
  TextTable table ({"scene", "object", "accuracy", "completeness", half, whole, "volume", "(mm)"});
  for (const ViewedObject& object : objects)
  {
    const std::string name = object.label + (object.name.empty () ? "" : " " + object.name);
    if (object.is_missing)
      table.add ({object.scene, name, "missing"});
    else
      table.add ({object.scene, name, inMillimetres (object.comparison.accuracy.mean),
                  inMillimetres (object.comparison.completeness.mean), toText (object.f_half),
                  toText (object.comparison.f_score), object.volume_ratio ? toText (*object.volume_ratio) : "",
                  object.isGross (settings.gross_m) ? "gross"
                  : object.closed                   ? ""
                                                    : "open"});
  }
  table.print (terminal);
  terminal.result ("");
  terminal.result (counted (summary.count, "object") + ", " + std::to_string (summary.missing) + " missing, " +
                   std::to_string (summary.closed) + " closed");
  terminal.result ("accuracy " + inMillimetres (summary.accuracy.mean) + " mm, completeness " +
                   inMillimetres (summary.completeness.mean) + " mm on average; medians " +
                   inMillimetres (summary.accuracy.median) + " and " + inMillimetres (summary.completeness.median) +
                   " mm");
  terminal.result (half + ": " + toText (summary.f_half) + ", " + whole + ": " + toText (summary.f));
  terminal.result (counted (summary.gross, "gross error") + ", over " + inMillimetres (settings.gross_m) +
                   " mm either way or missing; " + std::to_string (summary.wrong_volume) +
                   " with a volume off by more than " + inPercent (volume_tolerance));
  printCertainty (summary.errors, summary.in_outer, terminal);
}

Json
toJson (const ViewsSettings& settings, const std::vector<ViewedObject>& objects, const Summary& summary)
{
  Json json;
  json["objects"] = Json::array ();
  for (const ViewedObject& object : objects)
  {
    Json entry = {{"scene", object.scene},
                  {"label", object.label},
                  {"name", object.name},
                  {"missing", object.is_missing},
                  {"gross", object.isGross (settings.gross_m)}};
    if (!object.is_missing)
    {
      addComparison (object.comparison, settings.f_threshold_m, entry);
      entry["f_score_half"] = object.f_half;
      entry["closed"] = object.closed;
      entry["volume_ratio"] = orNull (object.volume_ratio);
      if (!object.errors.empty ())
        entry["expected_errors"] = coverageJson (errorCoverage (object.errors));
      if (object.in_outer)
        entry["inside_outer_bound"] = *object.in_outer;
    }
    json["objects"].push_back (std::move (entry));
  }
  json["summary"] = {{"objects", summary.count},
                     {"missing", summary.missing},
                     {"closed", summary.closed},
                     {"gross", summary.gross},
                     {"wrong_volume", summary.wrong_volume},
                     {"accuracy_m", summary.accuracy.mean},
                     {"accuracy_median_m", summary.accuracy.median},
                     {"completeness_m", summary.completeness.mean},
                     {"completeness_median_m", summary.completeness.median},
                     {"f_score_half", summary.f_half},
                     {"f_score", summary.f}};
  if (!summary.errors.empty ())
    json["expected_errors"] = certaintyJson (summary.errors);
  json["parameters"] = {{"samples", settings.samples},
                        {"seed", settings.seed},
                        {"f_threshold_m", settings.f_threshold_m},
                        {"gross_m", settings.gross_m}};
  return (json);
}

std::string
toCsv (const std::vector<ViewedObject>& objects)
{
  std::string text = csvRow ({"scene", "label", "name", "missing", "accuracy_m", "completeness_m", "f_score_half",
                              "f_score", "volume_ratio", "closed"});
  for (const ViewedObject& object : objects)
  {
    const bool known = !object.is_missing;
    const auto field = [&] (double value) { return (known ? toField (value) : std::string ()); };
    text += csvRow ({object.scene, object.label, object.name, known ? "0" : "1",
                     field (object.comparison.accuracy.mean), field (object.comparison.completeness.mean),
                     field (object.f_half), field (object.comparison.f_score), toField (object.volume_ratio),
                     known && object.closed ? "1" : "0"});
  }
  return (text);
}

/** \brief Error pictures of the worst objects that are there. */
void
drawWorst (const ViewsSettings& settings, const std::vector<ViewedObject>& objects, Terminal& terminal)
{
  std::vector<const ViewedObject*> order;
  for (const ViewedObject& object : objects)
    if (!object.is_missing)
      order.push_back (&object);
  std::stable_sort (order.begin (), order.end (),
                    [] (const auto* a, const auto* b) { return (a->worse_m () > b->worse_m ()); });
  order.resize (std::min<std::size_t> (order.size (), static_cast<std::size_t> (settings.worst)));
  makeFolder (settings.pictures);
  for (std::size_t n = 0; n < order.size (); ++n)
  {
    const ViewedObject& object = *order[n];
    ErrorPictureOptions options;
    options.error_max_m = roundErrorUp (std::max (object.comparison.accuracy.p95, object.comparison.completeness.p95));
    options.threads = settings.threads;
    const std::string number = std::to_string (n + 1);
    const fs::path file = fs::path (settings.pictures) / (std::string (number.size () < 2 ? "0" : "") + number + "_" +
                                                          object.scene + "_" + object.label + ".png");
    writePng (drawErrorPicture (loadMesh (object.truth), loadMesh (object.result), options), file.string ());
  }
  terminal.result ("wrote " + counted (order.size (), "picture") + " into " + settings.pictures);
}

/** \brief Warn of objects whose unit or frame is not that of their truth, with the first of them. */
void
warnOfFrames (const std::vector<ViewedObject>& objects, Terminal& terminal)
{
  const auto isOdd = [] (const ViewedObject& object) { return (!object.warnings.empty ()); };
  const auto first = std::find_if (objects.begin (), objects.end (), isOdd);
  if (first == objects.end ())
    return;
  const auto others = std::count_if (first + 1, objects.end (), isOdd);
  terminal.warning (first->result + ": " + first->warnings.front () +
                    (others > 0 ? " (and " + counted (static_cast<std::size_t> (others), "object") + " more)" : ""));
}

bool
compare (const ViewsSettings& settings, Terminal& terminal)
{
  std::vector<ViewedObject> objects;
  for (const ViewedFiles& files : findViewedFiles (settings.paths[0], settings.paths[1]))
  {
    objects.emplace_back ();
    static_cast<ViewedFiles&> (objects.back ()) = files;
  }
  bool all_read = true;
  for (std::size_t n = 0; n < objects.size (); ++n)
  {
    terminal.progress ("objects", static_cast<double> (n) / static_cast<double> (objects.size ()));
    try
    {
      compareObject (settings, objects[n]);
    }
    catch (const Error& error)
    {
      terminal.warning (error.what ());
      all_read = false;
    }
  }
  warnOfFrames (objects, terminal);
  const Summary summary (objects, settings.gross_m);
  print (settings, objects, summary, terminal);
  if (!settings.json.empty ())
    saveJson (toJson (settings, objects, summary), settings.json);
  if (!settings.csv.empty ())
    saveText (toCsv (objects), settings.csv);
  if (!settings.pictures.empty ())
    drawWorst (settings, objects, terminal);
  return (all_read);
}

void
declareViewsOptions (CLI::App& app, ViewsSettings& settings)
{
  OptionGroup comparison (app, "Comparison"), output (app, "Output");
  declareSurfaceOptions (comparison, settings);
  comparison.add ("--gross METRES", settings.gross_m, positiveNumber (),
                  "Mean distance beyond which an object counts as grossly wrong" + byDefault (settings.gross_m));
  output.add ("--pictures FOLDER", settings.pictures, "Draw the worst objects, coloured by their errors");
  output.add ("--worst N", settings.worst, wholeRange (1, 1000),
              "Number of these pictures" + byDefault (settings.worst));
  declareCommonOptions (app, settings);
}

} // namespace

EvaluationCommand
viewsCommand ()
{
  return (makeCommand<ViewsSettings> ("views", viewsText (), "TRUTH", "RESULT", declareViewsOptions, compare));
}
