// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "arguments.h"

#include <nlohmann/json_fwd.hpp>

#include <pcl/cosection/segmentation/instance_detector.h>

#include <optional>
#include <string>
#include <vector>

/** \brief Options about a network, as the user gives them. */
struct GivenNetwork
{
  std::string model, model_config, class_names, input_fit, input_order;
  std::vector<std::string> classes, static_classes, ignored_classes, input_size, input_mean;
  std::optional<double> score, input_scale;
};

/** \brief What the user asked for. */
struct NetworkSettings
{
  pcl::cosection::InstanceDetectorOptions network; ///< without class names
  pcl::cosection::ClassRoles roles;
  std::string class_names; ///< file
};

/** \brief Declare them in the group "Network". */
void declareNetworkOptions (CLI::App& app, GivenNetwork& given);

/** \brief The name of an option that was given; empty if no option was. */
std::string anyNetworkOption (const GivenNetwork& given);

/** \throws UsageError, pcl::cosection::InvalidArgument */
NetworkSettings networkSettings (const GivenNetwork& given);

/** \brief Read the class names, and find out whether they have the classes that were asked for.
 * \throws UsageError, pcl::cosection::IoError */
void readClassNames (NetworkSettings& settings);

/** \brief For summaries: "model", "score", "classes", "static_classes", "ignore". */
nlohmann::ordered_json networkJson (const NetworkSettings& settings);

/** \brief "cup, score 0.92"; "class 41, score 0.92" where a class has no name but its number. */
std::string classText (int class_id, const std::string& class_name, double score);

/** \brief For summaries: "class", "class_id", "score" to four digits. */
nlohmann::ordered_json classJson (int class_id, const std::string& class_name, double score);
