// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "opencv_network.h"

#include "onnx_rewriting.h"

#include <pcl/cosection/common/error.h>

namespace pcl::cosection {
namespace {

constexpr std::size_t longest_reason = 200;
constexpr int input_dimensions = 4; // one, channels, height, width
const char* const tensorflow_detections = "detection_out_final";
const char* const tensorflow_masks = "detection_masks";

/** \brief What went wrong, in one line. */
std::string
reason (const std::string& text)
{
  std::string line;
  for (const char c : text)
    if (c > ' ')
      line += c;
    else if (!line.empty () && line.back () != ' ')
      line += ' ';
  return (line.size () > longest_reason ? line.substr (0, longest_reason) + " ..." : line);
}

/** \brief What \a work gives. \throws IoError what went wrong in OpenCV, in one line */
template <typename Work>
auto
withReasons (const Work& work)
{
  try
  {
    return (work ());
  }
  catch (const cv::Exception& error)
  {
    throw IoError (reason (error.err));
  }
  catch (const std::exception& error)
  {
    throw IoError (reason (error.what ()));
  }
}

cv::dnn::Net
readNetwork (const InstanceDetectorOptions& options, const std::string& model, const std::string& config)
{
  cv::dnn::Net net = endsIn (options.model, ".onnx") ? cv::dnn::readNetFromONNX (model.data (), model.size ())
                                                     : cv::dnn::readNetFromTensorflow (model.data (), model.size (),
                                                                                       config.data (), config.size ());
  net.setPreferableBackend (cv::dnn::DNN_BACKEND_OPENCV);
  net.setPreferableTarget (cv::dnn::DNN_TARGET_CPU);
  return (net);
}

NetworkOutput
toOutput (const std::string& name, const cv::Mat& mat)
{
  cv::Mat values;
  mat.convertTo (values, CV_32F);
  NetworkOutput output;
  output.name = name;
  output.shape.assign (mat.size.p, mat.size.p + mat.dims);
  output.values.assign (values.ptr<float> (), values.ptr<float> () + values.total ());
  return (output);
}

} // namespace

bool
endsIn (const std::string& path, const std::string& ending)
{
  return (path.size () > ending.size () && path.compare (path.size () - ending.size (), ending.size (), ending) == 0);
}

OpenCvNetwork::OpenCvNetwork (const InstanceDetectorOptions& options, const std::string& model,
                              const std::string& config)
    : options_ (options)
{
  if (endsIn (options.model, ".onnx"))
    if (auto names = outputsOfOpenInput (model, input_dimensions))
    {
      if (names->empty ())
        throw IoError ("it has no output");
      open_model_ = model;
      output_names_ = std::move (*names);
      return;
    }
  read (model, config);
}

void
OpenCvNetwork::read (const std::string& model, const std::string& config)
{
  withReasons ([&] {
    net_ = readNetwork (options_, model, config);
    const bool of_tensorflow = net_.getLayerId (tensorflow_detections) >= 0 && net_.getLayerId (tensorflow_masks) >= 0;
    output_names_ = of_tensorflow ? std::vector<std::string>{tensorflow_detections, tensorflow_masks}
                                  : net_.getUnconnectedOutLayersNames ();
  });
}

std::vector<NetworkOutput>
OpenCvNetwork::run (const cv::Mat& input)
{
  const std::vector<int> shape (input.size.p, input.size.p + input.dims);
  return (withReasons ([&] {
    if (shape != shape_)
    {
      shape_.clear ();
      if (!open_model_.empty ())
        read (withInputShape (open_model_, shape), "");
      checkChannels (shape);
    }
    shape_ = shape;
    net_.setInput (input);
    std::vector<cv::Mat> mats;
    net_.forward (mats, output_names_);
    std::vector<NetworkOutput> outputs;
    for (std::size_t n = 0; n < mats.size (); ++n)
      outputs.push_back (toOutput (output_names_[n], mats[n]));
    return (outputs);
  }));
}

void
OpenCvNetwork::checkChannels (const std::vector<int>& shape)
{
  std::vector<int> layers;
  std::vector<std::vector<cv::dnn::MatShape>> inputs, outputs;
  net_.getLayersShapes (shape, layers, inputs, outputs);
  for (std::size_t n = 0; n < layers.size (); ++n)
  {
    const cv::Ptr<cv::dnn::Layer> layer = net_.getLayer (layers[n]);
    if (layer->type != "BatchNorm" || inputs[n].empty () || inputs[n][0].size () < 2)
      continue;
    const int channels = inputs[n][0][1];
    for (const cv::Mat& blob : layer->blobs)
      if (blob.total () < static_cast<std::size_t> (channels))
        throw IoError ("layer " + layer->name + " has " + std::to_string (blob.total ()) + " values for " +
                       std::to_string (channels) + " channels");
  }
}

} // namespace pcl::cosection
