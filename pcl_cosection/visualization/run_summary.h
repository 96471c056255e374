// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/evaluation/run_evaluation.h>
#include <pcl/cosection/io/rgbd_sequence.h>

#include <map>
#include <optional>
#include <string>

namespace pcl::cosection {

/** \brief What a run's summary.json says of its images. */
struct RunSummary
{
  bool is_there = false;
  std::string error;   ///< why the run failed; empty: it did not
  std::string dataset; ///< that it has read
  SequenceSource source;
  std::optional<PinholeCamera> camera;
  std::map<int, std::string> classes; ///< of objects, by their numbers
};

/** \brief Read summary.json. What is missing in it, as in those of earlier versions, stays empty. \param[out] notes if
 * it cannot be read */
RunSummary readRunSummary (const std::string& folder, ReadingNotes& notes);

} // namespace pcl::cosection
