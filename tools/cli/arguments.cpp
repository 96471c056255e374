// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "arguments.h"

#include "option_values.h"

#include <pcl/cosection/version.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iostream>
#include <memory>
#include <sstream>
#include <system_error>

namespace {

/** \brief Levenshtein distance, where more letters at the end cost little: "--vox" is near "--voxel-size". */
std::size_t
editDistance (const std::string& word, const std::string& name)
{
  constexpr std::size_t full = 4; // cost of an edit; a letter missing at the end costs 1
  std::vector<std::size_t> row (name.size () + 1);
  for (std::size_t j = 0; j < row.size (); ++j)
    row[j] = j * full;
  for (std::size_t i = 1; i <= word.size (); ++i)
  {
    std::size_t diagonal = row[0];
    row[0] = i * full;
    for (std::size_t j = 1; j <= name.size (); ++j)
    {
      const std::size_t replaced = diagonal + (word[i - 1] == name[j - 1] ? 0 : full);
      diagonal = row[j];
      row[j] = std::min ({replaced, row[j] + full, row[j - 1] + full});
    }
  }
  std::size_t best = row[name.size ()];
  for (std::size_t j = 0; j < name.size (); ++j)
    best = std::min (best, row[j] + (name.size () - j));
  return (best);
}

/** \brief Configuration files, with the same answer to unknown names as the command line. */
class ConfigurationFile : public CLI::ConfigBase
{
public:
  explicit ConfigurationFile (std::vector<std::string> names) : names_ (std::move (names)) {}

  std::vector<CLI::ConfigItem> from_config (std::istream& input) const override
  {
    std::string text (most_bytes + 1, '\0');
    input.read (text.data (), static_cast<std::streamsize> (text.size ()));
    text.resize (static_cast<std::size_t> (input.gcount ()));
    if (text.size () > most_bytes || input.bad ())
      throw UsageError ("--config: the file cannot be read to its end, or is larger than " +
                        std::to_string (most_bytes >> 10) + " KiB");
    std::istringstream whole (text);
    for (std::string line; std::getline (whole, line);)
      refuseMalformed (line);
    std::istringstream lines (text);
    const std::vector<CLI::ConfigItem> entries = CLI::ConfigBase::from_config (lines);
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
  static constexpr std::size_t most_bytes = 1 << 20;

  /** \brief CLI11 leaves out lines without a name, and takes a quote that does not end as it is. */
  static void refuseMalformed (const std::string& line)
  {
    const std::size_t first = line.find_first_not_of (" \t");
    if (first == std::string::npos || line[first] == '#' || line[first] == ';')
      return;
    if (line[first] == '=')
      throw UsageError ("the configuration file has a line without a name: " + line);
    const std::size_t value = line.find_first_not_of (" \t", std::min (line.find ('='), line.size () - 1) + 1);
    if (value != std::string::npos && (line[value] == '"' || line[value] == '\'') &&
        line.find (line[value], value + 1) == std::string::npos)
      throw UsageError ("the configuration file has a quote that does not end: " + line);
  }

  const std::vector<std::string> names_;
};

/** \brief A pipe may never end, nor a device; one that the shell made for <(...) does. */
void
requireReadable (const std::string& configuration)
{
  std::error_code none;
  const auto status = std::filesystem::status (configuration, none);
  if (std::filesystem::exists (status) && !std::filesystem::is_regular_file (status) &&
      configuration.rfind ("/dev/fd/", 0) != 0)
    throw UsageError ("--config: " + configuration + " is not a regular file");
}

std::vector<std::string>
optionNames (const CLI::App& app)
{
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options ())
    for (const std::string& name : option->get_lnames ())
      names.push_back ("--" + name);
  return (names);
}

/** \brief CLI11 would take the value of an unknown option for an input. */
void
refuseUnknownOptions (const std::vector<std::string>& arguments, const std::vector<std::string>& names,
                      const CLI::App& app)
{
  std::string letters; // of options that have one, as -o
  for (const CLI::Option* option : app.get_options ())
    for (const std::string& letter : option->get_snames ())
      letters += letter;
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
      throw UsageError ("unknown option " + name + suggestion (name, names));
  }
}

} // namespace

