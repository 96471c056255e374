// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "method_options.h"

#include <pcl/cosection/io/pcd_view.h>

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

/** \brief What pcl_cosection says about itself. */
const ProgramText& completionText ();

/** \brief The options as the user gives them: what is absent leaves the preset as it is. */
struct Given : GivenMethod
{
  pcl::cosection::PcdViewOptions reading;
  std::vector<std::string> plane_values, viewpoint_values, intrinsics, trajectory_values, proposal_values;
  std::vector<std::string> free_space; ///< views of which nothing else is used
  std::vector<std::string> obstacles;  ///< mesh files
  bool segment = false;                ///< find the objects first
  double max_object_size_m = 0.0;      ///< of objects to be found; 0: the default
  std::string save_labels;             ///< empty: labels that were found are not written
  std::string axes = "optical";        ///< of the sensor
  std::string format;                  ///< extension of the meshes
  std::string model;                   ///< network of the learned prior
  std::string json;                    ///< empty: no summary
  std::vector<std::string> exports;    ///< formats for simulators
  std::size_t max_faces = 0;           ///< of each mesh; 0: as many as there are
  bool save_sdf = false, save_hull = false, save_bounds = false;
};

/** \brief What the user asked for: the options, and what they mean together. */
struct Settings : Given
{
  std::vector<std::string> inputs;
  std::string output;
  std::vector<Eigen::Vector4d> planes;
  std::map<int, std::string> object_trajectories;     ///< files, by label
  std::vector<std::pair<int, std::string>> proposals; ///< label and mesh file
  std::vector<std::array<double, 3>> viewpoints;      ///< one per view, inputs before free space; or none
  pcl::cosection::CoSectionOptions method;
};

/** \brief Declare every option of the program, and where the help screen shows it. */
void declareOptions (CLI::App& app, Given& given);

/** \brief The extension of \a path in lower case without the dot, if it is one of a mesh format
 * that can be written; else empty. */
std::string meshExtension (const std::string& path);

/** \brief Read the command line. \return nothing if all that was asked for was printed \throws UsageError */
std::optional<Settings> parseCommandLine (int argc, const char* const* argv);
