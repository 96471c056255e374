// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "camera_file.h"

#include "pcl_cosection/common/files.h"
#include "pcl_cosection/io/lower_case.h"
#include "pcl_cosection/io/text_scanner.h"

#include <pcl/cosection/common/error.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <sstream>
#include <utility>

namespace pcl::cosection {
namespace {

using Json = nlohmann::json;

constexpr double largest_size_px = 32768.0;
constexpr double bop_units = 1000.0;     // depth_scale of the BOP benchmark takes units of the image to millimetres
constexpr double least_bop_scale = 0.01; // its smallest one is 0.05; smaller ones are in metres, as of librealsense
constexpr double largest_skew_px = 1.0;

int
sizeOf (double pixels)
{
  if (!(pixels >= 1.0 && pixels <= largest_size_px && pixels == std::floor (pixels)))
  {
    std::ostringstream text;
    text << "has a width or height of " << pixels << "; they must be whole numbers of pixels";
    throw IoError (text.str ());
  }
  return static_cast<int> (pixels);
}

/** \brief The camera of a matrix (rows of 3 or 4 numbers, the last one 0 0 1). */
PinholeCamera
cameraOf (const std::vector<double>& matrix, std::size_t columns)
{
  const auto at = [&] (std::size_t row, std::size_t column) { return matrix[row * columns + column]; };
  if (at (1, 0) != 0.0 || at (2, 0) != 0.0 || at (2, 1) != 0.0 || at (2, 2) != 1.0 ||
      !(std::abs (at (0, 1)) < largest_skew_px))
    throw IoError ("has a matrix that is not that of a camera: fx 0 cx, 0 fy cy, 0 0 1");
  return {0, 0, at (0, 0), at (1, 1), at (0, 2), at (1, 2)};
}

CameraFile
parseText (const std::string& bytes)
{
  const std::string form = "must be 'fx fy cx cy [width height]' in pixels, or a matrix of 3 x 3, but ";
  std::vector<double> numbers;
  try
  {
    TextScanner scanner (bytes);
    while (!scanner.left ().empty ())
    {
      TextScanner line (scanner.line ());
      for (std::string_view word = line.word (); !word.empty () && word[0] != '#'; word = line.word ())
        numbers.push_back (toReal (word));
    }
  }
  catch (const IoError& error)
  {
    throw IoError (form + error.what ());
  }
  CameraFile file;
  // A matrix has zeros there.
  if (numbers.size () == 9 && numbers[3] != 0.0 && std::abs (numbers[1]) > largest_skew_px)
    throw IoError ("has nine numbers that are no matrix of a camera, fx 0 cx, 0 fy cy, 0 0 1; if they are 'fx fy cx "
                   "cy' and distortion, undistort the images and give the four numbers alone");
  if (numbers.size () == 9 || numbers.size () == 16)
    file.camera = cameraOf (numbers, numbers.size () == 9 ? 3 : 4);
  else if (numbers.size () == 4 || numbers.size () == 6)
    file.camera = {0, 0, numbers[0], numbers[1], numbers[2], numbers[3]};
  else
    throw IoError (form + "has " + std::to_string (numbers.size ()) + " numbers");
  if (numbers.size () == 6)
  {
    file.camera.width = sizeOf (numbers[4]);
    file.camera.height = sizeOf (numbers[5]);
  }
  return file;
}

std::vector<double>
matrixOf (const Json& json, const std::string& key)
{
  const auto numbers = json.at (key).get<std::vector<double>> ();
  if (numbers.size () != 9)
    throw IoError ("has " + key + " of " + std::to_string (numbers.size ()) + " numbers; there must be 9");
  return numbers;
}

PinholeCamera
cameraOfFields (const Json& json)
{
  const auto number = [&json] (const char* key) { return json.at (key).get<double> (); };
  if (json.contains ("ppx")) // as librealsense has it
    return {0, 0, number ("fx"), number ("fy"), number ("ppx"), number ("ppy")};
  return {0, 0, number ("fx"), number ("fy"), number ("cx"), number ("cy")};
}

void
setSize (const Json& json, const char* width, const char* height, PinholeCamera& camera)
{
  if (!json.contains (width) || !json.contains (height))
    return;
  camera.width = sizeOf (json.at (width).get<double> ());
  camera.height = sizeOf (json.at (height).get<double> ());
}

/** \brief The camera of cam_params.json, as comes with renderings of Replica's scenes. */
CameraFile
parseReplica (const Json& json)
{
  CameraFile file;
  file.camera = cameraOfFields (json);
  setSize (json, "w", "h", file.camera);
  if (json.contains ("scale"))
    file.depth_scale = json.at ("scale").get<double> ();
  return file;
}

/** \brief scene_camera.json: an entry for each image. */
CameraFile
parseSceneCamera (const Json& images)
{
  std::optional<std::pair<std::vector<double>, double>> first;
  for (const auto& [name, image] : images.items ())
  {
    const std::pair relevant (matrixOf (image, "cam_K"), image.value ("depth_scale", 1.0));
    if (first && *first != relevant)
      throw IoError ("has different cameras for image " + name +
                     " and the one before; give --intrinsics if one fits all");
    first = relevant;
  }
  const Json& image = *images.begin ();
  CameraFile file;
  file.camera = cameraOf (matrixOf (image, "cam_K"), 3);
  file.depth_scale = bop_units / image.value ("depth_scale", 1.0);
  return file;
}

CameraFile
parseJson (const std::string& bytes)
{
  const Json json = Json::parse (bytes);
  if (!json.is_object () || json.empty ())
    throw IoError ("holds no camera");
  if (json.begin ()->is_object () && json.begin ()->contains ("cam_K"))
    return parseSceneCamera (json);
  if (json.contains ("camera") && json.at ("camera").is_object ())
    return parseReplica (json.at ("camera"));
  CameraFile file;
  if (json.contains ("intrinsic_matrix"))
  {
    const std::vector<double> m = matrixOf (json, "intrinsic_matrix");
    const bool by_columns = m[6] != 0.0 || m[7] != 0.0; // as Open3D writes it
    file.camera = cameraOf (by_columns ? std::vector<double>{m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8]} : m,
                            3);
  }
  else if (json.contains ("cam_K") || json.contains ("K"))
    file.camera = cameraOf (matrixOf (json, json.contains ("K") ? "K" : "cam_K"), 3);
  else
    file.camera = cameraOfFields (json);
  setSize (json, "width", "height", file.camera);
  if (json.contains ("depth_scale"))
  {
    const double scale = json.at ("depth_scale").get<double> ();
    const bool is_per_metre = json.contains ("intrinsic_matrix") && scale >= 1.0; // as Open3D records it
    file.depth_scale = is_per_metre ? scale : (scale < least_bop_scale ? 1.0 : bop_units) / scale;
  }
  return file;
}

} // namespace

const std::vector<std::string>&
cameraFileNames ()
{
  static const std::vector<std::string> names = {"calibration.txt",   "camera-intrinsics.txt", "cam_K.txt",
                                                 "intrinsics.txt",    "intrinsic_depth.txt",   "K.txt",
                                                 "scene_camera.json", "camera_intrinsic.json", "intrinsic.json",
                                                 "intrinsics.json",   "camera.json",           "cam_params.json"};
  return names;
}

CameraFile
readCameraFile (const std::string& path)
{
  const std::string bytes = readBytes (path);
  try
  {
    const CameraFile file = lowerCaseExtension (path) == ".json" ? parseJson (bytes) : parseText (bytes);
    if (file.depth_scale && !(std::isfinite (*file.depth_scale) && *file.depth_scale > 0.0))
      throw IoError ("has a depth_scale that is not positive");
    return file;
  }
  catch (const Json::exception&)
  {
    throw IoError (path + ": is not the JSON of a camera: it needs intrinsic_matrix, cam_K, or fx, fy, cx and cy");
  }
  catch (const IoError& error)
  {
    throw IoError (path + ": " + error.what ());
  }
}

} // namespace pcl::cosection
