// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// pcl_cosection_report as a user calls it: the numbers on the page are those of the run and of its evaluation; the run
// stays as it is.

#include "browser.h"
#include "evaluation_output.h"
#include "report_command_line.h"
#include "report_scene.h"

#include "tools/scene_files.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <iterator>
#include <map>
#include <sstream>

using namespace pcl::cosection::test;
namespace fs = std::filesystem;

namespace {

class Report : public ReportScene
{
protected:
  /** \brief What pcl_cosection_evaluate says of a run. */
  nlohmann::json evaluation (const std::string& run) const
  {
    ToolRun tool ({"run", "--json", "evaluation.json", run, "sim"}, file (""), {}, PCL_COSECTION_EVALUATE);
    EXPECT_EQ (tool.wait (), 0) << tool.errors ();
    return (json ("evaluation.json"));
  }

  /** \brief Bytes and times of all files below a folder. */
  std::map<std::string, std::pair<std::string, fs::file_time_type>> state (const std::string& folder) const
  {
    std::map<std::string, std::pair<std::string, fs::file_time_type>> files;
    for (const std::string& name : filesIn (folder))
      files[name] = {readFile (file (folder + "/" + name)), fs::last_write_time (file (folder + "/" + name))};
    return (files);
  }
};

/** \brief A text as a browser writes it into HTML. */
std::string
inHtml (const std::string& text)
{
  std::string html;
  for (const char c : text)
    html += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string (1, c);
  return (html);
}

std::string
scoreText (const nlohmann::json& object)
{
  return (inMillimetres (object["accuracy_m"]) + " / " + inMillimetres (object["completeness_m"]) + " / " +
          toText (object["f_score"]));
}

} // namespace

TEST_F (Report, ObjectsAreAsTheSummarySays)
{
  if (!hasBrowser ())
    GTEST_SKIP () << "there is no browser";
  const std::string html = shown ({"out"});
  const nlohmann::json summary = json ("out/summary.json");
  ASSERT_EQ (summary["objects"].size (), 2u);
  for (const nlohmann::json& object : summary["objects"])
  {
    const std::string name = "object " + object["id"].dump ();
    EXPECT_EQ (cell (html, "objects", name, "Volume (ml)"), inMillilitres (object["volume_m3"]));
    EXPECT_EQ (cell (html, "objects", name, "Closed"), "yes");
    EXPECT_EQ (cell (html, "objects", name, "Inside others (mm)"), inMillimetres (object["penetration_m"]));
    EXPECT_EQ (cell (html, "objects", name, "Frames tracked"), object["frames_tracked"].dump ());
    EXPECT_EQ (cell (html, "objects", name, "Solver").rfind (object["solver"]["iterations"].dump () + " iteration", 0),
               0u);
    std::string shares;
    for (const char* kind : {"observed", "inferred", "hull", "intersection"})
      shares += (shares.empty () ? "" : " \xC2\xB7 ") +
                std::to_string (std::lround (100.0 * object["provenance"][kind].get<double> ()));
    EXPECT_NE (cell (html, "objects", name, "Provenance").find (shares + " %"), std::string::npos);
  }
  EXPECT_NE (html.find ("from 12 frames"), std::string::npos);
  EXPECT_EQ (cell (html, "parameters", "keyframe_every", "Value"), "10");
  EXPECT_EQ (cell (html, "parameters", "dataset", "Value"), "sim");
  EXPECT_EQ (cell (html, "times", "all", "Seconds"), toText (summary["timings_s"]["total"]));
  EXPECT_EQ (cell (html, "times", "completing", "Seconds"), toText (summary["timings_s"]["final_solve"]));
  EXPECT_EQ (html.find ("id=\"accuracy\""), std::string::npos);
  EXPECT_EQ (html.find ("id=\"comparison\""), std::string::npos);
  for (const nlohmann::json& warning : summary["warnings"])
    EXPECT_NE (html.find ("<li>" + inHtml (warning) + "</li>"), std::string::npos) << warning;
  EXPECT_EQ (html.find ("No warnings.") == std::string::npos, !summary["warnings"].empty ());
}

