// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>
#include <opencv2/core/utils/logger.hpp>

#include <utility>

namespace pcl::cosection {

/** \brief OpenCV's number of threads, and no messages of it: for ProcessSetting. */
struct OpenCvSettings
{
  using Value = std::pair<cv::utils::logging::LogLevel, int>;

  static Value change (int threads)
  {
    const Value before (cv::utils::logging::setLogLevel (cv::utils::logging::LOG_LEVEL_SILENT), cv::getNumThreads ());
    cv::setNumThreads (threads);
    return before;
  }

  static void restore (const Value& before)
  {
    cv::setNumThreads (before.second);
    cv::utils::logging::setLogLevel (before.first);
  }
};

} // namespace pcl::cosection
