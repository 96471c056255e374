// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "report_scene.h"

#include "browser.h"

#include <memory>
#include <regex>

namespace fs = std::filesystem;
using namespace pcl::cosection::test;

namespace {

std::unique_ptr<TemporaryFolder> runs; // lives as long as the program

std::string
withoutMarkup (const std::string& html)
{
  return (std::regex_replace (html, std::regex ("<[^>]*>"), ""));
}

std::string
nameOfPage (const std::vector<std::string>& arguments)
{
  const auto named = std::find (arguments.begin (), arguments.end (), "-o");
  return (named == arguments.end () ? "report.html" : *(named + 1));
}

} // namespace

void
ReportScene::SetUpTestSuite ()
{
  FusionScene::SetUpTestSuite ();
  if (runs || HasFatalFailure ())
    return;
  runs = std::make_unique<TemporaryFolder> ();
  class Maker : public FusionScene
  {
  public:
    void TestBody () override {}

    std::string make ()
    {
      const int status = run (known ({"sim", "out"}));
      fs::copy (file ("out"), runs->file ("out"), fs::copy_options::recursive);
      return (status == 0 ? "" : errors_);
    }
  } maker;
  ASSERT_EQ (maker.make (), "");
}

ReportScene::ReportScene ()
{
  fs::copy (runs->file ("out"), file ("out"), fs::copy_options::recursive);
}

void
ReportScene::makeOtherRun ()
{
  ASSERT_EQ (run (known ({"--constraints", "none", "sim", "out_none"})), 0) << errors_;
}

int
ReportScene::report (const Words& arguments, const std::function<void ()>& prepare)
{
  return (run (arguments, prepare, PCL_COSECTION_REPORT));
}

void
ReportScene::expectNoReport (const Words& arguments, int status, const std::string& part)
{
  EXPECT_EQ (report (arguments), status) << part << '\n' << errors_;
  expectErrorLine (errors_, "pcl_cosection_report", part);
  EXPECT_FALSE (exists ("report.html"));
}

std::string
ReportScene::page (const Words& arguments)
{
  EXPECT_EQ (report (arguments), 0) << errors_;
  const std::string name = nameOfPage (arguments);
  EXPECT_EQ (output_.rfind ("wrote " + name + ": ", 0), 0u) << output_;
  return (readFile (file (name)));
}

std::string
ReportScene::shown (const Words& arguments)
{
  page (arguments);
  const BrowsedPage browsed = browse (file (""), nameOfPage (arguments),
                                      {"--disable-3d-apis", "--disable-gpu", "--dump-dom"});
  return (withoutScripts (browsed.document));
}

nlohmann::json
ReportScene::data (const std::string& page)
{
  const std::string begin = "id=\"report-data\">";
  const std::size_t at = page.find (begin) + begin.size ();
  return (nlohmann::json::parse (page.substr (at, page.find ("</script>", at) - at)));
}

std::string
ReportScene::cell (const std::string& page, const std::string& section, const std::string& row,
                   const std::string& column)
{
  const std::size_t begin = page.find ("<section id=\"" + section + "\">");
  if (begin == std::string::npos)
    return ("no section");
  const std::string part = page.substr (begin, page.find ("</section>", begin) - begin);
  std::vector<std::string> header;
  const std::size_t head_end = part.find ("</thead>");
  const std::regex name ("<th scope=\"col\">([^<]*)</th>");
  const std::string head = part.substr (0, head_end);
  for (std::sregex_iterator match (head.begin (), head.end (), name), end; match != end; ++match)
    header.push_back ((*match)[1]);
  std::size_t at = head_end;
  while ((at = part.find ("<tr>", at + 1)) != std::string::npos)
  {
    const std::string line = part.substr (at, part.find ("</tr>", at) - at);
    std::vector<std::string> cells;
    const std::regex cell_pattern ("<t[hd][^>]*>([\\s\\S]*?)</t[hd]>");
    for (std::sregex_iterator match (line.begin (), line.end (), cell_pattern), end; match != end; ++match)
      cells.push_back ((*match)[1]);
    const std::string first = cells.empty ()
                                  ? ""
                                  : withoutMarkup (std::regex_replace (cells[0], std::regex ("<small>.*</small>"), ""));
    const auto place = static_cast<std::size_t> (std::find (header.begin (), header.end (), column) - header.begin ());
    if (first == row || first == row + "\n")
      return (place < cells.size () ? withoutMarkup (cells[place]) : "no column");
  }
  return ("none");
}
