// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "output_reader.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

namespace pcl::cosection {
namespace {

constexpr float most_classes = 1e6f;
constexpr std::size_t box_values = 4;

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

/** \brief From pixels of the input to those of the image. */
Rectangle
toImage (const Rectangle& in_input, const ImagePlacement& placement)
{
  const double x = static_cast<double> (placement.image_width) / placement.width;
  const double y = static_cast<double> (placement.image_height) / placement.height;
  return {(in_input.left - placement.left) * x, (in_input.top - placement.top) * y,
          (in_input.right - placement.left) * x, (in_input.bottom - placement.top) * y};
}

/** \brief A candidate with these values, if its score is sufficient and its box proper. \param[in] box in the input */
std::optional<Candidate>
makeCandidate (std::size_t index, float class_id, float score, const Rectangle& box, const ImagePlacement& placement,
               const InstanceDecodingOptions& options)
{
  if (!(score > 0.0f && score >= options.score_threshold && std::isfinite (score)) ||
      !(class_id >= 0.0f && class_id < most_classes))
    return (std::nullopt);
  const Rectangle placed = toImage (box, placement);
  if (!std::isfinite (placed.left) || !std::isfinite (placed.top) || !std::isfinite (placed.right) ||
      !std::isfinite (placed.bottom) || placed.left >= placed.right || placed.top >= placed.bottom)
    return (std::nullopt);
  return (Candidate{index, static_cast<int> (std::lround (class_id)), std::min (score, 1.0f), placed});
}

/** \brief One of many masks of the same size that stand one after the other. */
Image<float>
maskOf (const NetworkOutput& masks, std::size_t number)
{
  const std::size_t dims = masks.shape.size ();
  Image<float> mask (masks.shape[dims - 1], masks.shape[dims - 2]);
  std::copy_n (masks.values.begin () + static_cast<std::ptrdiff_t> (number * mask.pixels.size ()), mask.pixels.size (),
               mask.pixels.begin ());
  return (mask);
}

class DetectionOut : public OutputReader
{
public:
  DetectionOut (const NetworkOutput& detections, const NetworkOutput& masks, const ImagePlacement& placement)
      : OutputReader (NetworkOutputForm::DetectionOut, placement)
      , detections_ (detections)
      , masks_ (masks)
  {}

  std::vector<Candidate> candidates (const InstanceDecodingOptions& options) const override
  {
    std::vector<Candidate> candidates;
    const double width = placement_.input_width, height = placement_.input_height;
    const int classes = masks_.shape[1];
    for (std::size_t n = 0; n < static_cast<std::size_t> (detections_.shape[2]); ++n)
    {
      const float* const row = &detections_.values[7 * n]; // image, class, score, left, top, right, bottom
      const auto candidate = makeCandidate (
          n, row[1], row[2], {row[3] * width, row[4] * height, row[5] * width, row[6] * height}, placement_, options);
      if (candidate && (classes == 1 || candidate->class_id < classes))
        candidates.push_back (*candidate);
    }
    return (candidates);
  }

  SoftMask mask (const Candidate& candidate) const override
  {
    const int classes = masks_.shape[1];
    return {maskOf (masks_, candidate.index * classes + (classes == 1 ? 0 : candidate.class_id)), candidate.box};
  }

private:
  const NetworkOutput& detections_;
  const NetworkOutput& masks_;
};

class BoxList : public OutputReader
{
public:
  BoxList (const NetworkOutput& boxes, const NetworkOutput& labels, const NetworkOutput& scores,
           const NetworkOutput& masks, const ImagePlacement& placement)
      : OutputReader (NetworkOutputForm::BoxList, placement)
      , boxes_ (boxes)
      , labels_ (labels)
      , scores_ (scores)
      , masks_ (masks)
  {}

  std::vector<Candidate> candidates (const InstanceDecodingOptions& options) const override
  {
    std::vector<Candidate> candidates;
    for (std::size_t n = 0; n < scores_.values.size (); ++n)
    {
      const float* const box = &boxes_.values[4 * n];
      if (const auto candidate = makeCandidate (n, labels_.values[n], scores_.values[n],
                                                {box[0], box[1], box[2], box[3]}, placement_, options))
        candidates.push_back (*candidate);
    }
    return (candidates);
  }