void
declareGeneralOptions (CLI::App& app, const std::string& program, GeneralOptions& given)
{
  app.add_option ("paths", given.paths)->group ("")->configurable (false);
  const std::string name = "General";
  OptionGroup general (app, name);
  general.add ("--threads N", given.threads, wholeRange (1, 1024),
               "Threads to use, without influence on results (default: all processors)");
  general.addFlag ("--verbose", given.verbose, "Say what is being done");
  general.addFlag ("--quiet", given.quiet, "Print errors only");
  app.set_config ("--config", "", "Read options from a file; the command line overrides it")
      ->option_text ("FILE")
      ->group (name);
  app.set_version_flag ("--version", program + " " PCL_COSECTION_VERSION, "Print the version")->group (name);
  app.set_help_flag ("-h,--help", "Print this, or only a TOPIC of it")->group (name);
}

std::string
configurationFile (const std::vector<std::string>& arguments)
{
  const std::string option = "--config";
  for (std::size_t n = 0; n < arguments.size () && arguments[n] != "--"; ++n)
  {
    if (arguments[n] == option && n + 1 < arguments.size ())
      return (arguments[n + 1]);
    if (arguments[n].rfind (option + "=", 0) == 0)
      return (arguments[n].substr (option.size () + 1));
  }
  return ("");
}

Verbosity
verbosityOf (const GeneralOptions& given)
{
  if (given.quiet && given.verbose)
    throw UsageError ("--quiet and --verbose exclude each other");
  return (given.quiet ? Verbosity::Quiet : given.verbose ? Verbosity::Verbose : Verbosity::Normal);
}

void
requirePath (const std::vector<std::string>& paths, const std::string& name)
{
  if (paths.empty ())
    throw UsageError (name + " is missing; see --help");
  if (paths.size () > 1)
    throw UsageError ("there is one argument too many: " + paths[1]);
}

void
requirePaths (const std::vector<std::string>& paths, const std::string& first, const std::string& last,
              bool may_be_more)
{
  if (paths.empty ())
    throw UsageError (first + " and " + last + " are missing; see --help");
  if (paths.size () == 1)
    throw UsageError (last + " is missing after " + paths[0] + "; see --help");
  if (paths.size () > 2 && !may_be_more)
    throw UsageError ("there is one argument too many: " + paths[2]);
}

/** \brief CLI11 takes the next argument for the value of "--name=", as an empty variable of a script leaves it. */
static void
refuseEmptyValues (const std::vector<std::string>& arguments)
{
  for (const std::string& argument : arguments)
  {
    if (argument == "--")
      return;
    if (argument.size () > 3 && argument.compare (0, 2, "--") == 0 && argument.find ('=') + 1 == argument.size ())
      throw UsageError (argument.substr (0, argument.size () - 1) + " needs a value; it is empty");
  }
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
  const std::vector<std::string> arguments (argv + 1, argv + argc);
  refuseUnknownOptions (arguments, names, app);
  refuseEmptyValues (arguments);
  requireReadable (configurationFile (arguments));
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
    throw UsageError ("--config: " + configurationFile (arguments) + " cannot be read");
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

std::string
nearestName (const std::string& word, const std::vector<std::string>& names)
{
  std::string nearest;
  std::size_t smallest = 0;
  for (const std::string& name : names)
  {
    const std::size_t distance = editDistance (word, name);
    if (nearest.empty () || distance < smallest)
    {
      nearest = name;
      smallest = distance;
    }
  }
  const std::size_t letters = word.size () - std::min (word.size (), word.find_first_not_of ('-'));
  const std::size_t acceptable = 4 * (letters / 3) + 6; // a third of the letters, or the end missing
  return (smallest <= acceptable ? nearest : "");
}

std::string
suggestion (const std::string& word, const std::vector<std::string>& names, bool bare)
{
  const std::string name = nearestName (word, names);
  if (name.empty ())
    return ("");
  return ("; did you mean " + (bare ? name.substr (name.find_first_not_of ('-')) : name) + "?");
}
