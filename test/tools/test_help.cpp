// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// What the program says about itself: the help screen, the manual page and the document have every option, and the
// examples work.

#include "command_line.h"
#include "common/temporary_folder.h"
#include "evaluation_commands.h"
#include "export_command_line.h"
#include "fusion_command_line.h"
#include "report_command_line.h"
#include "scene_files.h"
#include "segment_command_line.h"
#include "simulate_command_line.h"
#include "tool_run.h"
#include "viewer_command_line.h"

#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <sstream>

namespace {

class Help : public testing::Test
{
protected:
  Help () { declareOptions (app_, given_); }

  CLI::App app_;
  Given given_;
};

std::vector<std::string>
linesOf (const std::string& text)
{
  std::vector<std::string> lines;
  std::istringstream in (text);
  for (std::string line; std::getline (in, line);)
    lines.push_back (line);
  return (lines);
}

std::string
withoutBackslashes (std::string text)
{
  text.erase (std::remove (text.begin (), text.end (), '\\'), text.end ());
  return (text);
}

/** \brief Every option is on the help screen, the manual page and in the document, and is described. \return how many
 * there are */
int
expectEverywhere (const CLI::App& app, const std::string& screen, const std::string& man_page,
                  const std::string& document_name)
{
  std::ifstream file (std::string (PCL_COSECTION_SOURCE_DIR) + "/doc/" + document_name);
  const std::string document ((std::istreambuf_iterator<char> (file)), {});
  const std::string page = withoutBackslashes (man_page);
  int options = 0;
  for (const CLI::Option* option : app.get_options ())
    for (const std::string& name : option->get_lnames ())
    {
      ++options;
      EXPECT_NE (screen.find ("--" + name), std::string::npos) << name;
      EXPECT_NE (page.find ("--" + name), std::string::npos) << name;
      EXPECT_NE (document.find ("--" + name), std::string::npos) << name;
      EXPECT_FALSE (option->get_description ().empty ()) << name;
    }
  return (options);
}

} // namespace

TEST_F (Help, EachTopicFitsAScreen)
{
  const std::vector<std::string> topics = helpTopics (app_);
  EXPECT_GE (topics.size (), 6u);
  for (const std::string& topic : topics)
  {
    const std::vector<std::string> lines = linesOf (helpText (app_, completionText (), topic));
    EXPECT_LE (lines.size (), 24u) << topic;
    EXPECT_GE (lines.size (), 3u) << topic;
    for (const std::string& line : lines)
      EXPECT_LE (line.size (), 80u) << line;
  }
  for (const std::string& line : linesOf (helpText (app_, completionText ())))
    EXPECT_LE (line.size (), 80u) << line;
}

TEST_F (Help, EveryOptionIsEverywhere)
{
  EXPECT_GE (expectEverywhere (app_, helpText (app_, completionText ()), manPage (app_, completionText ()),
                               "pcl_cosection.md"),
             30);
}

TEST_F (Help, SimulationIsExplained)
{
  CLI::App app;
  SimulateSettings given;
  declareSimulationOptions (app, given);
  const std::string screen = helpText (app, simulationText ());
  EXPECT_GE (expectEverywhere (app, screen, manPage (app, simulationText ()), "pcl_cosection_simulate.md"), 12);
  for (const std::string& line : linesOf (screen))
    EXPECT_LE (line.size (), 80u) << line;
}

TEST_F (Help, SegmentationIsExplained)
{
  CLI::App app;
  GivenSegmentation given;
  declareSegmentationOptions (app, given);
  const std::string screen = helpText (app, segmentationText ());
  EXPECT_GE (expectEverywhere (app, screen, manPage (app, segmentationText ()), "pcl_cosection_segment.md"), 12);
  for (const std::string& line : linesOf (screen))
    EXPECT_LE (line.size (), 80u) << line;
}

TEST_F (Help, ExportIsExplained)
{
  CLI::App app;
  ExportProgramSettings given;
  declareExportOptions (app, given);
  const std::string screen = helpText (app, exportText ());
  EXPECT_GE (expectEverywhere (app, screen, manPage (app, exportText ()), "pcl_cosection_export.md"), 10);
  for (const std::string& line : linesOf (screen))
    EXPECT_LE (line.size (), 80u) << line;
}

TEST_F (Help, ReportsAreExplained)
{
  CLI::App app;
  ReportSettings given;
  declareReportOptions (app, given);
  const std::string screen = helpText (app, reportText ());
  EXPECT_GE (expectEverywhere (app, screen, manPage (app, reportText ()), "pcl_cosection_report.md"), 8);
  for (const std::string& line : linesOf (screen))
    EXPECT_LE (line.size (), 80u) << line;
}