  SoftMask mask (const Candidate& candidate) const override
  {
    SoftMask soft{maskOf (masks_, candidate.index), candidate.box};
    const double width = placement_.input_width, height = placement_.input_height;
    if (soft.probabilities.width == placement_.input_width && soft.probabilities.height == placement_.input_height)
      soft.covered = toImage ({0.0, 0.0, width, height}, placement_);
    return (soft);
  }

private:
  const NetworkOutput& boxes_;
  const NetworkOutput& labels_;
  const NetworkOutput& scores_;
  const NetworkOutput& masks_;
};

bool
isNamed (const NetworkOutput& output, const std::string& what)
{
  return (output.name.find (what) != std::string::npos);
}

/** \brief A reader if the outputs are of its form, else null. */
std::unique_ptr<OutputReader>
readDetectionOut (const std::vector<NetworkOutput>& outputs, const ImagePlacement& placement)
{
  if (outputs.size () != 2)
    return (nullptr);
  for (const std::size_t first : {0, 1})
  {
    const std::vector<int>& rows = outputs[first].shape;
    const std::vector<int>& masks = outputs[1 - first].shape;
    if (rows.size () == 4 && masks.size () == 4 && rows[0] == 1 && rows[1] == 1 && rows[3] == 7 &&
        masks[0] >= rows[2] && masks[1] > 0)
      return (std::make_unique<DetectionOut> (outputs[first], outputs[1 - first], placement));
  }
  return (nullptr);
}

std::unique_ptr<OutputReader>
readBoxList (const std::vector<NetworkOutput>& outputs, const ImagePlacement& placement)
{
  const auto masks = std::find_if (outputs.begin (), outputs.end (), [] (const NetworkOutput& output) {
    const std::vector<int>& shape = output.shape;
    return (shape.size () == 3 || (shape.size () == 4 && shape[1] == 1));
  });
  if (outputs.size () != 4 || masks == outputs.end ())
    return (nullptr);
  const auto count = static_cast<std::size_t> (masks->shape[0]);
  const auto boxes = std::find_if (outputs.begin (), outputs.end (), [count] (const NetworkOutput& output) {
    return (output.shape.size () == 2 && output.shape[1] == 4 && output.values.size () == 4 * count);
  });
  std::vector<const NetworkOutput*> numbers;
  for (const NetworkOutput& output : outputs)
    if (&output != &*masks && (boxes == outputs.end () || &output != &*boxes) && output.shape.size () <= 2 &&
        output.values.size () == count)
      numbers.push_back (&output);
  if (boxes == outputs.end () || numbers.size () != 2)
    return (nullptr);
  if (isNamed (*numbers[0], "score") || isNamed (*numbers[1], "label") || isNamed (*numbers[1], "class"))
    std::swap (numbers[0], numbers[1]);
  return (std::make_unique<BoxList> (*boxes, *numbers[0], *numbers[1], *masks, placement));
}

class Prototypes : public OutputReader
{
public:
  Prototypes (const NetworkOutput& proposals, const NetworkOutput& prototypes, const ImagePlacement& placement)
      : OutputReader (NetworkOutputForm::Prototypes, placement)
      , proposals_ (proposals)
      , prototypes_ (prototypes)
      , in_rows_ (proposals.shape[1] > proposals.shape[2])
  {
    coefficients_ = static_cast<std::size_t> (prototypes.shape[1]);
    length_ = static_cast<std::size_t> (std::min (proposals.shape[1], proposals.shape[2]));
    count_ = static_cast<std::size_t> (std::max (proposals.shape[1], proposals.shape[2]));
    first_class_ = box_values + (in_rows_ ? 1 : 0);
  }

  /** \brief Whether the shapes leave room for a class. */
  bool hasClasses () const { return (length_ > first_class_ + coefficients_); }