TEST_F (Report, CompletedViewsAreShown)
{
  if (!hasBrowser ())
    GTEST_SKIP () << "there is no browser";
  writeTableScene (file ("table.pcd"));
  ToolRun completion ({"--voxel-size", "0.006", "table.pcd", "table"}, file (""));
  ASSERT_EQ (completion.wait (), 0) << completion.errors ();
  const std::string html = shown ({"table"});
  const nlohmann::json summary = json ("table/summary.json");
  for (const nlohmann::json& object : summary["objects"])
    EXPECT_EQ (cell (html, "objects", "object " + object["id"].dump (), "Volume (ml)"),
               inMillilitres (object["volume_m3"]));
  EXPECT_NE (html.find ("Completed, from behind, by provenance"), std::string::npos);
  for (const char* const part : {"Seen, from", "no masks", "Before and after", "no trajectory"})
    EXPECT_EQ (html.find (part), std::string::npos) << part;
  EXPECT_NE (html.find ("No warnings."), std::string::npos);
  fs::remove (file ("table/summary.json"));
  EXPECT_EQ (report ({"table"}), 0) << errors_;
  EXPECT_NE (errors_.find ("a place is assumed"), std::string::npos) << errors_;
}

TEST_F (Report, ErrorsAreAsTheEvaluationSays)
{
  if (!hasBrowser ())
    GTEST_SKIP () << "there is no browser";
  makeOtherRun ();
  const std::string html = shown ({"--truth", "sim", "--compare", "out_none", "-o", "a.html", "out"});
  const nlohmann::json all = evaluation ("out"), none = evaluation ("out_none");
  ASSERT_EQ (all["objects"].size (), 2u);
  for (std::size_t n = 0; n < 2; ++n)
  {
    const nlohmann::json& object = all["objects"][n];
    const std::string name = object["truth"];
    EXPECT_EQ (cell (html, "accuracy", name, "Accuracy (mm)"), inMillimetres (object["accuracy_m"]));
    EXPECT_EQ (cell (html, "accuracy", name, "Completeness (mm)"), inMillimetres (object["completeness_m"]));
    EXPECT_EQ (cell (html, "accuracy", name, "F at 10 mm"), toText (object["f_score"]));
    EXPECT_EQ (cell (html, "accuracy", name, "Inside others (mm)"), inMillimetres (object["penetration_m"]));
    EXPECT_EQ (cell (html, "accuracy", name, "ATE (mm)"), inMillimetres (object["ate_rmse_m"]));
    EXPECT_EQ (cell (html, "accuracy", name, "RPE (mm)"), inMillimetres (object["rpe_trans_rmse_m"]));
    EXPECT_EQ (cell (html, "accuracy", name, "Tracked / visible"),
               object["frames_tracked_visible"].dump () + " / " + object["frames_visible"].dump ());
    EXPECT_EQ (cell (html, "comparison", "this run", name), scoreText (object));
    EXPECT_EQ (cell (html, "comparison", "out_none", name), scoreText (none["objects"][n]));
    EXPECT_NE (scoreText (object), scoreText (none["objects"][n]));
    EXPECT_NE (cell (html, "comparison", "seen only", name).find (" / "), std::string::npos);
  }
  EXPECT_EQ (cell (html, "accuracy", "background", "Accuracy (mm)"), inMillimetres (all["background"]["accuracy_m"]));
  EXPECT_NE (html.find ("constraints: none"), std::string::npos);
}

TEST_F (Report, RunsCompareWithoutTruthToo)
{
  if (!hasBrowser ())
    GTEST_SKIP () << "there is no browser";
  makeOtherRun ();
  const std::string html = shown ({"out", "--compare", "out_none"});
  const nlohmann::json object = json ("out_none/summary.json")["objects"][0];
  EXPECT_EQ (cell (html, "comparison", "out_none", "object 1"),
             inMillilitres (object["volume_m3"]) + " / " + inMillimetres (object["penetration_m"]));
}

TEST_F (Report, TheRunStaysAsItIs)
{
  const auto run = state ("out"), sequence = state ("sim");
  page ({"--truth", "sim", "out"});
  EXPECT_EQ (state ("out"), run);
  EXPECT_EQ (state ("sim"), sequence);
}

