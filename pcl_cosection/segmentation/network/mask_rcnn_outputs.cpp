// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "output_reader.h"

#include <algorithm>

namespace pcl::cosection {
namespace {

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
      : detections_ (detections)
      , masks_ (masks)
      , placement_ (placement)
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
  const ImagePlacement placement_;
};

class BoxList : public OutputReader
{
public:
  BoxList (const NetworkOutput& boxes, const NetworkOutput& labels, const NetworkOutput& scores,
           const NetworkOutput& masks, const ImagePlacement& placement)
      : boxes_ (boxes)
      , labels_ (labels)
      , scores_ (scores)
      , masks_ (masks)
      , placement_ (placement)
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
  const ImagePlacement placement_;
};

bool
isNamed (const NetworkOutput& output, const std::string& what)
{
  return (output.name.find (what) != std::string::npos);
}

} // namespace

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

} // namespace pcl::cosection