  std::vector<Candidate> candidates (const InstanceDecodingOptions& options) const override
  {
    const std::size_t classes = length_ - first_class_ - coefficients_;
    if (!options.class_names.empty () && options.class_names.size () != classes)
      throw InvalidArgument ("the network has " + std::to_string (classes) + " classes, but there are " +
                             std::to_string (options.class_names.size ()) + " class names");
    std::vector<Candidate> candidates;
    for (std::size_t n = 0; n < count_; ++n)
    {
      std::size_t best = 0;
      for (std::size_t c = 1; c < classes; ++c)
        if (value (n, first_class_ + c) > value (n, first_class_ + best))
          best = c;
      const float objectness = in_rows_ ? value (n, box_values) : 1.0f;
      const double x = value (n, 0), y = value (n, 1), half_width = 0.5 * value (n, 2),
                   half_height = 0.5 * value (n, 3);
      if (const auto candidate = makeCandidate (
              n, static_cast<float> (best), objectness * value (n, first_class_ + best),
              {x - half_width, y - half_height, x + half_width, y + half_height}, placement_, options))
        candidates.push_back (*candidate);
    }
    return (candidates);
  }

  SoftMask mask (const Candidate& candidate) const override
  {
    const double width = placement_.input_width, height = placement_.input_height;
    SoftMask soft{Image<float> (prototypes_.shape[3], prototypes_.shape[2], 0.0f),
                  toImage ({0.0, 0.0, width, height}, placement_)};
    std::vector<float>& sums = soft.probabilities.pixels;
    for (std::size_t k = 0; k < coefficients_; ++k)
    {
      const float coefficient = value (candidate.index, length_ - coefficients_ + k);
      const float* const prototype = prototypes_.values.data () + k * sums.size ();
      for (std::size_t i = 0; i < sums.size (); ++i)
        sums[i] += coefficient * prototype[i];
    }
    for (float& sum : sums)
      sum = 1.0f / (1.0f + std::exp (-sum));
    return (soft);
  }

private:
  float value (std::size_t candidate, std::size_t n) const
  {
    return (proposals_.values[in_rows_ ? candidate * length_ + n : n * count_ + candidate]);
  }

  const NetworkOutput& proposals_;
  const NetworkOutput& prototypes_;
  const bool in_rows_; ///< YOLOv5: a candidate's values stand together, and one of them says whether it is a thing
  std::size_t coefficients_, length_, count_, first_class_;
};

std::unique_ptr<OutputReader>
readPrototypes (const std::vector<NetworkOutput>& outputs, const ImagePlacement& placement)
{
  if (outputs.size () != 2)
    return (nullptr);
  for (const std::size_t first : {0, 1})
  {
    const std::vector<int>& proposals = outputs[first].shape;
    const std::vector<int>& prototypes = outputs[1 - first].shape;
    if (proposals.size () != 3 || prototypes.size () != 4 || proposals[0] != 1 || prototypes[0] != 1 ||
        prototypes[1] == 0)
      continue;
    auto reader = std::make_unique<Prototypes> (outputs[first], outputs[1 - first], placement);
    if (reader->hasClasses ())
      return (reader);
  }
  return (nullptr);
}

} // namespace

std::unique_ptr<OutputReader>
readOutputs (const std::vector<NetworkOutput>& outputs, const ImagePlacement& placement)
{
  if (std::all_of (outputs.begin (), outputs.end (), hasItsValues))
  {
    if (auto reader = readDetectionOut (outputs, placement))
      return (reader);
    if (auto reader = readPrototypes (outputs, placement))
      return (reader);
    if (auto reader = readBoxList (outputs, placement))
      return (reader);
  }
  throw InvalidArgument ("the outputs are those of no known instance segmentation: " + describe (outputs) +
                         "; they should be [1 x 1 x N x 7] and masks [N x C x h x w] (Mask R-CNN), or boxes [N x 4], "
                         "labels [N], scores [N] and masks [N x 1 x h x w], or [1 x 4+C+K x A] and prototypes "
                         "[1 x K x h x w] (YOLO)");
}

} // namespace pcl::cosection
