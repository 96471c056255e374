// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/io/rgbd_sequence.h>

#include "camera_file.h"
#include "camera_of_images.h"
#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/io/image_io.h"
#include "pcl_cosection/io/lower_case.h"
#include "pose_matrix.h"
#include "resized_image.h"
#include "sequence_layouts.h"
#include "stamp_matching.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <sstream>

namespace fs = std::filesystem;

namespace pcl::cosection {
namespace {

const char* const replica_camera = "cam_params.json";
constexpr double tum_depth_scale = 5000.0;
constexpr double millimetres = 1000.0;
constexpr double nearest_median_m = 0.05;
constexpr double nearest_of_kinect_m = 0.4; // the camera of the TUM benchmark sees nothing nearer
constexpr double farthest_median_m = 100.0;
constexpr double far_off_centre = 0.25;        // a principal point, of the image's size
constexpr double off_centre = 0.1;             // of images 1.25 times as large it is .125 off
constexpr double nearer_centre = 0.5;          // of colour images it must be so much nearer the middle
constexpr double outside = 0.5;                // of the image, likewise
constexpr std::size_t most_to_judge_size = 10; // depth images

/** \brief Pipes wait for who writes them, so nothing but files is read. */
void
requireFile (const std::string& path)
{
  std::error_code failure;
  const fs::file_status status = fs::status (path, failure);
  if (status.type () == fs::file_type::not_found)
    throw IoError (path + ": there is no such file");
  if (fs::exists (status) && !fs::is_regular_file (status))
    throw IoError (path + ": is not a file");
}

/** \brief What is odd about the depths of an image; empty if nothing is. */
std::string
depthOddity (const Image<float>& depth, const std::string& path, double nearest_m)
{
  std::vector<float> readings;
  std::copy_if (depth.pixels.begin (), depth.pixels.end (), std::back_inserter (readings),
                [] (float z) { return std::isfinite (z); });
  if (readings.empty ())
    return path + ": has no depth in any pixel";
  const float middle = upperMedian (readings);
  if (middle >= nearest_m && middle <= farthest_median_m)
    return {};
  std::ostringstream text;
  text << path << ": half of the depths are " << (middle < nearest_m ? "less" : "more") << " than " << middle << " m; ";
  text << (lowerCaseExtension (path) == ".exr" ? "an .exr must be in metres"
                                               : "give --depth-scale if their unit is another");
  return text.str ();
}

/** \throws IoError */
Picture
readColour (const std::string& path, int width, int height)
{
  requireFile (path);
  Picture colour = loadColourImage (path);
  if (colour.width == width && colour.height == height)
    return colour;
  if (!haveSameShape (colour.width, colour.height, width, height))
    throw IoError (path + ": has " + sizeText (colour.width, colour.height) + ", but the depth has " +
                   sizeText (width, height));
  return resized (colour, width, height);
}

Image<float>
readDepth (const std::string& path, double scale)
{
  requireFile (path);
  return loadDepthImage (path, scale);
}

/** \brief The file that tells the camera, of a folder, of the one of ScanNet in it, or of the one around it for
 * 7-Scenes; Replica's is around its scenes. Empty if there is none. */
std::string
cameraFile (const std::string& folder, SequenceFormat format)
{
  const fs::path own (folder);
  std::vector<fs::path> places = {own, own / "intrinsic"};
  if (format == SequenceFormat::SevenScenes)
    places.push_back (own / "..");
  std::vector<fs::path> candidates;
  for (const fs::path& place : places)
    for (const std::string& name : cameraFileNames ())
      candidates.push_back (place / name);
  candidates.push_back (own / ".." / replica_camera);
  std::error_code ignored;
  const auto found = std::find_if (candidates.begin (), candidates.end (),
                                   [&] (const fs::path& path) { return fs::exists (path, ignored); });
  return found == candidates.end () ? std::string () : found->string ();
}

} // namespace

void
SequenceSource::validate () const
{
  if (!(depth_scale >= 0.0) || !std::isfinite (depth_scale))
    throw InvalidArgument ("depth_scale must be positive, or 0 for that of the layout, but is " +
                           std::to_string (depth_scale));
  if (!intrinsics)
    return;
  const auto& [fx, fy, cx, cy] = *intrinsics;
  const std::string fault = implausibleIntrinsics ({0, 0, fx, fy, cx, cy});
  if (!fault.empty ())
    throw InvalidArgument ("intrinsics fx, fy, cx, cy: the camera " + fault);
}

RgbdSequence::RgbdSequence (const std::string& folder, const SequenceSource& source)
{
  source.validate ();
  SequenceListing listing = listSequence (folder, source);
  format_ = listing.format;
  files_ = std::move (listing.files);
  trajectory_ = std::move (listing.trajectory);
  warnings_ = std::move (listing.warnings);
  period_ = stampPeriod (stamps ());
  depth_scale_ = source.depth_scale > 0.0         ? source.depth_scale
                 : format_ == SequenceFormat::Tum ? tum_depth_scale
                                                  : millimetres;
  scale_is_assumed_ = format_ == SequenceFormat::Tum && !(source.depth_scale > 0.0);
  setCamera (listing.folder, source);
}

void
RgbdSequence::setCamera (const std::string& folder, const SequenceSource& source)
{
  const std::string file = cameraFile (folder, format_);
  std::string name = file;
  if (source.intrinsics)
  {
    const auto& [fx, fy, cx, cy] = *source.intrinsics;
    camera_ = {0, 0, fx, fy, cx, cy};
    name = "--intrinsics";
  }
  else if (!file.empty ())
  {
    requireFile (file);
    const CameraFile read = readCameraFile (file);
    camera_ = read.camera;
    if (read.depth_scale && !(source.depth_scale > 0.0))
    {
      depth_scale_ = *read.depth_scale;
      scale_is_assumed_ = false;
    }
    size_source_ = file;
  }
  else if (format_ == SequenceFormat::SevenScenes)
  {
    camera_ = {640, 480, 585.0, 585.0, 320.0, 240.0};
    name = size_source_ = "the camera of 7-Scenes";
    warnings_.push_back (folder + ": has no file of a camera; that of 7-Scenes is taken, --intrinsics 585,585,320,240");
  }
  else
    throw IoError (folder +
                   ": has no calibration.txt with 'fx fy cx cy [width height]', nor another file of a camera (" +
                   "cam_K.txt, camera_intrinsic.json, scene_camera.json); write one, or give --intrinsics");
  const auto check = [&] {
    const std::string fault = implausibleIntrinsics (camera_);
    if (!fault.empty () && source.intrinsics)
      throw InvalidArgument ("intrinsics fx, fy, cx, cy: the camera " + fault);
    if (!fault.empty ())
      throw IoError (name + ": " + fault);
  };
  check ();
  fitCameraToDepth (folder, name, source.intrinsics.has_value ());
  check ();
}

void
RgbdSequence::fitCameraToDepth (const std::string& folder, const std::string& name, bool is_given)
{
  const bool has_size = camera_.width > 0;
  const std::vector<ImageSize> sizes = depthSizes (folder, has_size);
  if (sizes.empty ())
    return;
  const ImageSize depth = sizes.front ();
  const auto scaleFrom = [&] (const ImageSize& from, const std::string& what) {
    camera_ = scaled (camera_, from, depth);
    size_source_ = files_.front ().depth;
    warnings_.push_back (name + ": is the camera of " + what + " of " + sizeText (from.width, from.height) +
                         "; it is scaled to the " + sizeText (depth.width, depth.height) + " of the depth images");
  };
  if (has_size)
  {
    const ImageSize own = {camera_.width, camera_.height};
    const bool fits = std::any_of (sizes.begin (), sizes.end (), [&] (const ImageSize& size) {
      return size.width == own.width && size.height == own.height;
    });
    if (!fits && haveSameShape (own.width, own.height, depth.width, depth.height))
      scaleFrom (own, "images");
    return;
  }
  const double off_depth = offCentre (camera_, depth);
  if (off_depth > off_centre)
    if (const auto colour = colourSize ();
        colour && haveSameShape (colour->width, colour->height, depth.width, depth.height) &&
        colour->width != depth.width &&
        offCentre (camera_, *colour) < std::min (far_off_centre, nearer_centre * off_depth))
      return scaleFrom (*colour, "colour images");
  camera_.width = depth.width;
  camera_.height = depth.height;
  if (off_depth < far_off_centre)
    return;
  const bool is_outside = off_depth >= outside;
  const std::string fault = name + ": has a principal point of " + pairText (camera_.cx, camera_.cy) +
                            (is_outside ? ", outside" : ", far from the middle of") + " the depth images of " +
                            sizeText (depth.width, depth.height) +
                            "; is it that of another resolution? Then scale it, " +
                            "or add the size of its images: 'fx fy cx cy width height'";
  if (is_outside && !is_given)
    throw IoError (fault);
  warnings_.push_back (fault);
}

std::vector<ImageSize>
RgbdSequence::depthSizes (const std::string& folder, bool may_fail)
{
  std::vector<ImageSize> sizes;
  std::string first_failure;
  for (const FrameFiles& files : files_)
    try
    {
      const Image<float> depth = readDepth (files.depth, depth_scale_);
      sizes.push_back ({depth.width, depth.height});
      if (!may_fail) // the first one counts
        size_source_ = files.depth;
      const bool fits = depth.width == camera_.width && depth.height == camera_.height;
      if (!may_fail || fits || sizes.size () == most_to_judge_size)
        return sizes;
    }
    catch (const IoError& error)
    {
      if (first_failure.empty ())
        first_failure = error.what ();
    }
  if (sizes.empty () && !may_fail)
    throw IoError (folder + ": no depth image can be read; the first: " + first_failure);
  return sizes;
}

std::optional<ImageSize>
RgbdSequence::colourSize () const
{
  for (const FrameFiles& files : files_)
    try
    {
      if (files.colour.empty ())
        continue;
      requireFile (files.colour);
      const Picture colour = loadColourImage (files.colour);
      return ImageSize{colour.width, colour.height};
    }
    catch (const IoError&)
    {
      // the next one
    }
  return std::nullopt;
}

std::vector<double>
RgbdSequence::stamps () const
{
  std::vector<double> stamps;
  for (const FrameFiles& files : files_)
    stamps.push_back (files.stamp);
  return stamps;
}

RgbdFrame
RgbdSequence::read (std::size_t index, std::vector<std::string>& warnings) const
{
  if (index >= files_.size ())
    throw InvalidArgument ("there is no frame " + std::to_string (index) + "; there are " +
                           std::to_string (files_.size ()));
  const FrameFiles& files = files_[index];
  RgbdFrame frame;
  frame.index = index;
  frame.stamp = files.stamp;
  frame.depth = readDepth (files.depth, depth_scale_);
  if (frame.depth.width != camera_.width || frame.depth.height != camera_.height)
    throw IoError (files.depth + ": has " + sizeText (frame.depth.width, frame.depth.height) + ", but " + size_source_ +
                   " has " + sizeText (camera_.width, camera_.height));
  const std::string oddity = depthOddity (frame.depth, files.depth,
                                          scale_is_assumed_ ? nearest_of_kinect_m : nearest_median_m);
  if (!oddity.empty ())
    warnings.push_back (oddity);
  if (files.colour.empty ())
    return frame;
  try
  {
    frame.colour = readColour (files.colour, camera_.width, camera_.height);
  }
  catch (const IoError& error)
  {
    warnings.push_back (std::string (error.what ()) + "; the frame is without colour");
  }
  return frame;
}

std::optional<Eigen::Isometry3d>
RgbdSequence::givenPose (std::size_t index, std::vector<std::string>& warnings) const
{
  if (index >= files_.size ())
    throw InvalidArgument ("there is no frame " + std::to_string (index) + "; there are " +
                           std::to_string (files_.size ()));
  if (files_[index].pose.empty ())
    return std::nullopt;
  try
  {
    return readPoseMatrix (files_[index].pose);
  }
  catch (const IoError& error)
  {
    warnings.push_back (std::string (error.what ()) + "; the frame is without pose");
    return std::nullopt;
  }
}

std::vector<StampedPose>
RgbdSequence::givenTrajectory (std::vector<std::string>& warnings) const
{
  std::vector<StampedPose> poses;
  try
  {
    if (!trajectory_.empty ())
      return loadTrajectory (trajectory_, stamps ());
  }
  catch (const IoError& error)
  {
    warnings.push_back (std::string (error.what ()) + "; the frames are without pose");
  }
  for (std::size_t index = 0; index < files_.size (); ++index)
    if (const auto pose = givenPose (index, warnings))
      poses.push_back ({files_[index].stamp, *pose});
  return poses;
}

} // namespace pcl::cosection
