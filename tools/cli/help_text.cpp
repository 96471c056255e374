// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "help_text.h"

#include "pcl_cosection/io/lower_case.h"
#include <pcl/cosection/version.h>

#include <algorithm>
#include <cctype>
#include <sstream>

namespace {

constexpr std::size_t text_width = 80;
constexpr std::size_t name_width = 30; ///< of the column of option names

const char* const
    configuration_text = "A configuration file has a line NAME = VALUE for each option, without the dashes:";

const char* const status_text = "Exit status: 0 all went well, 1 something failed, 2 wrong usage, 130 interrupted.";

/** \brief \a text in lines, all but the first after \a indent spaces. */
std::string
wrapped (const std::string& text, std::size_t indent)
{
  std::istringstream words (text);
  std::string result, word;
  std::size_t column = indent;
  while (words >> word)
  {
    if (column > indent && column + 1 + word.size () > text_width)
    {
      result += "\n" + std::string (indent, ' ');
      column = indent;
    }
    else if (column > indent)
    {
      result += ' ';
      ++column;
    }
    result += word;
    column += word.size ();
  }
  return (result + "\n");
}

std::string
nameOf (const CLI::Option& option)
{
  std::string name;
  for (const std::string& letter : option.get_snames ())
    name += "-" + letter + ", ";
  for (const std::string& word : option.get_lnames ())
    name += "--" + word;
  return (option.get_option_text ().empty () ? name : name + " " + option.get_option_text ());
}

std::vector<const CLI::Option*>
optionsOf (const CLI::App& app, const std::string& group)
{
  return (app.get_options ([&group] (const CLI::Option* option) {
    return (option->get_group () == group && !option->get_lnames ().empty ());
  }));
}

std::vector<std::string>
groupsOf (const CLI::App& app)
{
  std::vector<std::string> groups;
  for (const std::string& group : app.get_groups ())
    if (!group.empty () && !optionsOf (app, group).empty ())
      groups.push_back (group);
  return (groups);
}

std::string
groupText (const CLI::App& app, const std::string& group)
{
  std::string text = group + ":\n";
  for (const CLI::Option* option : optionsOf (app, group))
  {
    std::string line = "  " + nameOf (*option);
    line += line.size () + 2 > name_width ? "\n" + std::string (name_width, ' ')
                                          : std::string (name_width - line.size (), ' ');
    text += line + wrapped (option->get_description (), name_width);
  }
  return (text);
}

std::string
exampleText (const ProgramText& program)
{
  std::string text = "Examples:\n";
  for (const UsageExample& example : program.examples)
    text += "  " + example.command + "\n      " + wrapped (example.meaning, 6);
  return (text);
}

/** \brief For man: no line may begin with a dot or an apostrophe, and dashes are to be dashes. */
std::string
escaped (const std::string& text)
{
  std::string result;
  for (const char c : text)
    if (c == '\\')
      result += "\\e";
    else if (c == '-')
      result += "\\-";
    else
      result += c;
  return (result.empty () || (result[0] != '.' && result[0] != '\'') ? result : "\\&" + result);
}

std::string
manHeader (const ProgramText& program)
{
  std::string title = program.name;
  std::transform (title.begin (), title.end (), title.begin (), [] (unsigned char c) { return (std::toupper (c)); });
  return (".TH " + title + " 1 \"\" \"pcl_cosection " PCL_COSECTION_VERSION "\" \"User Commands\"\n.SH NAME\n" +
          escaped (program.name) + " \\- " + escaped (program.summary) + "\n.SH SYNOPSIS\n");
}

std::string
manDescription (const ProgramText& program)
{
  std::string text = escaped (program.purpose);
  for (const std::string& paragraph : program.paragraphs)
    text += "\n.PP\n" + escaped (paragraph);
  return (text + "\n");
}

std::string
manOptions (const CLI::App& app)
{
  std::string text;
  for (const std::string& group : groupsOf (app))
  {
    text += ".SS " + group + "\n";
    for (const CLI::Option* option : optionsOf (app, group))
      text += ".TP\n.B " + escaped (nameOf (*option)) + "\n" + escaped (option->get_description ()) + "\n";
  }
  return (text);
}

std::string
manExamples (const ProgramText& program)
{
  std::string text;
  for (const UsageExample& example : program.examples)
    text += ".TP\n.B " + escaped (example.command) + "\n" + escaped (example.meaning) + "\n";
  return (text);
}

std::string
manEnd (const ProgramText& program)
{
  std::string text = ".SH FILES\n" + escaped (configuration_text) + "\n.PP\n.nf\n";
  for (const std::string& line : program.configuration)
    text += escaped (line) + "\n";
  return (text + ".fi\n.SH EXIT STATUS\n" + escaped (status_text) + "\n");
}

} // namespace

