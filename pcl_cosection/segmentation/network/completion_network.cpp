// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/surface/options.h>

#include "network_process.h"
#include "onnx_check.h"
#include "onnx_rewriting.h"
#include "opencv_network.h"
#include "opencv_settings.h"

#include "pcl_cosection/common/files.h"
#include "pcl_cosection/common/process_setting.h"

#include <pcl/cosection/common/error.h>

#include <dlfcn.h>

#include <filesystem>
#include <mutex>
#include <system_error>
#include <vector>

namespace pcl::cosection {
namespace {

constexpr int edge = CompletionNetwork::size;
// From the library or program up to the folder in which it was installed: from the Python module it is
// lib/python3/dist-packages/pcl_cosection.
constexpr int most_levels = 5;

cv::Mat
toMat (const std::vector<float>& observed)
{
  return cv::Mat (std::vector<int>{1, CompletionNetwork::channels * edge, edge, edge}, CV_32F,
                  const_cast<float*> (observed.data ()))
      .clone ();
}

/** \brief The one output. \throws IoError if it is not one of the right size */
std::vector<float>
onlyOutput (std::vector<NetworkOutput> outputs)
{
  if (outputs.size () != 1)
    throw IoError ("it has " + std::to_string (outputs.size ()) + " outputs; a completion has 1");
  const std::vector<int> wanted = {1, edge, edge, edge};
  if (outputs.front ().shape != wanted)
  {
    std::string shape;
    for (const int size : outputs.front ().shape)
      shape += (shape.empty () ? "" : " x ") + std::to_string (size);
    throw IoError ("its output has " + shape + " values; a completion has 1 x 32 x 32 x 32");
  }
  return std::move (outputs.front ().values);
}

class OpenCvCompletion : public CompletionNetwork
{
public:
  OpenCvCompletion (const std::string& path, const std::string& model)
      : path_ (path)
      , network_ (optionsOf (path), model, "")
  {}

  std::vector<float> complete (const std::vector<float>& observed) const override
  {
    const std::lock_guard<std::mutex> lock (mutex_); // OpenCV's network keeps what it computes
    const ProcessSetting<OpenCvSettings> settings (1);
    try
    {
      return onlyOutput (network_.run (toMat (observed)));
    }
    catch (const IoError& error)
    {
      throw IoError (path_ + ": the network cannot be run: " + error.what ());
    }
  }

  static InstanceDetectorOptions optionsOf (const std::string& path)
  {
    InstanceDetectorOptions options;
    options.model = path;
    return options;
  }

private:
  const std::string path_;
  mutable std::mutex mutex_;
  mutable OpenCvNetwork network_;
};

} // namespace

CompletionNetwork::ConstPtr
loadCompletionNetwork (const std::string& path)
{
  std::string model = readBytes (path);
  if (!endsIn (path, ".onnx"))
    throw IoError (path + ": the network of a completion must be an ONNX file (.onnx)");
  try
  {
    checkOnnx (model);
    model = inSinglePrecision (model);
    if (path != completionNetworkFile ()) // that one is known
    {
      const ProcessSetting<OpenCvSettings> settings (1);
      const std::vector<float> nothing (static_cast<std::size_t> (CompletionNetwork::channels) * edge * edge * edge);
      NetworkProcess trial (OpenCvCompletion::optionsOf (path), model, "");
      onlyOutput (trial.run (toMat (nothing)));
    }
    return std::make_shared<OpenCvCompletion> (path, model);
  }
  catch (const IoError& error)
  {
    throw IoError (path + ": it is no network of a completion: " + error.what ());
  }
}

std::string
completionNetworkFile ()
{
  namespace fs = std::filesystem;
  Dl_info info{};
  if (dladdr (reinterpret_cast<const void*> (&completionNetworkFile), &info) == 0 || !info.dli_fname)
    return "";
  fs::path place = info.dli_fname;
  if (place.is_relative ()) // a program's name may be without its folder
    place = "/proc/self/exe";
  std::error_code error;
  place = fs::canonical (place, error);
  for (int level = 0; level < most_levels && !error && place.has_relative_path (); ++level)
  {
    place = place.parent_path ();
    const fs::path file = place / "share" / "pcl_cosection" / "completion.onnx";
    if (fs::is_regular_file (file, error))
      return file;
    error.clear ();
  }
  return "";
}

} // namespace pcl::cosection
