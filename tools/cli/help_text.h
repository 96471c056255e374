// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
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

/** \brief What a program, or a command of one, says about itself beside its options. */
struct ProgramText
{
  std::string name;     ///< "pcl_cosection"
  std::string summary;  ///< a few words, lower case, for the manual page
  std::string synopsis; ///< how it is called
  std::string purpose;
  std::vector<std::string> paragraphs;
  std::vector<UsageExample> examples;
  std::vector<std::string> configuration; ///< lines of a configuration file, as examples
};

/** \brief What the parts of the help screen are called, in lower case: the groups of options, and "examples". */
std::vector<std::string> helpTopics (const CLI::App& app);

/** \brief The help screen; of one topic only, unless \a topic is empty. Lines have at most 80 characters, topics at
 * most 24 lines. */
std::string helpText (const CLI::App& app, const ProgramText& program, const std::string& topic = "");

/** \brief The help as a page for man (1). */
std::string manPage (const CLI::App& app, const ProgramText& program);

/** \brief A command of a program that has several, each with options of its own. */
struct CommandHelp
{
  std::string word; ///< "mesh"
  const CLI::App* app = nullptr;
  const ProgramText* text = nullptr;
};

/** \brief The help screen of a program that has commands: what they are, without their options. */
std::string helpText (const ProgramText& program, const std::vector<CommandHelp>& commands);

/** \brief All commands as one page for man (1). */
std::string manPage (const ProgramText& program, const std::vector<CommandHelp>& commands);
