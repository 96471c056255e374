// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/segmentation/instance_detector.h>

#include "output_reader.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>

namespace pcl::cosection {
namespace {

constexpr std::size_t most_candidates = 1000; ///< most that are compared with each other

double
intersectionOverUnion (const Rectangle& a, const Rectangle& b)
{
  const double width = std::min (a.right, b.right) - std::max (a.left, b.left);
  const double height = std::min (a.bottom, b.bottom) - std::max (a.top, b.top);
  if (width <= 0.0 || height <= 0.0)
    return (0.0);
  const double both = width * height;
  return (both / ((a.right - a.left) * (a.bottom - a.top) + (b.right - b.left) * (b.bottom - b.top) - both));
}

/** \brief Non-maximum suppression: keeps the first of overlapping boxes of a class. */
std::vector<Candidate>
withoutDuplicates (const std::vector<Candidate>& sorted, double overlap_threshold)
{
  std::vector<Candidate> kept;
  for (const Candidate& candidate : sorted)
    if (std::none_of (kept.begin (), kept.end (), [&] (const Candidate& other) {
          return (other.class_id == candidate.class_id &&
                  intersectionOverUnion (other.box, candidate.box) > overlap_threshold);
        }))
      kept.push_back (candidate);
  return (kept);
}

/** \brief First pixel whose middle is at or beyond \a edge, from 0 to \a size. */
int
firstPixel (double edge, int size)
{
  return (static_cast<int> (std::clamp (std::ceil (edge - 0.5), 0.0, static_cast<double> (size))));
}

/** \brief Two cells and how much of the second, for the middle of a pixel. */
struct Interpolation
{
  int first, second;
  float share;
};

Interpolation
interpolation (int pixel, double covered_from, double covered_to, int cells)
{
  const double at = (pixel + 0.5 - covered_from) / (covered_to - covered_from) * cells - 0.5;
  const double inside = std::clamp (at, 0.0, static_cast<double> (cells - 1));
  const int first = static_cast<int> (inside);
  return {first, std::min (first + 1, cells - 1), static_cast<float> (inside - first)};
}

float
mix (float first, float second, float share)
{
  return (first + share * (second - first));
}

/** \brief Set the mask of an instance: pixels in \a box whose probability, interpolated between the middles of cells,
 * reaches the threshold. The mask is empty if the box is not in the image. */
void
pasteMask (const SoftMask& soft, const Rectangle& box, const ImagePlacement& placement, double threshold,
           DetectedInstance& instance)
{
  instance.left = firstPixel (box.left, placement.image_width);
  instance.top = firstPixel (box.top, placement.image_height);
  const int width = firstPixel (box.right, placement.image_width) - instance.left;
  const int height = firstPixel (box.bottom, placement.image_height) - instance.top;
  const Image<float>& p = soft.probabilities;
  if (width <= 0 || height <= 0 || p.pixels.empty ())
    return;
  instance.mask = Image<std::uint8_t> (width, height, 0);
  std::vector<Interpolation> columns;
  for (int u = 0; u < width; ++u)
    columns.push_back (interpolation (instance.left + u, soft.covered.left, soft.covered.right, p.width));
  for (int v = 0; v < height; ++v)
  {
    const Interpolation row = interpolation (instance.top + v, soft.covered.top, soft.covered.bottom, p.height);
    for (int u = 0; u < width; ++u)
    {
      const Interpolation& column = columns[u];
      const float above = mix (p.at (column.first, row.first), p.at (column.second, row.first), column.share);
      const float below = mix (p.at (column.first, row.second), p.at (column.second, row.second), column.share);
      instance.mask.at (u, v) = mix (above, below, row.share) >= threshold ? 1 : 0;
    }
  }
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

NetworkOutputForm
outputForm (const std::vector<NetworkOutput>& outputs)
{
  return (readOutputs (outputs, ImagePlacement (1, 1, 1, 1, false))->form);
}

std::vector<DetectedInstance>
decodeInstances (const std::vector<NetworkOutput>& outputs, const ImagePlacement& placement,
                 const InstanceDecodingOptions& options)
{
  options.validate ();
  const std::unique_ptr<OutputReader> reader = readOutputs (outputs, placement);
  std::vector<Candidate> candidates = reader->candidates (options);
  std::sort (candidates.begin (), candidates.end (), [] (const Candidate& a, const Candidate& b) {
    return (a.score != b.score ? a.score > b.score : a.index < b.index);
  });
  if (reader->form == NetworkOutputForm::Prototypes) // of which several may be of one thing
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