TEST_F (Report, SameInputSamePage)
{
  const std::string first = page ({"--truth", "sim", "--threads", "1", "out"});
  fs::remove (file ("report.html"));
  EXPECT_EQ (page ({"--truth", "sim", "--threads", "3", "out"}), first);
}

TEST_F (Report, WrongUsage)
{
  expectNoReport ({}, 2, "OUTPUT is missing");
  expectNoReport ({""}, 2, "OUTPUT is empty");
  expectNoReport ({"out", "report.html"}, 2, "one argument too many: report.html; the report is named with -o");
  expectNoReport ({"--thruth", "sim", "out"}, 2, "did you mean --truth?");
  expectNoReport ({"-x", "out"}, 2, "unknown option -x");
  expectNoReport ({"-o", "report.pdf", "out"}, 2, "-o must end in .html; it is report.pdf");
  expectNoReport ({"--quiet", "--verbose", "out"}, 2, "exclude each other");
  expectNoReport ({"out", "--truth"}, 2, "--truth needs a value");
}

TEST_F (Report, FoldersThatAreNoRuns)
{
  expectNoReport ({"nowhere"}, 1,
                  "nowhere: there is no such folder; it must be what pcl_cosection_fusion or pcl_cosection wrote");
  expectNoReport ({"out/summary.json"}, 1, "out/summary.json: is a file; it must be the folder");
  expectNoReport ({"sim"}, 1, "sim: is a dataset, not a run; first run pcl_cosection_fusion sim OUTPUT");
  fs::create_directory (file ("empty"));
  expectNoReport ({"empty"}, 1, "empty: is an empty folder");
  fs::create_directory (file ("foreign"));
  writeFile (file ("foreign/holiday.jpg"), "beach");
  expectNoReport ({"foreign"}, 1, "foreign: is not a result: it has neither summary.json nor mesh/ nor trajectory/");
  fs::copy (file ("out/trajectory/camera.txt"), file ("foreign/camera.txt"));
  expectNoReport ({"foreign"}, 1, "foreign: is not a result: it has neither summary.json nor mesh/ nor trajectory/");
  fs::create_directories (file ("void/mesh"));
  expectNoReport ({"void"}, 1, "void: is a run in which nothing is left");
  expectNoReport ({"--truth", "nowhere", "out"}, 1, "nowhere: is no folder; it must be a dataset with truth");
  expectNoReport ({"--truth", "empty", "out"}, 1, "empty/gt-cam-0.txt");
  expectNoReport ({"--compare", "sim", "out"}, 1, "sim: is a dataset, not a run");
  expectNoReport ({"-o", "nowhere/a.html", "out"}, 1, "nowhere/a.html: cannot be written");
}

TEST_F (Report, NothingThatIsReadIsWrittenOver)
{
  makeOtherRun ();
  for (const char* name : {"out/mesh/a.html", "out/trajectory/a.html", "out/../out/mesh/a.html"})
    expectNoReport ({"-o", name, "out"}, 2, "is where the run out has its files");
  expectNoReport ({"--compare", "out_none", "-o", "out_none/mesh/a.html", "out"}, 2,
                  "is where the run out_none has its files");
  const auto run = state ("out"), sequence = state ("sim");
  for (const char* target : {"out/summary.json", "sim/gt-cam-0.txt"})
  {
    fs::create_symlink (target, file ("link.html"));
    expectNoReport ({"--truth", "sim", "-o", "link.html", "out"}, 2,
                    "link.html would be overwritten: it is part of the input");
    fs::remove (file ("link.html"));
  }
  EXPECT_EQ (state ("out"), run);
  EXPECT_EQ (state ("sim"), sequence);
  page ({"-o", "out/report.html", "out"}); // beside what the run wrote
  page ({"-o", "out/report.html", "out"}); // and again
}

TEST_F (Report, OnAFullDiskThereIsNoHalfReport)
{
  writeFile (file ("report.html"), "the last one");
  const auto limit = [] {
    const rlimit bytes = {200000, 200000};
    std::signal (SIGXFSZ, SIG_IGN);
    setrlimit (RLIMIT_FSIZE, &bytes);
  };
  EXPECT_EQ (report ({"out"}, limit), 1);
  EXPECT_NE (errors_.find ("report.html"), std::string::npos) << errors_;
  EXPECT_EQ (readFile (file ("report.html")), "the last one");
}

