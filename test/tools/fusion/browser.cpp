// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "browser.h"

#include "tools/tool_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

bool
hasBrowser ()
{
#ifdef PCL_COSECTION_CHROMIUM
  return (true);
#else
  return (false);
#endif
}

BrowsedPage
browse (const std::string& folder, const std::string& name, const std::vector<std::string>& more)
{
  BrowsedPage page;
#ifdef PCL_COSECTION_CHROMIUM
  std::vector<std::string> words = {"--headless",
                                    "--no-sandbox",
                                    "--disable-dev-shm-usage",
                                    "--use-angle=swiftshader",
                                    "--enable-unsafe-swiftshader",
                                    "--hide-scrollbars",
                                    "--no-first-run",
                                    "--user-data-dir=" + folder + "/profile",
                                    "--host-resolver-rules=MAP * ~NOTFOUND",
                                    "--enable-logging=stderr",
                                    "--log-net-log=" + folder + "/net.json",
                                    "--virtual-time-budget=8000"};
  words.insert (words.end (), more.begin (), more.end ());
  words.push_back ("file://" + folder + "/" + name);
  ToolRun browser (words, folder, {}, PCL_COSECTION_CHROMIUM);
  EXPECT_EQ (browser.wait (), 0) << browser.errors ();
  std::istringstream lines (browser.errors ());
  for (std::string line; std::getline (lines, line);)
    if (line.find ("CONSOLE") != std::string::npos)
      page.console += line + '\n';
  page.document = browser.output ();
#endif
  return (page);
}

std::string
withoutScripts (const std::string& document)
{
  std::string rest = document;
  const std::string end = "</script>";
  for (std::size_t at = rest.find ("<script"); at != std::string::npos; at = rest.find ("<script", at))
    rest.erase (at, std::max (at, rest.find (end, at)) - at + end.size ());
  return (rest);
}
