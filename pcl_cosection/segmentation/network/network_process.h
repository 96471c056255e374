// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "child_process.h"

#include <pcl/cosection/segmentation/instance_detector.h>

#include <opencv2/core.hpp>

#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief A network that OpenCV reads and runs in a process of its own, so that a damaged one cannot crash this one.
 * The process also ends what takes minutes or most of the machine's memory. */
class NetworkProcess
{
public:
  /** \brief Read a network. OpenCV's messages should be off, and it should have one thread here: a new process does not
   * have the other ones.
   * \param[in] options say of which form the model is, and how many threads run it
   * \param[in] model, config contents of the files \throws IoError why it cannot be read */
  NetworkProcess (const InstanceDetectorOptions& options, const std::string& model, const std::string& config);

  /** \brief The outputs that run () gives. */
  const std::vector<std::string>& outputNames () const { return (output_names_); }

  /** \brief The outputs for an input of 1 x channels x height x width values. \throws IoError why there are none */
  std::vector<NetworkOutput> run (const cv::Mat& input);

private:
  ChildProcess process_;
  std::vector<std::string> output_names_;
};

} // namespace pcl::cosection
