// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "evaluation_commands.h"

#include "help_text.h"
#include "mesh_command.h"
#include "run_command.h"
#include "stability_command.h"
#include "trajectory_command.h"
#include "views_command.h"

#include <deque>

namespace {

const ProgramText&
evaluationText ()
{
  static const ProgramText text = {
      "pcl_cosection_evaluate",
      "compare reconstructed meshes and trajectories with the truth",
      "pcl_cosection_evaluate mesh|trajectory [OPTIONS] TRUTH ESTIMATE\n       pcl_cosection_evaluate run [OPTIONS] "
      "OUTPUT DATASET\n       pcl_cosection_evaluate views [OPTIONS] TRUTH RESULT\n       pcl_cosection_evaluate "
      "stability [OPTIONS] SCENE",
      "Compares reconstructed meshes, trajectories and whole runs with the truth, and simulates scenes.",
      {"Lengths are in metres in options, JSON and CSV, and in millimetres on the terminal. An unknown command, file "
       "or option is refused; what cannot be measured is said."},
      {
          {"pcl_cosection_evaluate mesh truth.ply cup.ply", "how near a mesh is to the true one"},
          {"pcl_cosection_evaluate trajectory groundtruth.txt camera.txt", "how near a trajectory is to the true one"},
          {"pcl_cosection_evaluate run output dataset", "all objects, the camera and the background of a run"},
          {"pcl_cosection_evaluate views scenes completed", "the completed objects of many scenes"},
          {"pcl_cosection_evaluate stability scene", "which bodies of a scene for a simulator stay where they are"},
      },
      {"f-threshold = 0.005", "threads = 2"},
  };
  return (text);
}

/** \brief The commands with their options. */
struct DeclaredCommands
{
  DeclaredCommands ()
  {
    for (const EvaluationCommand& command : evaluationCommands ())
    {
      apps.emplace_back ();
      command.declare (apps.back ());
      help.push_back ({command.word, &apps.back (), command.text});
    }
  }

  std::deque<CLI::App> apps;
  std::vector<CommandHelp> help;
};

} // namespace

const std::vector<EvaluationCommand>&
evaluationCommands ()
{
  static const std::vector<EvaluationCommand> commands = {meshCommand (), trajectoryCommand (), runCommand (),
                                                          viewsCommand (), stabilityCommand ()};
  return (commands);
}

std::string
evaluationHelp ()
{
  return (helpText (evaluationText (), DeclaredCommands ().help));
}

std::string
evaluationManPage ()
{
  const DeclaredCommands commands;
  return (manPage (evaluationText (), commands.help));
}
