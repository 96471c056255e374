// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
// Compares reconstructed meshes, trajectories and whole runs with the truth, and simulates scenes; see
// pcl_cosection_evaluate --help.

#include "arguments.h"
#include "evaluation_commands.h"
#include "run_program.h"

#include <pcl/cosection/version.h>

#include <iostream>

namespace {

void
run (int argc, const char* const* argv, Terminal& terminal)
{
  const std::string word = argc > 1 ? argv[1] : "--help";
  if (word == "--help" || word == "-h")
  {
    std::cout << evaluationHelp () << std::flush;
    if (argc == 1)
      throw UsageError ("a command is missing: mesh, trajectory, run, views or stability");
    return;
  }
  if (word == "--version")
  {
    std::cout << "pcl_cosection_evaluate " PCL_COSECTION_VERSION << std::endl;
    return;
  }
  std::vector<std::string> words;
  for (const EvaluationCommand& command : evaluationCommands ())
  {
    if (command.word == word)
      return (command.run (argc - 1, argv + 1, terminal));
    words.push_back (command.word);
  }
  if (word[0] == '-')
    throw UsageError ("the command must come first: mesh, trajectory, run, views or stability; it is " + word);
  throw UsageError ("unknown command " + word +
                    (nearestName (word, words).empty () ? "; known are mesh, trajectory, run, views and stability"
                                                        : suggestion (word, words)));
}

} // namespace

int
main (int argc, char** argv)
{
  return (runProgram ({"pcl_cosection_evaluate"}, [&] (Terminal& terminal) {
    run (argc, argv, terminal);
    return (true);
  }));
}
