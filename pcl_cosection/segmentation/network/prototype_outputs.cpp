// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "output_reader.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>

namespace pcl::cosection {
namespace {

constexpr std::size_t box_values = 4;

class Prototypes : public OutputReader
{
public:
  Prototypes (const NetworkOutput& proposals, const NetworkOutput& prototypes, const ImagePlacement& placement)
      : proposals_ (proposals)
      , prototypes_ (prototypes)
      , placement_ (placement)
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

  bool hasDuplicates () const override { return (true); }

private:
  float value (std::size_t candidate, std::size_t n) const
  {
    return (proposals_.values[in_rows_ ? candidate * length_ + n : n * count_ + candidate]);
  }

  const NetworkOutput& proposals_;
  const NetworkOutput& prototypes_;
  const ImagePlacement placement_;
  const bool in_rows_; ///< YOLOv5: a candidate's values stand together, and one of them says whether it is a thing
  std::size_t coefficients_, length_, count_, first_class_;
};

} // namespace

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

} // namespace pcl::cosection
