// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "class_evidence.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>

namespace pcl::cosection {

void
ClassEvidence::add (const ClassScore& detection)
{
  if (!(detection.score >= 0.0 && detection.score <= 1.0))
    throw InvalidArgument ("the score of a detection must be in [0, 1]; it is " + std::to_string (detection.score));
  ClassScore& sum = sums_.try_emplace (detection.class_id, ClassScore{detection.class_id, detection.class_name, 0.0})
                        .first->second;
  sum.score += detection.score;
  ++detections_;
}

void
ClassEvidence::add (const ClassEvidence& other)
{
  for (const auto& [class_id, sum] : other.sums_)
    sums_.try_emplace (class_id, ClassScore{class_id, sum.class_name, 0.0}).first->second.score += sum.score;
  detections_ += other.detections_;
}

std::optional<ClassScore>
ClassEvidence::best () const
{
  if (detections_ == 0)
    return std::nullopt;
  ClassScore best = std::max_element (sums_.begin (), sums_.end (), [] (const auto& a, const auto& b) {
                      return a.second.score < b.second.score;
                    })->second;
  best.score /= static_cast<double> (detections_);
  return best;
}

} // namespace pcl::cosection