TEST_F (Report, InterruptedRuns)
{
  if (!hasBrowser ())
    GTEST_SKIP () << "there is no browser";
  fs::remove (file ("out/summary.json"));
  const std::string html = shown ({"--truth", "sim", "out"});
  EXPECT_NE (errors_.find ("warning: out/summary.json is missing"), std::string::npos) << errors_;
  EXPECT_NE (html.find ("The run is incomplete"), std::string::npos);
  EXPECT_EQ (cell (html, "objects", "ball", "Closed"), "yes"); // by the mesh
  EXPECT_EQ (cell (html, "objects", "ball", "Solver"), "\xE2\x80\x93");
  EXPECT_EQ (html.find ("id=\"times\""), std::string::npos);
}

TEST_F (Report, FailedRuns)
{
  if (!hasBrowser ())
    GTEST_SKIP () << "there is no browser";
  fs::remove_all (file ("out/mesh"));
  fs::remove_all (file ("out/trajectory"));
  writeFile (file ("out/summary.json"),
             R"({"error": "no frame can be read", "objects": [], "failed": [], "warnings": [],
        "parameters": {"dataset": "a/b"}})");
  const std::string html = shown ({"out"});
  EXPECT_NE (errors_.find ("warning: the run failed: no frame can be read"), std::string::npos) << errors_;
  EXPECT_NE (html.find ("<strong>The run failed: </strong>no frame can be read"), std::string::npos);
  EXPECT_NE (html.find ("<h1>b</h1>"), std::string::npos);
}

TEST_F (Report, RunsWithoutSomeOfTheirFiles)
{
  if (!hasBrowser ())
    GTEST_SKIP () << "there is no browser";
  writeFile (file ("out/mesh/object_1.ply"), "ply\nnot really");
  fs::remove (file ("out/mesh/object_2_tsdf.ply"));
  fs::remove (file ("out/trajectory/object_2.txt"));
  fs::remove (file ("out/trajectory/camera.txt"));
  const std::string html = shown ({"--truth", "sim", "out"});
  for (const char* part : {"object_1.ply", "object 1 has no completed mesh", "object 2 has no trajectory",
                           "there is no trajectory of the camera", "the run cannot be compared with the truth of sim"})
  {
    EXPECT_NE (errors_.find (part), std::string::npos) << part << '\n' << errors_;
    EXPECT_NE (html.find (part), std::string::npos) << part;
  }
  EXPECT_EQ (cell (html, "objects", "object 2", "Closed"), "yes");
}

TEST_F (Report, DamagedAndOddSummaries)
{
  if (!hasBrowser ())
    GTEST_SKIP () << "there is no browser";
  for (const char* text : {"", "{", "[]"})
  {
    writeFile (file ("out/summary.json"), text);
    page ({"out"});
    EXPECT_NE (errors_.find ("is not JSON as the programs write it"), std::string::npos) << text;
  }
  writeFile (file ("out/summary.json"),
             R"({"error": 5, "timings_s": {"total": "long", "read": []}, "frames": -3, "parameters": [1],
        "camera": {"fx": "wide"},
    "objects": [{"id": 1, "volume_m3": "much", "closed": 7, "provenance": [], "solver": 3}, {"id": "x"},
      {"id": 1e300}, 5, null],
    "failed": [{"id": 9, "error": "too small"}, 7], "warnings": {"a": 1}, "events": [1, "begun"]})");
  const std::string html = shown ({"out"});
  EXPECT_EQ (cell (html, "objects", "object 9", "Size (mm)"), "failed: too small");
  EXPECT_EQ (cell (html, "objects", "object 1", "Closed"), "yes");
  EXPECT_NE (html.find ("<li>begun</li>"), std::string::npos);
}

