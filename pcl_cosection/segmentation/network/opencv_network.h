// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/segmentation/instance_detector.h>

#include <opencv2/dnn.hpp>

#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief Whether a path ends in an extension that something stands before. */
bool endsIn (const std::string& path, const std::string& ending);

/** \brief A network in OpenCV. Its importers believe much of what a file says, and crash if that is wrong. */
class OpenCvNetwork
{
public:
  /** \brief Read a network. An ONNX file that leaves the size of its input open is read when the first input comes, and
   * again for each other size. \param[in] options say of which form the model is \param[in] model, config contents of
   * the files \throws IoError why it cannot be read */
  OpenCvNetwork (const InstanceDetectorOptions& options, const std::string& model, const std::string& config);

  /** \brief The outputs that run () gives; in OpenCV, a layer that another one uses is not an output by itself. Until
   * an open file has been read, those that it names. */
  const std::vector<std::string>& outputNames () const { return (output_names_); }

  /** \brief The outputs for an input of 1 x channels x height x width values. \throws IoError why there are none */
  std::vector<NetworkOutput> run (const cv::Mat& input);

private:
  void read (const std::string& model, const std::string& config);

  /** \brief Where OpenCV does not look whether there are as many values as channels. \throws IoError if not */
  void checkChannels (const std::vector<int>& shape);

  cv::dnn::Net net_;
  InstanceDetectorOptions options_;
  std::string open_model_; ///< the file, if it leaves the size of its input open; otherwise empty
  std::vector<int> shape_; ///< of the last input
  std::vector<std::string> output_names_;
};

} // namespace pcl::cosection
