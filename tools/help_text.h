// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

/** \brief A command line and what it does. */
struct UsageExample
{
  std::string command;
  std::string meaning;
};

const std::vector<UsageExample>&
usageExamples ();

/** \brief What the parts of the help screen are called, in lower case: the groups of options, and "examples". */
std::vector<std::string>
helpTopics (const CLI::App& app);

/** \brief The help screen; of one topic only, unless \a topic is empty. Lines have at most 80 characters, topics at most
 * 24 lines. */
std::string
helpText (const CLI::App& app, const std::string& topic = "");

/** \brief The same as a page for man (1). */
std::string
manPage (const CLI::App& app);
