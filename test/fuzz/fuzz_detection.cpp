// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Bytes as class names and as the outputs of a network: a list of names, a line "%%", a line for each output (its name
// and its shape), an empty line, and the values as they stand in memory.

#include "fuzz_target.h"
#include "memory_file.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/segmentation/instance_detector.h>

#include <algorithm>
#include <cstring>
#include <sstream>

using namespace pcl::cosection;

namespace {

constexpr int width = 40, height = 30;
constexpr std::size_t most_values = 1 << 16;

std::string
written (const std::string& names, const std::string& shapes, const std::vector<float>& values)
{
  std::string bytes (sizeof (float) * values.size (), '\0');
  std::memcpy (bytes.data (), values.data (), bytes.size ());
  return (names + "%%\n" + shapes + "\n" + bytes);
}

/** \brief The outputs; where the values end, they begin again. */
std::vector<NetworkOutput>
parseOutputs (const std::string& text)
{
  std::vector<NetworkOutput> outputs;
  std::istringstream in (text);
  for (std::string line; std::getline (in, line) && !line.empty () && outputs.size () < 5;)
  {
    std::istringstream words (line);
    NetworkOutput output;
    words >> output.name;
    for (int size = 0; words >> size;)
      output.shape.push_back (size);
    outputs.push_back (std::move (output));
  }
  const auto begin = in.good () ? static_cast<std::size_t> (in.tellg ()) : text.size ();
  std::vector<float> values ((text.size () - begin) / sizeof (float));
  if (!values.empty ())
    std::memcpy (values.data (), text.data () + begin, sizeof (float) * values.size ());
  for (NetworkOutput& output : outputs)
  {
    double count = 1.0;
    for (const int size : output.shape)
      count *= size;
    if (count >= 0.0 && count <= static_cast<double> (most_values))
      output.values.resize (static_cast<std::size_t> (count));
    for (std::size_t n = 0; n < output.values.size () && !values.empty (); ++n)
      output.values[n] = values[n % values.size ()];
  }
  return (outputs);
}

void
check (const std::vector<DetectedInstance>& instances, const InstanceDecodingOptions& options)
{
  fuzz::require (instances.size () <= static_cast<std::size_t> (options.max_instances), "instances are not too many");
  for (std::size_t n = 0; n < instances.size (); ++n)
  {
    const DetectedInstance& instance = instances[n];
    fuzz::require (instance.score >= options.score_threshold && instance.score <= 1.0f, "scores are in their range");
    fuzz::require (n == 0 || instances[n - 1].score >= instance.score, "scores descend");
    fuzz::require (!instance.class_name.empty (), "classes have a name");
    fuzz::require (instance.left >= 0 && instance.top >= 0 && instance.left + instance.mask.width <= width &&
                       instance.top + instance.mask.height <= height,
                   "masks are in the image");
    fuzz::require (std::count (instance.mask.pixels.begin (), instance.mask.pixels.end (), 1) > 0, "masks have pixels");
  }
  const InstanceLabels labelled = labelInstances (instances, width, height, {{}, {"1"}, {"2"}});
  for (const std::uint16_t label : labelled.labels.pixels)
    fuzz::require (label <= labelled.instances.size () || label == ignored_label, "labels are those of instances");
}

} // namespace

std::vector<std::string>
fuzz::seeds ()
{
  const std::vector<float> detections = {0, 1, 0.9f, 0.1f, 0.2f, 0.6f, 0.7f, 0, 0, 0.8f, 0.5f, 0.5f, 1, 1};
  return {written ("person\ncup\ntable\n", "detection_out_final 1 1 2 7\ndetection_masks 2 3 4 4\n", detections),
          written ("__background__\ncup\r\n", "boxes 2 4\nlabels 2\nscores 2\nmasks 2 1 3 3\n", {1, 0.75f, 20, 30}),
          written ("cup\n", "output0 1 7 30\noutput1 1 2 6 8\n", {20, 15, 10, 0.75f}),
          written ("cup\n", "output1 1 2 6 8\noutput0 1 30 8\n", {20, 15, 10, 8, 0.75f, 0.9f, 1, -1})};
}

std::vector<std::string>
fuzz::dictionary ()
{
  return {"\n",
          "%%\n",
          "1 ",
          "0 ",
          "-1 ",
          "7",
          "2147483647",
          "boxes",
          "labels",
          "scores",
          std::string ("\0\0\xc0\x7f", 4),
          std::string ("\0\0\x80\x7f", 4),
          std::string ("\0\0\x80\xff", 4),
          std::string ("\0\0\x80\x3f", 4),
          "\xff\xff\x7f\x7f"};
}

bool
fuzz::accepts (const std::string& input)
{
  const std::size_t names_end = std::min (input.find ("%%\n"), input.size ());
  static MemoryFile file;
  file.set (input.substr (0, names_end));
  try
  {
    InstanceDecodingOptions options;
    options.class_names = loadClassNames (file.path ());
    const std::vector<NetworkOutput> outputs = parseOutputs (names_end == input.size () ? ""
                                                                                        : input.substr (names_end + 3));
    for (const bool letterbox : {false, true})
      check (decodeInstances (outputs, ImagePlacement (width, height, 32, 32, letterbox), options), options);
  }
  catch (const Error& error)
  {
    requireMessage (error.what ());
    return (false);
  }
  return (true);
}
