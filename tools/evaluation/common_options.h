// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "arguments.h"
#include "evaluation_commands.h"

#include <pcl/cosection/evaluation/mesh_comparison.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

class OptionGroup;

/** \brief The options that all commands have. */
struct CommonOptions : GeneralOptions
{
  std::string json, csv;
};

/** \brief Declare --json and --csv in the group "Output", and the general ones. */
void declareCommonOptions (CLI::App& app, CommonOptions& given);

/** \brief Those of the commands that compare surfaces. */
struct SurfaceOptions
{
  long samples = 10000;
  std::uint64_t seed = 0;
  double f_threshold_m = 0.01;
  double penetration_voxel_m = 0.0; ///< 0: by the size of the meshes

  pcl::cosection::MeshComparisonOptions comparison (int threads) const;
};

/** \brief Declare --samples, --seed and --f-threshold. */
void declareSurfaceOptions (OptionGroup& group, SurfaceOptions& given);

/** \brief Do the work of a command, unless a path would be overwritten by --json or --csv. If it throws, {"error": ...}
 * is left in the JSON file, if that was asked for.
 * \param[in] first, second what the two paths are; an empty second: there is only one \param[in] check \throws
 * UsageError
 * \param[in] work returns whether every file that is there could be read
 * \throws UsageError, pcl::cosection::Error */
void executeCommand (const CommonOptions& given, const std::string& first, const std::string& second,
                     const std::function<void ()>& check, const std::function<bool ()>& work, Terminal& terminal);

/** \brief A command from its parts, see executeCommand (). */
template <typename Settings>
EvaluationCommand
makeCommand (const std::string& word, const ProgramText& text, const std::string& first, const std::string& second,
             void (*declare) (CLI::App&, Settings&), bool (*work) (const Settings&, Terminal&),
             void (*check) (const Settings&) = nullptr)
{
  const auto for_help = std::make_shared<Settings> (); // options refer to it
  const auto run = [=, &text] (int argc, const char* const* argv, Terminal& terminal) {
    CLI::App app;
    Settings settings;
    declare (app, settings);
    if (parseArguments (app, text, argc, argv))
      executeCommand (
          settings, first, second,
          [&] {
            if (check)
              check (settings);
          },
          [&] { return (work (settings, terminal)); }, terminal);
  };
  return {word, &text, [=] (CLI::App& app) { declare (app, *for_help); }, run};
}