TEST_F (Help, FusionIsExplained)
{
  CLI::App app;
  GivenFusion given;
  declareFusionOptions (app, given);
  const std::string screen = helpText (app, fusionText ());
  EXPECT_GE (expectEverywhere (app, screen, manPage (app, fusionText ()), "pcl_cosection_fusion.md"), 35);
  for (const std::string& topic : helpTopics (app))
  {
    const std::vector<std::string> lines = linesOf (helpText (app, fusionText (), topic));
    EXPECT_LE (lines.size (), 24u) << topic;
    for (const std::string& line : lines)
      EXPECT_LE (line.size (), 80u) << line;
  }
}

TEST_F (Help, ViewerIsExplained)
{
  CLI::App app;
  ViewerSettings given;
  declareViewerOptions (app, given);
  const std::string screen = helpText (app, viewerText ());
  EXPECT_GE (expectEverywhere (app, screen, manPage (app, viewerText ()), "pcl_cosection_viewer.md"), 18);
  for (const std::string& topic : helpTopics (app))
  {
    const std::vector<std::string> lines = linesOf (helpText (app, viewerText (), topic));
    EXPECT_LE (lines.size (), 24u) << topic;
    for (const std::string& line : lines)
      EXPECT_LE (line.size (), 80u) << line;
  }
}

TEST_F (Help, EveryOptionOfEveryCommandIsEverywhere)
{
  for (const EvaluationCommand& command : evaluationCommands ())
  {
    CLI::App app;
    command.declare (app);
    const std::string screen = helpText (app, *command.text);
    EXPECT_GE (expectEverywhere (app, screen, evaluationManPage (), "pcl_cosection_evaluate.md"), 10) << command.word;
    for (const std::string& topic : helpTopics (app))
    {
      const std::vector<std::string> lines = linesOf (helpText (app, *command.text, topic));
      EXPECT_LE (lines.size (), 24u) << command.word << ' ' << topic;
      for (const std::string& line : lines)
        EXPECT_LE (line.size (), 80u) << line;
    }
    EXPECT_NE (evaluationHelp ().find ("  " + command.word), std::string::npos);
  }
}

TEST_F (Help, TopicsAreGivenByTheProgram)
{
  const pcl::cosection::test::TemporaryFolder folder;
  ToolRun topic ({"--help", "surroundings"}, folder.file (""));
  EXPECT_EQ (topic.wait (), 0);
  EXPECT_EQ (topic.output (), helpText (app_, completionText (), "surroundings"));
  ToolRun all ({"--help"}, folder.file (""));
  EXPECT_EQ (all.wait (), 0);
  EXPECT_EQ (all.output (), helpText (app_, completionText ()));
}

TEST_F (Help, ExamplesWork)
{
  const pcl::cosection::test::TemporaryFolder folder;
  for (const char* name : {"table.pcd", "other.pcd"})
    writeTableScene (folder.file (name));
  int points = 3000; // other ones in each: those that are given twice count once
  for (const char* name : {"front.pcd", "left.pcd", "cropped.pcd"})
    writeSphere (folder.file (name), points += 50);
  pcl::PointCloud<pcl::PointNormal> cloud;
  pcl::io::loadPCDFile (folder.file ("cropped.pcd"), cloud);
  for (auto& p : cloud)
    p.z -= 0.4f; // it stands on the plane of its example
  pcl::io::savePCDFileBinary (folder.file ("cropped.pcd"), cloud);
  pcl::io::loadPCDFile (folder.file ("front.pcd"), cloud);
  for (auto& p : cloud)
    p.getVector3fMap () *= 1000.0f;
  pcl::io::savePCDFileBinary (folder.file ("scan_mm.pcd"), cloud);
  std::ofstream (folder.file ("shelf.off")) << "OFF\n4 1 0\n-1 -1 0.38\n1 -1 0.38\n1 1 0.38\n-1 1 0.38\n4 0 1 2 3\n";
  for (const UsageExample& example : completionText ().examples)
  {
    std::istringstream in (example.command);
    std::vector<std::string> words{std::istream_iterator<std::string> (in), {}};
    ASSERT_EQ (words.front (), "pcl_cosection");
    words.erase (words.begin ());
    ToolRun run (words, folder.file (""));
    EXPECT_EQ (run.wait (), 0) << example.command << "\n" << run.errors ();
    EXPECT_EQ (run.errors (), "") << example.command;
    EXPECT_TRUE (std::filesystem::exists (folder.file (words.back ()))) << example.command;
  }
}
