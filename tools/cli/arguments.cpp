// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "arguments.h"

#include "suggestion.h"

#include <pcl/cosection/version.h>

#include <algorithm>
#include <cctype>
#include <iostream>
#include <memory>

namespace {

std::string
unknownOption (const std::string& given, const std::vector<std::string>& names)
{
  return ("unknown option " + given + suggestion (given, names));
}

/** \brief Configuration files, with the same answer to unknown names as the command line. */
class ConfigurationFile : public CLI::ConfigBase
{
public:
  explicit ConfigurationFile (std::vector<std::string> names) : names_ (std::move (names)) {}

  std::vector<CLI::ConfigItem> from_config (std::istream& input) const override
  {
    const std::vector<CLI::ConfigItem> entries = CLI::ConfigBase::from_config (input);
    for (const CLI::ConfigItem& item : entries)
    {
      if (!item.parents.empty ())
        throw UsageError ("the configuration file has a section [" + item.parents[0] + "]; there are no sections");
      if (std::find (names_.begin (), names_.end (), "--" + item.name) == names_.end ())
        throw UsageError (item.name.find_first_of (" \t:") != std::string::npos
                              ? "the configuration file has a line without \"=\": " + item.name
                              : "unknown option in the configuration file: " + item.name +
                                    suggestion ("--" + item.name, names_, true));
    }
    return (entries);
  }

private:
  const std::vector<std::string> names_;
};

std::vector<std::string>
optionNames (const CLI::App& app)
{
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options ())
    for (const std::string& name : option->get_lnames ())
      names.push_back ("--" + name);
  return (names);
}

/** \brief Options that have a letter, as -o, one after the other. */
std::string
optionLetters (const CLI::App& app)
{
  std::string letters;
  for (const CLI::Option* option : app.get_options ())
    for (const std::string& name : option->get_snames ())
      letters += name;
  return (letters);
}

/** \brief CLI11 would take the value of an unknown option for an input. */
void
refuseUnknownOptions (const std::vector<std::string>& arguments, const std::vector<std::string>& names,
                      const std::string& letters)
{
  for (const std::string& argument : arguments)
  {
    if (argument == "--")
      return;
    const std::string name = argument.substr (0, argument.find ('='));
    const bool is_option = name.size () > 1 && name[0] == '-' && !std::isdigit (static_cast<unsigned char> (name[1])) &&
                           name[1] != '.';
    const bool is_value = name == "-nan" || name == "-inf"; // refused later, by the option that it was given to
    const bool is_letter = name.size () > 1 && name[1] != '-' && letters.find (name[1]) != std::string::npos;
    if (is_option && !is_value && !(is_letter && (name.size () == 2 || name[1] != 'h')) &&
        std::find (names.begin (), names.end (), name) == names.end ())
      throw UsageError (unknownOption (name, names));
  }
}

} // namespace

void
declareGeneralOptions (CLI::App& app, const std::string& program, bool& verbose, bool& quiet)
{
  const std::string general = "General";
  app.add_flag ("--verbose", verbose, "Say what is being done")->group (general);
  app.add_flag ("--quiet", quiet, "Print errors only")->group (general);
  app.set_config ("--config", "", "Read options from a file; the command line overrides it")
      ->option_text ("FILE")
      ->group (general);
  app.set_version_flag ("--version", program + " " PCL_COSECTION_VERSION, "Print the version")->group (general);
  app.set_help_flag ("-h,--help", "Print this, or only a TOPIC of it")->group (general);
}

bool
parseArguments (CLI::App& app, const ProgramText& program, int argc, const char* const* argv)
{
  for (int i = 1; i + 1 < argc; ++i)
    if (std::string (argv[i]) == "--help")
    {
      const std::vector<std::string> topics = helpTopics (app);
      if (std::find (topics.begin (), topics.end (), argv[i + 1]) == topics.end ())
        throw UsageError ("--help knows no topic " + std::string (argv[i + 1]) + "; --help alone names them");
      std::cout << helpText (app, program, argv[i + 1]);
      return (false);
    }
  const std::vector<std::string> names = optionNames (app);
  app.config_formatter (std::make_shared<ConfigurationFile> (names));
  refuseUnknownOptions (std::vector<std::string> (argv + 1, argv + argc), names, optionLetters (app));
  try
  {
    app.parse (argc, argv);
    return (true);
  }
  catch (const CLI::CallForHelp&)
  {
    std::cout << helpText (app, program);
    return (false);
  }
  catch (const CLI::CallForVersion& version)
  {
    std::cout << version.what () << std::endl;
    return (false);
  }
  catch (const CLI::FileError&)
  {
    throw UsageError ("--config: the file cannot be read");
  }
  catch (const CLI::ArgumentMismatch& error)
  {
    const std::string message = error.what ();
    const bool missing = message.find ("missing") != std::string::npos;
    throw UsageError (message.substr (0, message.find (':')) +
                      (missing ? " needs a value" : " is given more than once"));
  }
  catch (const CLI::ParseError& error)
  {
    throw UsageError (error.what ());
  }
}
