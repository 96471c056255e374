// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/io/rgbd_sequence.h>

#include "camera_file.h"
#include "pcl_cosection/common/files.h"
#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/io/image_io.h"
#include "pcl_cosection/io/lower_case.h"
#include "pcl_cosection/io/text_scanner.h"
#include "sequence_layouts.h"
#include "stamp_matching.h"

#include <pcl/cosection/common/error.h>

#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <sstream>

namespace fs = std::filesystem;

namespace pcl::cosection {
namespace {

constexpr double tum_depth_scale = 5000.0;
constexpr double millimetres = 1000.0;
constexpr double nearest_median_m = 0.05;
constexpr double farthest_median_m = 100.0;
constexpr double largest_size_px = 32768.0;
constexpr double far_off_centre = 0.25;        // a principal point, of the image's size
constexpr double outside = 0.5;                // of the image, likewise
constexpr std::size_t most_to_judge_size = 10; // depth images
constexpr double largest_focal_length_px = 1e6;
constexpr double shortest_focal_length = 0.05;    // of the image's size: a field of view of 169 degrees
constexpr double longest_focal_length = 100.0;    // half a degree
constexpr double farthest_principal_point = 10.0; // of the image's size: it may be cut out of a larger one
constexpr double rigid_tolerance = 0.02;          // of the entries of R R^T - I
const float none = std::numeric_limits<float>::quiet_NaN ();

std::string
sizeText (int width, int height)
{
  return std::to_string (width) + " x " + std::to_string (height) + " pixels";
}

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
depthOddity (const Image<float>& depth, const std::string& path)
{
  std::vector<float> readings;
  std::copy_if (depth.pixels.begin (), depth.pixels.end (), std::back_inserter (readings),
                [] (float z) { return std::isfinite (z); });
  if (readings.empty ())
    return path + ": has no depth in any pixel";
  const float middle = upperMedian (readings);
  if (middle >= nearest_median_m && middle <= farthest_median_m)
    return {};
  std::ostringstream text;
  text << path << ": half of the depths are " << (middle < nearest_median_m ? "less" : "more") << " than " << middle
       << " m; ";
  text << (lowerCaseExtension (path) == ".exr" ? "an .exr must be in metres"
                                               : "give --depth-scale if their unit is another");
  return text.str ();
}

/** \brief The colours at the pixels of a smaller or larger image of the same view. */
Picture
resized (const Picture& picture, int width, int height)
{
  Picture result (width, height);
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u)
      result.at (u, v) = picture.at (static_cast<int> ((2LL * u + 1) * picture.width / (2LL * width)),
                                     static_cast<int> ((2LL * v + 1) * picture.height / (2LL * height)));
  return result;
}

/** \throws IoError */
Picture
readColour (const std::string& path, int width, int height)
{
  requireFile (path);
  Picture colour = loadColourImage (path);
  if (colour.width == width && colour.height == height)
    return colour;
  if (static_cast<long long> (colour.width) * height != static_cast<long long> (colour.height) * width)
    throw IoError (path + ": has " + sizeText (colour.width, colour.height) + ", but the depth has " +
                   sizeText (width, height));
  return resized (colour, width, height);
}

Image<float>
readDepth (const std::string& path, double scale, SequenceFormat format)
{
  requireFile (path);
  Image<float> depth = loadDepthImage (path, scale);
  if (format == SequenceFormat::SevenScenes && lowerCaseExtension (path) == ".png")
    std::replace (depth.pixels.begin (), depth.pixels.end (), static_cast<float> (65535 / scale), none);
  return depth;
}

/** \brief The file that tells the camera, of a folder, or of the one around it for a sequence of 7-Scenes; empty if
 * there is none. */
std::string
cameraFile (const std::string& folder, SequenceFormat format)
{
  std::vector<fs::path> places = {fs::path (folder)};
  if (format == SequenceFormat::SevenScenes)
    places.push_back (fs::path (folder) / "..");
  std::error_code ignored;
  for (const fs::path& place : places)
    for (const std::string& name : cameraFileNames ())
      if (fs::exists (place / name, ignored))
        return (place / name).string ();
  return {};
}

/** \brief How far a principal point is from the middle of an image, of its size. */
double
offCentre (const PinholeCamera& camera, const ImageSize& image)
{
  return std::max (std::abs ((camera.cx + 0.5) / image.width - 0.5), std::abs ((camera.cy + 0.5) / image.height - 0.5));
}

bool
haveSameShape (const ImageSize& a, const ImageSize& b)
{
  return static_cast<long long> (a.width) * b.height == static_cast<long long> (a.height) * b.width;
}

/** \brief The camera of images of another resolution. */
PinholeCamera
scaled (const PinholeCamera& camera, const ImageSize& from, const ImageSize& to)
{
  const double x = static_cast<double> (to.width) / from.width, y = static_cast<double> (to.height) / from.height;
  return {to.width, to.height, x * camera.fx, y * camera.fy, x * (camera.cx + 0.5) - 0.5, y * (camera.cy + 0.5) - 0.5};
}

std::string
pairText (double a, double b)
{
  std::ostringstream out;
  out << a << " and " << b;
  return out.str ();
}

/** \brief What is implausible about a camera, whose size may be 0 (unknown); empty if nothing is. */
std::string
implausibleIntrinsics (const PinholeCamera& camera)
{
  const double fx = camera.fx, fy = camera.fy, cx = camera.cx, cy = camera.cy;
  if (!(fx > 0.0 && fy > 0.0 && fx < largest_focal_length_px && fy < largest_focal_length_px))
    return "has focal lengths fx and fy of " + pairText (fx, fy) +
           " pixels; they must be positive, and less than a million";
  constexpr double farthest_px = farthest_principal_point * largest_size_px;
  if (!(std::abs (cx) <= farthest_px && std::abs (cy) <= farthest_px))
    return "has a principal point cx, cy of " + pairText (cx, cy) + " pixels; it must be in the image, or near it";
  if (fx < 2.0 || fy < 2.0)
    return "has focal lengths fx and fy of " + pairText (fx, fy) +
           "; they must be in pixels, not parts of the image's size";
  const double width = camera.width, height = camera.height;
  if (width <= 0.0 || height <= 0.0)
    return {};
  const std::string image = " for an image of " + sizeText (camera.width, camera.height);
  if (fx < shortest_focal_length * width || fy < shortest_focal_length * height || fx > longest_focal_length * width ||
      fy > longest_focal_length * height)
    return "has focal lengths fx and fy of " + pairText (fx, fy) + image + "; they must be in pixels";
  if (std::abs (cx) > farthest_principal_point * width || std::abs (cy) > farthest_principal_point * height)
    return "has a principal point cx, cy of " + pairText (cx, cy) + image + "; it must be in the image, or near it";
  return {};
}

/** \brief Read a pose as 7-Scenes has it: the 16 numbers of a 4 x 4 matrix, row by row. What rounding took from the
 * rotation is given back. \throws IoError if it cannot be read, is not finite, or not rigid */
Eigen::Isometry3d
readPoseMatrix (const std::string& path)
{
  const std::string bytes = readBytes (path);
  Eigen::Matrix4d matrix;
  try
  {
    TextScanner scanner (bytes);
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 4; ++column)
        matrix (row, column) = toReal (scanner.word ());
    const std::string_view more = scanner.word ();
    if (!more.empty ())
      throw IoError ("there is " + quoted (more) + " behind it");
  }
  catch (const IoError& error)
  {
    throw IoError (path + ": must be the 16 numbers of a 4 x 4 matrix, but " + error.what ());
  }
  if (!matrix.allFinite ())
    throw IoError (path + ": has a pose that is not finite");
  const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3> ();
  const double skew = (rotation * rotation.transpose () - Eigen::Matrix3d::Identity ()).cwiseAbs ().maxCoeff ();
  const double last_row = (matrix.row (3) - Eigen::RowVector4d (0, 0, 0, 1)).cwiseAbs ().maxCoeff ();
  if (!(skew <= rigid_tolerance && last_row <= rigid_tolerance && rotation.determinant () > 0.0))
    throw IoError (path + ": has a matrix that is not a rotation and a translation");
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd (rotation, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity ();
  pose.linear () = svd.matrixU () * svd.matrixV ().transpose (); // the nearest rotation
  pose.translation () = matrix.topRightCorner<3, 1> ();
  return pose;
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
  warnings_ = std::move (listing.warnings);
  period_ = stampPeriod (stamps ());
  depth_scale_ = source.depth_scale > 0.0         ? source.depth_scale
                 : format_ == SequenceFormat::Tum ? tum_depth_scale
                                                  : millimetres;
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
      depth_scale_ = *read.depth_scale;
    size_source_ = file;
  }
  else if (format_ == SequenceFormat::SevenScenes)
  {
    camera_ = {640, 480, 585.0, 585.0, 320.0, 240.0};
    name = size_source_ = "the camera of 7-Scenes";
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
    if (!fits && haveSameShape (own, depth))
      scaleFrom (own, "images");
    return;
  }
  const double off_depth = offCentre (camera_, depth);
  if (off_depth > far_off_centre)
    if (const auto colour = colourSize (); colour && haveSameShape (*colour, depth) && colour->width != depth.width &&
                                           offCentre (camera_, *colour) < std::min (far_off_centre, off_depth))
      return scaleFrom (*colour, "colour images");
  camera_.width = depth.width;
  camera_.height = depth.height;
  if (off_depth <= outside)
    return;
  const std::string fault = name + ": has a principal point of " + pairText (camera_.cx, camera_.cy) +
                            ", outside the depth images of " + sizeText (depth.width, depth.height);
  if (!is_given)
    throw IoError (fault + "; is it that of another resolution? Then scale it, or add the size of its images: "
                           "'fx fy cx cy width height'");
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
      const Image<float> depth = readDepth (files.depth, depth_scale_, format_);
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
  frame.depth = readDepth (files.depth, depth_scale_, format_);
  if (frame.depth.width != camera_.width || frame.depth.height != camera_.height)
    throw IoError (files.depth + ": has " + sizeText (frame.depth.width, frame.depth.height) + ", but " + size_source_ +
                   " has " + sizeText (camera_.width, camera_.height));
  const std::string oddity = depthOddity (frame.depth, files.depth);
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
  for (std::size_t index = 0; index < files_.size (); ++index)
    if (const auto pose = givenPose (index, warnings))
      poses.push_back ({files_[index].stamp, *pose});
  return poses;
}

} // namespace pcl::cosection
