// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "network_options.h"

#include "option_values.h"
#include "suggestion.h"

#include <nlohmann/json.hpp>

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace pcl::cosection;

namespace {

CLI::Option*
addList (CLI::App& app, const std::string& name, std::vector<std::string>& values, const std::string& description)
{
  return (app.add_option (name, values, description)->delimiter (',')->allow_extra_args (false));
}

/** \brief Numbers of an option; \a count of them. */
std::vector<double>
numbersOf (const std::string& option, const std::vector<std::string>& values, std::size_t count, double least,
           const std::string& meaning)
{
  const std::optional<std::vector<double>> numbers = parseNumbers (values);
  if (!numbers || numbers->size () != count ||
      std::any_of (numbers->begin (), numbers->end (), [least] (double number) { return (number < least); }))
    throw UsageError (option + " must be " + meaning);
  return (*numbers);
}

} // namespace

void
declareNetworkOptions (CLI::App& app, GivenNetwork& given)
{
  const InstanceDetectorOptions defaults;
  const std::string group = "Network";
  app.add_option ("--model", given.model, "Instance segmentation network: ONNX, or a frozen graph of TensorFlow (.pb)")
      ->option_text ("FILE")
      ->group (group);
  app.add_option ("--model-config", given.model_config, "Text graph of a .pb (.pbtxt)")
      ->option_text ("FILE")
      ->group (group);
  app.add_option ("--class-names", given.class_names, "Names of the classes, one in each line")
      ->option_text ("FILE")
      ->group (group);
  addList (app, "--classes", given.classes, "Only these become objects, by name or number (default: all)")
      ->option_text ("A,B,...")
      ->group (group);
  addList (app, "--static-classes", given.static_classes, "These are background: tables, screens")
      ->option_text ("A,B,...")
      ->group (group);
  addList (app, "--ignore", given.ignored_classes, "These are neither objects nor background: people")
      ->option_text ("A,B,...")
      ->group (group);
  app.add_option ("--score", given.score,
                  "What has a lower score is not there" + byDefault (defaults.detection.score_threshold))
      ->option_text ("SCORE")
      ->check (numberRange (0.0, 1.0))
      ->group (group);
  addList (app, "--input-size", given.input_size,
           "Pixels that the network takes (default: YOLO: 640,640, others: the image's)")
      ->option_text ("W,H")
      ->group (group);
  app.add_option ("--input-fit", given.input_fit, "How an image fills them (default: stretch; YOLO: letterbox)")
      ->option_text ("stretch|letterbox")
      ->check (oneOf ({"stretch", "letterbox"}))
      ->group (group);
  app.add_option ("--input-scale", given.input_scale, "Multiplies colours (default: 1/255; TensorFlow: 1)")
      ->option_text ("FACTOR")
      ->check (numberRange (0.0, unlimited, true))
      ->group (group);
  addList (app, "--input-mean", given.input_mean, "Subtracted from colours before (default: 0,0,0)")
      ->option_text ("R,G,B")
      ->group (group);
  app.add_option ("--input-order", given.input_order, "Order of the colours (default: rgb)")
      ->option_text ("rgb|bgr")
      ->check (oneOf ({"rgb", "bgr"}))
      ->group (group);
}

std::string
anyNetworkOption (const GivenNetwork& given)
{
  const std::vector<std::pair<std::string, bool>> options = {
      {"--model", !given.model.empty ()},
      {"--model-config", !given.model_config.empty ()},
      {"--class-names", !given.class_names.empty ()},
      {"--classes", !given.classes.empty ()},
      {"--static-classes", !given.static_classes.empty ()},
      {"--ignore", !given.ignored_classes.empty ()},
      {"--score", given.score.has_value ()},
      {"--input-size", !given.input_size.empty ()},
      {"--input-fit", !given.input_fit.empty ()},
      {"--input-scale", given.input_scale.has_value ()},
      {"--input-mean", !given.input_mean.empty ()},
      {"--input-order", !given.input_order.empty ()},
  };
  const auto found = std::find_if (options.begin (), options.end (),
                                   [] (const auto& option) { return (option.second); });
  return (found == options.end () ? "" : found->first);
}

NetworkSettings
networkSettings (const GivenNetwork& given)
{
  NetworkSettings settings;
  InstanceDetectorOptions& network = settings.network;
  network.model = given.model;
  network.config = given.model_config;
  network.detection.score_threshold = given.score.value_or (network.detection.score_threshold);
  if (!given.input_size.empty ())
  {
    const std::vector<double> size = numbersOf ("--input-size", given.input_size, 2, 1.0,
                                                "two numbers of pixels W,H, such as 640,480");
    network.input_width = static_cast<int> (std::min (size[0], 1e6));
    network.input_height = static_cast<int> (std::min (size[1], 1e6));
  }
  if (!given.input_fit.empty ())
    network.letterbox = given.input_fit == "letterbox";
  network.scale = given.input_scale;
  if (!given.input_mean.empty ())
  {
    const double lowest = std::numeric_limits<double>::lowest ();
    const std::vector<double> mean = numbersOf ("--input-mean", given.input_mean, 3, lowest,
                                                "three numbers R,G,B, such as 124,116,104");
    std::copy (mean.begin (), mean.end (), network.mean.begin ());
  }
  network.blue_first = given.input_order == "bgr";
  settings.roles = {given.classes, given.static_classes, given.ignored_classes};
  settings.class_names = given.class_names;
  try
  {
    network.validate ();
  }
  catch (const InvalidArgument& error)
  {
    throw UsageError (error.what ());
  }
  return (settings);
}

void
readClassNames (NetworkSettings& settings)
{
  std::vector<std::string>& names = settings.network.detection.class_names;
  if (!settings.class_names.empty ())
    names = loadClassNames (settings.class_names);
  const ClassRoles& roles = settings.roles;
  std::string hint;
  for (const auto* role : {&roles.objects, &roles.statics, &roles.ignored})
    for (const std::string& word : *role)
      if (hint.empty () && std::find (names.begin (), names.end (), word) == names.end ())
        hint = nearestName (word, names);
  try
  {
    roles.validate (names);
  }
  catch (const InvalidArgument& error)
  {
    throw UsageError (error.what () + (names.empty ()  ? "; give --class-names"
                                       : hint.empty () ? ""
                                                       : "; did you mean " + hint + "?"));
  }
}

nlohmann::ordered_json
networkJson (const NetworkSettings& settings)
{
  return {{"model", settings.network.model},
          {"score", settings.network.detection.score_threshold},
          {"classes", settings.roles.objects},
          {"static_classes", settings.roles.statics},
          {"ignore", settings.roles.ignored}};
}