TEST_F (Report, TextsOfFilesAreHarmless)
{
  if (!hasBrowser ())
    GTEST_SKIP () << "there is no browser";
  const std::string hostile = "<img src=x onerror=alert(1)>";
  fs::rename (file ("out"), file (hostile));
  nlohmann::json summary = json (hostile + "/summary.json");
  summary["warnings"] = {"</script><script>alert(2)</script>", "a\xFF\"'&z"};
  summary["parameters"]["dataset"] = "data/<b>bold";
  summary["parameters"]["</td><script>alert(3)</script>"] = "<i>";
  summary["events"] = {"<svg onload=alert(4)>"};
  writeFile (file (hostile + "/summary.json"), summary.dump (-1, ' ', false, nlohmann::json::error_handler_t::ignore));
  for (const char* kind : {"gt-ball-1.txt"})
    fs::rename (file (std::string ("sim/") + kind), file ("sim/gt-<b onclick=alert(5)>-1.txt"));
  fs::rename (file ("sim/gt-mesh/ball.ply"), file ("sim/gt-mesh/<b onclick=alert(5)>.ply"));
  const std::string html = page ({"--truth", "sim", hostile}), document = shown ({"--truth", "sim", hostile});
  for (const char* part : {"<img src=x", "<script>alert", "<svg onload", "<b>bold", "<b onclick", "<i>\n"})
  {
    EXPECT_EQ (html.find (part), std::string::npos) << part;
    EXPECT_EQ (document.find (part), std::string::npos) << part;
  }
  EXPECT_NE (document.find ("&lt;/script&gt;&lt;script&gt;alert(2)"), std::string::npos);
  EXPECT_NE (document.find ("&lt;b onclick=alert(5)&gt;"), std::string::npos);
}

TEST_F (Report, ObjectsAreCalledByTheirClasses)
{
  nlohmann::json summary = json ("out/summary.json");
  ASSERT_EQ (summary["objects"].size (), 2u);
  const nlohmann::json unknown = summary;
  summary["objects"][0]["class"] = "sports ball";
  summary["objects"][1]["class"] = "41"; // has no name
  writeFile (file ("out/summary.json"), summary.dump ());
  const auto names = [this] (const Words& arguments) {
    Words list;
    const nlohmann::json report = data (page (arguments));
    for (const nlohmann::json& object : report["objects"])
      list.push_back (object["name"]);
    return (list);
  };
  EXPECT_EQ (names ({"out"}), (Words{"sports ball 1", "object 2"}));
  // What the truth calls them comes first.
  EXPECT_EQ (names ({"--truth", "sim", "out"}), (Words{"ball", "box"}));
  for (const nlohmann::json& odd :
       {nlohmann::json (5), nlohmann::json (""), nlohmann::json ({"cup"}), nlohmann::json ()})
  {
    summary = unknown;
    summary["objects"][0]["class"] = odd;
    writeFile (file ("out/summary.json"), summary.dump ());
    EXPECT_EQ (names ({"out"})[0], "object 1") << odd;
  }
  summary["objects"][0]["class"] = "<u onclick=alert(1)>";
  writeFile (file ("out/summary.json"), summary.dump ());
  EXPECT_EQ (page ({"out"}).find ("<u onclick"), std::string::npos);
}

TEST_F (Report, TheExamplesWork)
{
  makeOtherRun ();
  fs::rename (file ("sim"), file ("table"));
  fs::rename (file ("out"), file ("things"));
  fs::rename (file ("out_none"), file ("things_none"));
  std::ofstream options (file ("report.txt"));
  for (const std::string& line : reportText ().configuration)
    options << line << std::endl;
  for (const UsageExample& example : reportText ().examples)
  {
    std::istringstream in (example.command);
    Words words{std::istream_iterator<std::string> (in), {}};
    ASSERT_EQ (words.front (), "pcl_cosection_report");
    words.erase (words.begin ());
    page (words);
  }
  EXPECT_EQ (report ({"--config", "report.txt", "things"}), 0) << errors_;
  EXPECT_EQ (report ({"--quiet", "things"}), 0);
  EXPECT_EQ (output_ + errors_, "");
  EXPECT_EQ (report ({"-oother.html", "things"}), 0) << errors_;
  EXPECT_TRUE (exists ("other.html"));
}
