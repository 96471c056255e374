// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// The elements and charts of a report, as page/drawing.js makes them in a browser.

#ifdef PCL_COSECTION_CHROMIUM

#include "base64.h"
#include "browser.h"
#include "common/temporary_folder.h"

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <regex>

using namespace pcl::cosection::test;

namespace {

class ReportDrawing : public testing::Test
{
protected:
  /** \brief The value of an expression in a page that has the script; an element is its HTML. */
  nlohmann::json evaluate (const std::string& expression) const
  {
    const std::string script = readFile (std::string (PCL_COSECTION_SOURCE_DIR) + "/tools/report/page/drawing.js");
    writeFile (folder_.file ("page.html"), "<!DOCTYPE html><meta charset=\"utf-8\"><body><script>" + script +
                                               "</script><script>\n(function () { const value = " + expression +
                                               ";\nconst text = JSON.stringify (value instanceof Element ? "
                                               "value.outerHTML : value);\ndocument.body.setAttribute (\"title\", "
                                               "btoa (unescape (encodeURIComponent (text)))); }) ();</script>");
    const BrowsedPage page = browse (folder_.file (""), "page.html", {"--disable-gpu", "--dump-dom"});
    EXPECT_EQ (page.console, "");
    const std::string before = "<body title=\""; // std::regex takes stack for each letter of the long text behind it
    const std::size_t begin = page.document.find (before);
    if (begin == std::string::npos)
      return (nlohmann::json ());
    const std::size_t first = begin + before.size ();
    return (nlohmann::json::parse (fromBase64 (page.document.substr (first, page.document.find ('"', first) - first))));
  }

  const TemporaryFolder folder_;
};

} // namespace

TEST_F (ReportDrawing, TextsAreNoMarkup)
{
  EXPECT_EQ (evaluate ("Page.make ('p', {title: '\"><b>'}, '<b>&', null, Page.make ('i', {}, 'caf\u00e9'))"),
             "<p title=\"&quot;&gt;&lt;b&gt;\">&lt;b&gt;&amp;<i>caf\xC3\xA9</i></p>");
}

TEST_F (ReportDrawing, TicksAreRound)
{
  const auto all = evaluate ("[[0, 99, 6], [-0.31, 0.77, 5], [0, 1e-3, 5], [1e5, 1e5 + 7, 5], [-3, -2, 5], [2, 2, 5]]"
                             ".map (([least, most, count]) => Page.ticksBetween (least, most, count))");
  const std::vector<std::pair<double, double>> ranges = {{0, 99}, {-0.31, 0.77}, {0, 1e-3}, {1e5, 1e5 + 7}, {-3, -2}};
  ASSERT_EQ (all.size (), ranges.size () + 1);
  EXPECT_EQ (all[0].size (), 5u); // 0 20 ... 80
  for (std::size_t n = 0; n < ranges.size (); ++n)
  {
    const std::vector<double> ticks = all[n];
    ASSERT_GE (ticks.size (), 2u);
    EXPECT_LE (ticks.size (), 6u);
    const double step = ticks[1] - ticks[0];
    const double mantissa = step / std::pow (10.0, std::floor (std::log10 (step) + 1e-9));
    EXPECT_TRUE (std::abs (mantissa - 1) < 1e-3 || std::abs (mantissa - 2) < 1e-3 || std::abs (mantissa - 5) < 1e-3)
        << step;
    EXPECT_GE (ticks.front (), ranges[n].first - 1e-9);
    EXPECT_LE (ticks.back (), ranges[n].second + 1e-9 * std::abs (ranges[n].second));
  }
  EXPECT_EQ (all.back (), nlohmann::json ({2.0}));
}

TEST_F (ReportDrawing, ChartsAreToScale)
{
  const std::string svg = evaluate ("Page.lineChart ({title: '<squares>', xLabel: 'x', yLabel: 'y', height: 300, "
                                    "equalAxes: true, series: [{style: 's1', hasEnds: true, "
                                    "points: [[0, 0], [1, 0], [1, 1], [0, 1]]}]})");
  EXPECT_NE (svg.find ("aria-label=\"&lt;squares&gt;\""), std::string::npos) << svg;
  const std::regex path ("d=\"M([0-9.]+) ([0-9.]+)L([0-9.]+) ([0-9.]+)L([0-9.]+) ([0-9.]+)");
  std::smatch p;
  ASSERT_TRUE (std::regex_search (svg, p, path)) << svg;
  const double across = std::stod (p[3]) - std::stod (p[1]), upward = std::stod (p[4]) - std::stod (p[6]);
  EXPECT_GT (across, 100.0);
  EXPECT_NEAR (across, upward, 0.2); // equal axes, y up
  EXPECT_NEAR (std::stod (p[2]), std::stod (p[4]), 0.11);
  EXPECT_NE (svg.find ("<circle class=\"ring s1\""), std::string::npos);
}

TEST_F (ReportDrawing, LinesAreInterruptedAndThinned)
{
  const auto svgs = evaluate ("[[[0, 0], [1, 1], null, [2, 0], [3, 1]], Array.from ({length: 10000}, (_, n) => [n, n % "
                              "7]), []].map ((points) => Page.lineChart ({title: '', xLabel: '', yLabel: '', height: "
                              "260, series: [{style: 's1', points: points}]}).outerHTML)");
  ASSERT_EQ (svgs.size (), 3u);
  const std::string first = svgs[0];
  const std::size_t begin = first.find (" d=\"") + 4;
  const std::string path = first.substr (begin, first.find ('"', begin) - begin);
  EXPECT_EQ (std::count (path.begin (), path.end (), 'M'), 2) << path;
  EXPECT_EQ (path.find ("NaN"), std::string::npos);
  EXPECT_LT (svgs[1].get<std::string> ().size (), 12000u);
  EXPECT_EQ (svgs[2].get<std::string> ().find ("<path"), std::string::npos);
}

TEST_F (ReportDrawing, BarsFillTheirShare)
{
  const std::string bar = evaluate ("Page.bar ([{style: 'p0', share: 0.25}, {style: 'p1', share: 0}, "
                                    "{style: 'p2', share: 0.75}], 'shares', 200)");
  EXPECT_NE (bar.find ("class=\"p0\" x=\"0.00\" y=\"0\" width=\"50.00\""), std::string::npos) << bar;
  EXPECT_EQ (bar.find ("class=\"p1\""), std::string::npos);
  EXPECT_NE (bar.find ("class=\"p2\" x=\"50.00\" y=\"0\" width=\"150.00\""), std::string::npos) << bar;
}

#endif // PCL_COSECTION_CHROMIUM
