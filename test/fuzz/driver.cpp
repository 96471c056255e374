// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// main () of a fuzz target where the compiler brings no fuzzing engine: random changes of valid inputs.

#include "fuzz_target.h"
#include "mutator.h"
#include "watch.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <limits>
#include <optional>
#include <stdexcept>

namespace fs = std::filesystem;

namespace {

const char* const usage = R"(Usage: PROGRAM [--runs N] [--seconds S] [--seed K] [FILE_OR_FOLDER ...]
       PROGRAM FILE ...
       PROGRAM --write-seeds FOLDER

Reads random changes of valid inputs, which it makes itself, and of the given files, until N inputs are
read or S seconds are over; the same again for the same K. An input that crashes the program, lasts
longer than 10 seconds or takes absurd amounts of memory is saved to the working directory.
Given files alone are read once as they are, which reproduces a failure.

  --write-seeds   write the valid inputs to files, for other fuzzing engines
)";

struct Arguments
{
  std::optional<std::uint64_t> runs;
  std::optional<double> seconds;
  std::uint64_t seed = 1;
  std::string seed_folder;
  std::vector<std::string> files;
};

std::string
readFile (const fs::path& path)
{
  std::ifstream file (path, std::ios::binary);
  if (!file)
    throw std::runtime_error (path.string () + ": cannot be read");
  return {std::istreambuf_iterator<char> (file), {}};
}

Arguments
parse (const std::vector<std::string>& words)
{
  Arguments arguments;
  for (std::size_t i = 0; i < words.size (); ++i)
  {
    if (words[i].rfind ("--", 0) != 0)
    {
      arguments.files.push_back (words[i]);
      continue;
    }
    if (i + 1 == words.size ())
      throw std::invalid_argument (words[i]);
    const std::string& value = words[i + 1];
    if (words[i] == "--runs")
      arguments.runs = std::stoull (value);
    else if (words[i] == "--seconds")
      arguments.seconds = std::stod (value);
    else if (words[i] == "--seed")
      arguments.seed = std::stoull (value);
    else if (words[i] == "--write-seeds")
      arguments.seed_folder = value;
    else
      throw std::invalid_argument (words[i]);
    ++i;
  }
  return (arguments);
}

/** \brief The files themselves and those in the folders, sorted. */
std::vector<std::string>
listFiles (const std::vector<std::string>& names)
{
  std::vector<std::string> files;
  for (const std::string& name : names)
    if (fs::is_directory (name))
      for (const auto& entry : fs::recursive_directory_iterator (name))
      {
        if (entry.is_regular_file ())
          files.push_back (entry.path ().string ());
      }
    else
      files.push_back (name);
  std::sort (files.begin (), files.end ());
  return (files);
}

/** \brief An exception that escapes is a failure as a crash is. */
bool
read (const std::string& input, const std::string& name) noexcept
{
  fuzz::watchBegin (input, name);
  const bool accepted = fuzz::accepts (input);
  fuzz::watchEnd ();
  return (accepted);
}

void
writeSeeds (const std::string& folder)
{
  fs::create_directories (folder);
  int number = 0;
  for (const std::string& seed : fuzz::seeds ())
    std::ofstream (fs::path (folder) / ("seed_" + std::to_string (number++)), std::ios::binary) << seed;
}

void
replay (const std::vector<std::string>& files)
{
  for (const std::string& file : files)
    std::cout << file << (read (readFile (file), "") ? ": accepted" : ": refused") << std::endl;
}

void
fuzzOn (const std::string& program, const Arguments& arguments)
{
  using Clock = std::chrono::steady_clock;
  std::vector<std::string> inputs = fuzz::seeds ();
  for (const std::string& seed : inputs) // else the changes begin with nothing
    if (!read (seed, program + "_seed.input"))
      throw std::runtime_error ("a valid input is refused:\n" + seed.substr (0, seed.find ("DATA ")));
  for (const std::string& file : listFiles (arguments.files))
    inputs.push_back (readFile (file));
  fuzz::Mutator mutator (inputs, fuzz::dictionary ());
  const std::uint64_t runs = arguments.runs.value_or (std::numeric_limits<std::uint64_t>::max ());
  const auto start = Clock::now ();
  std::uint64_t run = 0, accepted = 0;
  for (; run < runs; ++run)
  {
    if (arguments.seconds && std::chrono::duration<double> (Clock::now () - start).count () > *arguments.seconds)
      break;
    accepted += read (mutator.make (arguments.seed, run),
                      program + "_" + std::to_string (arguments.seed) + "_" + std::to_string (run) + ".input");
  }
  std::cout << program << ": " << run << " changed inputs read, " << accepted << " of them accepted" << std::endl;
}

} // namespace

int
main (int argc, char** argv)
{
  try
  {
    const Arguments arguments = parse ({argv + 1, argv + argc});
    const std::string program = fs::path (argv[0]).filename ().string ();
    if (!arguments.seed_folder.empty ())
      writeSeeds (arguments.seed_folder);
    else if (!arguments.runs && !arguments.seconds && arguments.files.empty ())
      throw std::invalid_argument ("nothing to do");
    else
    {
      fuzz::startWatching (program);
      if (arguments.runs || arguments.seconds)
        fuzzOn (program, arguments);
      else
        replay (listFiles (arguments.files));
    }
    return (EXIT_SUCCESS);
  }
  catch (const std::logic_error& error) // of the command line
  {
    std::cerr << error.what () << "\n" << usage;
    return (2);
  }
  catch (const std::exception& error)
  {
    std::cerr << error.what () << std::endl;
    return (EXIT_FAILURE);
  }
}
