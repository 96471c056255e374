// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/segmentation/instance_detector.h>

#include "output_reader.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace pcl::cosection {
namespace {

constexpr std::size_t most_candidates = 1000; ///< most that are compared with each other
constexpr float most_classes = 1e6f;

/** \brief "scores [100], masks [100 x 1 x 28 x 28]" */
std::string
describe (const std::vector<NetworkOutput>& outputs)
{
  std::ostringstream text;
  for (const NetworkOutput& output : outputs)
  {
    text << (&output == outputs.data () ? "" : ", ") << output.name << " [";
    for (std::size_t n = 0; n < output.shape.size (); ++n)
      text << (n == 0 ? "" : " x ") << output.shape[n];
    text << ']';
  }
  return (outputs.empty () ? "there are none" : text.str ());
}

bool
hasItsValues (const NetworkOutput& output)
{
  double count = 1.0;
  for (const int size : output.shape)
    count *= size;
  return (count == static_cast<double> (output.values.size ()) &&
          std::none_of (output.shape.begin (), output.shape.end (), [] (int size) { return (size < 0); }));
}

/** \brief Non-maximum suppression: keeps the first of overlapping boxes of a class. */
std::vector<Candidate>
withoutDuplicates (const std::vector<Candidate>& sorted, double overlap_threshold)
{
  std::vector<Candidate> kept;
  for (const Candidate& candidate : sorted)
    if (std::none_of (kept.begin (), kept.end (), [&] (const Candidate& other) {
          return (other.class_id == candidate.class_id &&
                  other.box.intersectionOverUnion (candidate.box) > overlap_threshold);
        }))
      kept.push_back (candidate);
  return (kept);
}

struct Reading
{
  NetworkOutputForm form;
  std::unique_ptr<OutputReader> reader;
};

Reading
readOutputs (const std::vector<NetworkOutput>& outputs, const ImagePlacement& placement)
{
  if (std::all_of (outputs.begin (), outputs.end (), hasItsValues))
  {
    if (auto reader = readDetectionOut (outputs, placement))
      return {NetworkOutputForm::DetectionOut, std::move (reader)};
    if (auto reader = readPrototypes (outputs, placement))
      return {NetworkOutputForm::Prototypes, std::move (reader)};
    if (auto reader = readBoxList (outputs, placement))
      return {NetworkOutputForm::BoxList, std::move (reader)};
  }
  throw InvalidArgument ("the outputs are those of no known instance segmentation: " + describe (outputs) +
                         "; they should be [1 x 1 x N x 7] and masks [N x C x h x w] (Mask R-CNN), or boxes [N x 4], "
                         "labels [N], scores [N] "
                         "and masks [N x 1 x h x w], or [1 x 4+C+K x A] and prototypes [1 x K x h x w] (YOLO)");
}

} // namespace

void
InstanceDecodingOptions::validate () const
{
  const auto requireShare = [] (double value, const char* name) {
    if (!(value >= 0.0 && value <= 1.0))
      throw InvalidArgument (std::string (name) + " must be in [0, 1]");
  };
  requireShare (score_threshold, "score_threshold");
  requireShare (mask_threshold, "mask_threshold");
  requireShare (overlap_threshold, "overlap_threshold");
  if (max_instances < 1)
    throw InvalidArgument ("max_instances must be positive");
}

ImagePlacement::ImagePlacement (int image_width, int image_height, int input_width, int input_height, bool letterbox)
    : image_width (image_width)
    , image_height (image_height)
    , input_width (input_width)
    , input_height (input_height)
    , width (input_width)
    , height (input_height)
{
  if (image_width < 1 || image_height < 1 || input_width < 1 || input_height < 1)
    throw InvalidArgument ("an image and a network's input must have pixels");
  if (!letterbox)
    return;
  const double scale = std::min (static_cast<double> (input_width) / image_width,
                                 static_cast<double> (input_height) / image_height);
  width = std::max (1, static_cast<int> (std::lround (scale * image_width)));
  height = std::max (1, static_cast<int> (std::lround (scale * image_height)));
  left = (input_width - width) / 2;
  top = (input_height - height) / 2;
}

std::optional<Candidate>
makeCandidate (std::size_t index, float class_id, float score, const Rectangle& box, const ImagePlacement& placement,
               const InstanceDecodingOptions& options)
{
  if (!(score > 0.0f && score >= options.score_threshold && std::isfinite (score)) ||
      !(class_id >= 0.0f && class_id < most_classes))
    return (std::nullopt);
  const Candidate candidate = {index, static_cast<int> (std::lround (class_id)), std::min (score, 1.0f),
                               toImage (box, placement)};
  if (!candidate.box.isProper ())
    return (std::nullopt);
  return (candidate);
}

NetworkOutputForm
outputForm (const std::vector<NetworkOutput>& outputs)
{
  return (readOutputs (outputs, ImagePlacement (1, 1, 1, 1, false)).form);
}

std::vector<DetectedInstance>
decodeInstances (const std::vector<NetworkOutput>& outputs, const ImagePlacement& placement,
                 const InstanceDecodingOptions& options)
{
  options.validate ();
  const std::unique_ptr<OutputReader> reader = readOutputs (outputs, placement).reader;
  std::vector<Candidate> candidates = reader->candidates (options);
  std::sort (candidates.begin (), candidates.end (), [] (const Candidate& a, const Candidate& b) {
    return (a.score != b.score ? a.score > b.score : a.index < b.index);
  });
  if (reader->hasDuplicates ())
  {
    candidates.resize (std::min (candidates.size (), most_candidates), {});
    candidates = withoutDuplicates (candidates, options.overlap_threshold);
  }

  std::vector<DetectedInstance> instances;
  for (const Candidate& candidate : candidates)
  {
    if (instances.size () == static_cast<std::size_t> (options.max_instances))
      break;
    DetectedInstance instance;
    instance.class_id = candidate.class_id;
    instance.score = candidate.score;
    const auto id = static_cast<std::size_t> (candidate.class_id);
    const bool named = id < options.class_names.size () && !options.class_names[id].empty ();
    instance.class_name = named ? options.class_names[id] : std::to_string (id);
    pasteMask (reader->mask (candidate), candidate.box, placement, options.mask_threshold, instance);
    const std::vector<std::uint8_t>& pixels = instance.mask.pixels;
    if (std::find (pixels.begin (), pixels.end (), 1) != pixels.end ())
      instances.push_back (std::move (instance));
  }
  return (instances);
}

} // namespace pcl::cosection
