// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/segmentation/network_outputs.h>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace pcl::cosection
{

/** \brief A network, and what it expects. What is not given follows from the form of its outputs:
 *
 * | | Mask R-CNN of TensorFlow | Mask R-CNN of torchvision | YOLO |
 * |---|---|---|---|
 * | input size | the image's | the image's | 640 x 640, letterbox |
 * | values | 0 to 255 | 0 to 1 | 0 to 1 |
 *
 * The first has layers detection_out_final and detection_masks, the second four outputs. */
struct PCL_COSECTION_EXPORT InstanceDetectorOptions
{
  std::string model;             ///< file: .onnx, or a frozen graph of TensorFlow, .pb
  std::string config;            ///< file: the text graph (.pbtxt) that goes with a graph of TensorFlow
  int input_width = 0;           ///< pixels; 0: as above
  int input_height = 0;          ///< pixels; 0: as above
  std::optional<bool> letterbox; ///< keep the image's proportions, with grey margins, instead of stretching it
  std::optional<double> scale;   ///< multiplies values from 0 to 255, once the mean is subtracted
  std::array<double, 3> mean{};  ///< subtracted from red, green and blue
  bool blue_first = false;       ///< the network takes blue, green, red
  int threads = 1;               ///< of the network; with more, its last digits depend on how many
  InstanceDecodingOptions detection;

  /** \brief \throws InvalidArgument naming the first parameter outside its domain. */
  void validate () const;
};

/** \brief Finds things in colour images with an instance segmentation network of the user's, by OpenCV's DNN module on
 * the CPU. NetworkOutputForm says which networks. Those with operators that OpenCV does not have cannot be read;
 * decodeInstances () decodes what other runtimes give for them.
 *
 * \code
 * pcl::cosection::InstanceDetectorOptions options;
 * options.model = "yolov5s-seg.onnx";
 * options.detection.class_names = pcl::cosection::loadClassNames ("coco.names");
 * pcl::cosection::InstanceDetector detector (options);
 * const auto instances = detector.detect (picture);
 * const auto labels = pcl::cosection::labelInstances (instances, picture.width, picture.height).labels;
 * \endcode */
class PCL_COSECTION_EXPORT InstanceDetector
{
public:
  /** \brief Read the network.
   * \throws InvalidArgument if an option is outside its domain \throws IoError naming the file, if it cannot be read as
   * a network */
  explicit InstanceDetector (const InstanceDetectorOptions& options);
  InstanceDetector (InstanceDetector&&) noexcept;
  InstanceDetector& operator= (InstanceDetector&&) noexcept;
  ~InstanceDetector ();

  /** \brief What \a picture shows, highest score first; empty if there is nothing.
   * \throws InvalidArgument if the picture has no pixels \throws IoError naming the model, if it cannot be run on such
   * an input, or is of no known form */
  std::vector<DetectedInstance> detect (const Picture& picture);

  const InstanceDetectorOptions& options () const;

private:
  struct Network;
  std::unique_ptr<Network> network_;
};

} // namespace pcl::cosection
