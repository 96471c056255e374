// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/segmentation/instance_detector.h>

#include "network_process.h"
#include "onnx_check.h"
#include "opencv_network.h"
#include "opencv_settings.h"

#include "pcl_cosection/common/files.h"
#include "pcl_cosection/common/process_setting.h"

#include <pcl/cosection/common/error.h>

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>

namespace pcl::cosection {
namespace {

constexpr int one_stage_input = 640; ///< edge, pixels
constexpr std::uint8_t margin = 114; ///< grey, as YOLO's are trained with
const char* const tensorflow_detections = "detection_out_final";

NetworkProcess
readNetwork (const std::string& model, const InstanceDetectorOptions& options)
{
  const std::string config = options.config.empty () ? "" : readBytes (options.config);
  const ProcessSetting<OpenCvSettings> settings (1);
  try
  {
    if (endsIn (options.model, ".onnx"))
      checkOnnx (model);
    return {options, model, config};
  }
  catch (const IoError& error)
  {
    throw IoError (options.model + ": OpenCV cannot read it as a network: " + error.what ());
  }
}

/** \brief The form of the outputs, by their names and their number. */
NetworkOutputForm
expectedForm (const std::vector<std::string>& output_names)
{
  return (output_names.front () == tensorflow_detections ? NetworkOutputForm::DetectionOut
          : output_names.size () == 4                    ? NetworkOutputForm::BoxList
                                                         : NetworkOutputForm::Prototypes);
}

/** \brief The input of the network: 1 x 3 x height x width. */
cv::Mat
makeInput (const Picture& picture, const ImagePlacement& placement, const InstanceDetectorOptions& options,
           double scale)
{
  const cv::Mat image (picture.height, picture.width, CV_8UC3,
                       const_cast<std::uint8_t*> (picture.pixels.front ().data ()));
  cv::Mat placed (placement.input_height, placement.input_width, CV_8UC3, cv::Scalar::all (margin));
  cv::Mat inside = placed (cv::Rect (placement.left, placement.top, placement.width, placement.height));
  cv::resize (image, inside, inside.size (), 0.0, 0.0, cv::INTER_LINEAR);
  cv::Mat input ({1, 3, placed.rows, placed.cols}, CV_32F);
  for (int channel = 0; channel < 3; ++channel)
  {
    const int colour = options.blue_first ? 2 - channel : channel;
    for (int v = 0; v < placed.rows; ++v)
    {
      const auto* const from = placed.ptr<cv::Vec3b> (v);
      std::transform (from, from + placed.cols, input.ptr<float> (0, channel, v), [&] (const cv::Vec3b& c) {
        return (static_cast<float> (scale * (c[colour] - options.mean[static_cast<std::size_t> (colour)])));
      });
    }
  }
  return (input);
}

} // namespace

struct InstanceDetector::Network
{
  explicit Network (const InstanceDetectorOptions& options)
      : options (options)
      , process (readNetwork (readBytes (options.model), options))
  {}

  InstanceDetectorOptions options;
  NetworkProcess process;
};

void
InstanceDetectorOptions::validate () const
{
  if (!endsIn (model, ".onnx") && !endsIn (model, ".pb"))
    throw InvalidArgument ("the model is \"" + model +
                           "\"; it must be an ONNX file (.onnx) or a frozen graph of TensorFlow (.pb)");
  if (!config.empty () && !endsIn (model, ".pb"))
    throw InvalidArgument (config + ": a text graph goes with a graph of TensorFlow (.pb) only");
  constexpr int largest = 8192;
  if (input_width < 0 || input_height < 0 || input_width > largest || input_height > largest ||
      (input_width == 0) != (input_height == 0))
    throw InvalidArgument ("the input of a network must have 1 to " + std::to_string (largest) +
                           " pixels in both directions");
  if (scale && !(std::isfinite (*scale) && *scale > 0.0))
    throw InvalidArgument ("scale must be positive");
  if (!std::all_of (mean.begin (), mean.end (), [] (double m) { return (std::isfinite (m)); }))
    throw InvalidArgument ("mean must be finite");
  if (threads < 1)
    throw InvalidArgument ("threads must be positive");
  detection.validate ();
}

InstanceDetector::InstanceDetector (const InstanceDetectorOptions& options)
{
  options.validate ();
  network_ = std::make_unique<Network> (options);
  if (network_->process.outputNames ().empty ())
    throw IoError (options.model + ": the network has no outputs");
}

InstanceDetector::InstanceDetector (InstanceDetector&&) noexcept = default;

InstanceDetector& InstanceDetector::operator= (InstanceDetector&&) noexcept = default;

InstanceDetector::~InstanceDetector () = default;

const InstanceDetectorOptions&
InstanceDetector::options () const
{
  return (network_->options);
}

std::vector<DetectedInstance>
InstanceDetector::detect (const Picture& picture)
{
  if (picture.pixels.empty ())
    throw InvalidArgument ("a picture without pixels shows nothing");
  const InstanceDetectorOptions& options = network_->options;
  const NetworkOutputForm form = expectedForm (network_->process.outputNames ());
  const bool one_stage = form == NetworkOutputForm::Prototypes;
  const bool has_size = options.input_width > 0;
  const int width = has_size ? options.input_width : one_stage ? one_stage_input : picture.width;
  const int height = has_size ? options.input_height : one_stage ? one_stage_input : picture.height;
  const ImagePlacement placement (picture.width, picture.height, width, height, options.letterbox.value_or (one_stage));
  const char* const hint = has_size ? "" : "; if it is made for another size, give --input-size W,H";
  const double scale = options.scale.value_or (form == NetworkOutputForm::DetectionOut ? 1.0 : 1.0 / 255.0);

  std::vector<NetworkOutput> outputs;
  try
  {
    const ProcessSetting<OpenCvSettings> settings (options.threads);
    outputs = network_->process.run (makeInput (picture, placement, options, scale));
  }
  catch (const IoError& error)
  {
    throw IoError (options.model + ": the network cannot be run on an input of " +
                   std::to_string (placement.input_width) + " x " + std::to_string (placement.input_height) +
                   " pixels: " + error.what () + hint);
  }
  try
  {
    return (decodeInstances (outputs, placement, options.detection));
  }
  catch (const InvalidArgument& error)
  {
    throw IoError (options.model + ": " + error.what () + hint);
  }
}

} // namespace pcl::cosection
