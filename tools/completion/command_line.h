// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "arguments.h"
#include "terminal.h"

#include <pcl/cosection/io/pcd_view.h>
#include <pcl/cosection/surface/options.h>

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

/** \brief What the user asked for. */
struct Settings
{
  std::vector<std::string> inputs;
  std::string output;
  std::string format = "ply"; ///< extension of the meshes
  std::string json;           ///< empty: no summary
  bool save_sdf = false;
  std::size_t max_faces = 0; ///< of each mesh; 0: as many as there are
  Verbosity verbosity = Verbosity::Normal;
  std::string preset;      ///< empty: our own defaults
  std::string constraints; ///< none, hull, intersection or all
  std::vector<Eigen::Vector4d> planes;
  std::vector<std::string> free_space;            ///< views of which nothing else is used
  std::vector<std::string> obstacles;             ///< mesh files
  std::map<int, std::string> object_trajectories; ///< files, by label
  std::vector<std::array<double, 3>> viewpoints;  ///< one per view, inputs before free space; or none
  pcl::cosection::PcdViewOptions reading;
  pcl::cosection::CoSectionOptions method;
};

/** \brief The extension of \a path in lower case without the dot, if it is one of a mesh format
 * that can be written; else empty. */
std::string meshExtension (const std::string& path);

/** \brief Read the command line and the configuration file that it names.
 * \return nothing if all that was asked for was printed (--help, --version)
 * \throws UsageError */
std::optional<Settings> parseCommandLine (int argc, const char* const* argv);
