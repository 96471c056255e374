// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "arguments.h"

#include <pcl/cosection/visualization/scene_picture.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

/** \brief From where a picture is taken unless a viewpoint is given. */
enum class ViewChoice
{
  Overview,
  Behind, ///< what the cameras did not see
  Camera, ///< with the camera of the run
};

/** \brief What the user of pcl_cosection_viewer asked for: the options, and what they mean. */
struct ViewerSettings : GeneralOptions
{
  std::string run;        ///< folder
  std::string truth;      ///< dataset; empty: none
  std::string dataset;    ///< of the input points; empty: the one that the run names
  std::string viewpoint;  ///< file; empty: \a choice
  std::string screenshot; ///< file; empty: none
  std::string record;     ///< folder; empty: none
  std::string follow;     ///< folder of snapshots; empty: nothing is followed
  std::string choice_name, mode, colour, size;
  std::vector<std::string> hidden;
  ViewChoice choice = ViewChoice::Overview;
  std::optional<double> stamp; ///< nothing: the last
  std::optional<int> triangles_given, every_given;
  std::size_t triangles = 0;      ///< of each surface, at most; 0: all
  std::size_t every = 1;          ///< frames, to record
  pcl::cosection::SceneView view; ///< without a viewpoint

  bool needsWindow () const { return (screenshot.empty () && record.empty ()); }
};

/** \brief What pcl_cosection_viewer says about itself. */
const ProgramText& viewerText ();

void declareViewerOptions (CLI::App& app, ViewerSettings& settings);

/** \brief Read the command line. \return nothing if all that was asked for was printed \throws UsageError */
std::optional<ViewerSettings> parseViewerCommandLine (int argc, const char* const* argv);