std::vector<std::string>
helpTopics (const CLI::App& app)
{
  std::vector<std::string> topics;
  for (const std::string& group : groupsOf (app))
    topics.push_back (pcl::cosection::lowerCase (group));
  topics.push_back ("examples");
  return (topics);
}

std::string
helpText (const CLI::App& app, const ProgramText& program, const std::string& topic)
{
  if (topic == "examples")
    return (exampleText (program));
  for (const std::string& group : groupsOf (app))
    if (pcl::cosection::lowerCase (group) == topic)
      return (groupText (app, group));
  std::string topics;
  for (const std::string& name : helpTopics (app))
    topics += (topics.empty () ? "" : ", ") + name;
  std::string text = wrapped (program.purpose, 0) + "\nUsage: " + program.synopsis + "\n\n";
  for (const std::string& paragraph : program.paragraphs)
    text += wrapped (paragraph, 2);
  text += "\n" + wrapped ("For a part of this: --help TOPIC, one of " + topics + ".", 0);
  for (const std::string& group : groupsOf (app))
    text += "\n" + groupText (app, group);
  text += "\n" + exampleText (program) + "\n" + wrapped (configuration_text, 0);
  for (const std::string& line : program.configuration)
    text += "  " + line + "\n";
  return (text + "\n" + wrapped (status_text, 0));
}

std::string
manPage (const CLI::App& app, const ProgramText& program)
{
  return (manHeader (program) + ".B " + escaped (program.synopsis) + "\n.SH DESCRIPTION\n" + manDescription (program) +
          ".SH OPTIONS\n" + manOptions (app) + ".SH EXAMPLES\n" + manExamples (program) + manEnd (program));
}

std::string
helpText (const ProgramText& program, const std::vector<CommandHelp>& commands)
{
  constexpr std::size_t indent = 14;
  std::string text = wrapped (program.purpose, 0) + "\nUsage: " + program.synopsis + "\n\nCommands:\n";
  for (const CommandHelp& command : commands)
    text += "  " + command.word + std::string (indent - 2 - command.word.size (), ' ') +
            wrapped (command.text->summary, indent);
  text += "\n";
  for (const std::string& paragraph : program.paragraphs)
    text += wrapped (paragraph, 2);
  text += "\n" + wrapped ("For the options of a command: " + program.name + " COMMAND --help.", 0);
  return (text + "\n" + exampleText (program) + "\n" + wrapped (status_text, 0));
}

std::string
manPage (const ProgramText& program, const std::vector<CommandHelp>& commands)
{
  std::string text = manHeader (program);
  for (const CommandHelp& command : commands)
    text += ".B " + escaped (command.text->synopsis) + "\n.br\n";
  text += ".SH DESCRIPTION\n" + manDescription (program);
  for (const CommandHelp& command : commands)
    text += ".SH COMMAND " + escaped (command.word) + "\n.B " + escaped (command.text->synopsis) + "\n.PP\n" +
            manDescription (*command.text) + manOptions (*command.app);
  text += ".SH EXAMPLES\n";
  for (const CommandHelp& command : commands)
    text += manExamples (*command.text);
  return (text + manEnd (program));
}
