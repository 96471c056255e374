// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "network_options.h"

#include "option_values.h"

#include <nlohmann/json.hpp>

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>

using namespace pcl::cosection;

namespace {

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
  OptionGroup network (app, "Network");
  const auto addList = [&] (const std::string& form, std::vector<std::string>& values, const std::string& description) {
    network.add (form, values, description)->delimiter (',');
  };
  network.add ("--model FILE", given.model,
               "Instance segmentation network: ONNX, or a frozen graph of TensorFlow (.pb)");
  network.add ("--model-config FILE", given.model_config, "Text graph of a .pb (.pbtxt)");
  network.add ("--class-names FILE", given.class_names, "Names of the classes, one in each line");
  addList ("--classes A,B,...", given.classes, "Only these become objects, by name or number (default: all)");
  addList ("--static-classes A,B,...", given.static_classes, "These are background: tables, screens");
  addList ("--ignore A,B,...", given.ignored_classes, "These are neither objects nor background: people");
  network.add ("--score SCORE", given.score, numberRange (0.0, 1.0),
               "What has a lower score is not there" +
                   byDefault (InstanceDetectorOptions ().detection.score_threshold));
  addList ("--input-size W,H", given.input_size,
           "Pixels that the network takes (default: YOLO: 640,640, others: the image's)");
  network.add ("--input-fit stretch|letterbox", given.input_fit,
               "How an image fills them (default: stretch; YOLO: letterbox)");
  network.add ("--input-scale FACTOR", given.input_scale, positiveNumber (),
               "Multiplies colours (default: 1/255; TensorFlow: 1)");
  addList ("--input-mean R,G,B", given.input_mean, "Subtracted from colours before (default: 0,0,0)");
  network.add ("--input-order rgb|bgr", given.input_order, "Order of the colours (default: rgb)");
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
  network.validate ();
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

std::string
classText (int class_id, const std::string& class_name, double score)
{
  std::ostringstream text;
  text << (class_name == std::to_string (class_id) ? "class " : "") << class_name << ", score " << std::setprecision (2)
       << score;
  return (text.str ());
}

nlohmann::ordered_json
classJson (int class_id, const std::string& class_name, double score)
{
  return {{"class", class_name}, {"class_id", class_id}, {"score", std::round (1e4 * score) / 1e4}};
}
