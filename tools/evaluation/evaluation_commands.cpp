// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "evaluation_commands.h"

#include "evaluation_text.h"
#include "mesh_command.h"
#include "run_command.h"
#include "trajectory_command.h"

#include <deque>
#include <memory>

namespace {

/** \brief Settings that live as long as the process, for the options refer to them. */
template <typename Settings>
std::function<void (CLI::App&)>
declaring (void (*declare) (CLI::App&, Settings&))
{
  const auto settings = std::make_shared<Settings> ();
  return ([declare, settings] (CLI::App& app) { declare (app, *settings); });
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
  static const std::vector<EvaluationCommand> commands = {
      {"mesh", &meshText (), declaring (declareMeshOptions), runMeshCommand},
      {"trajectory", &trajectoryText (), declaring (declareTrajectoryOptions), runTrajectoryCommand},
      {"run", &runText (), declaring (declareRunOptions), runRunCommand},
  };
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
