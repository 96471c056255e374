// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "command_line.h"
#include "scene_input.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/surface/co_section.h>

#include <nlohmann/json.hpp>

#include <functional>
#include <map>
#include <string>
#include <vector>

/** \brief From where an input was taken. */
struct ViewOrigin
{
  std::size_t input = 0; ///< its number, from 0
  pcl::cosection::PinholeCamera camera;
  Eigen::Isometry3d T_world_sensor;                ///< metres
  std::map<int, Eigen::Isometry3d> T_world_object; ///< of the objects that move, as far as they are known there
};

/** \brief The completed objects of views. */
struct CompletedViews
{
  pcl::cosection::SceneResult scene;                 ///< with the times of all stages
  Eigen::Vector3d origin = Eigen::Vector3d::Zero (); ///< of the frame of the scene, in the world
  std::vector<ViewOrigin> views;                     ///< of the inputs, as far as they have a viewpoint
  std::vector<std::string> warnings;                 ///< all, those about objects that failed among them
};

/** \brief Takes a line as soon as it is known. */
using WarningCallback = std::function<void (const std::string& line)>;

/** \brief Read the views of the settings and complete their objects.
 * \param[in,out] settings get the network that is used \param[in] progress may cancel \param[in] warning may be empty
 * \throws pcl::cosection::Error */
CompletedViews completeViews (Settings& settings, const SceneReaders& readers,
                              const pcl::cosection::ProgressCallback& progress, const WarningCallback& warning);

/** \brief The parameters of a run, for its summary. */
nlohmann::ordered_json parametersJson (const Settings& settings);

/** \brief The summary of a run. */
nlohmann::ordered_json summaryJson (const Settings& settings, const CompletedViews& completed);
