// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/io/trajectory.h>

#include "pcl_cosection/common/files.h"
#include "pcl_cosection/io/text_scanner.h"
#include "pose_matrix.h"
#include "stamp_matching.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <locale>
#include <optional>
#include <sstream>

namespace pcl::cosection {
namespace {

constexpr std::size_t of_quaternion = 8, of_rows = 12, of_matrix = 16; // numbers of a line
const char* const form = "a pose is 'stamp tx ty tz qx qy qz qw', or a matrix row by row, 12 or 16 numbers";
constexpr double min_quaternion_norm = 1e-3;
constexpr double max_quaternion_norm = 1e100; // the square of more is infinite, and no rotation comes of it

/** \brief The numbers of a line. \throws IoError */
std::vector<double>
numbersOf (const std::string& line)
try
{
  std::vector<double> numbers;
  TextScanner scanner (line);
  for (std::string_view word = scanner.word (); !word.empty (); word = scanner.word ())
    numbers.push_back (toReal (word));
  return numbers;
}
catch (const IoError& error)
{
  throw IoError (std::string (error.what ()) + "; " + form);
}

/** \brief The pose of tx ty tz qx qy qz qw. */
Eigen::Isometry3d
poseOf (const double* values)
{
  const Eigen::Quaterniond rotation (values[6], values[3], values[4], values[5]);
  const double length = rotation.norm ();
  if (!(length > min_quaternion_norm && length < max_quaternion_norm))
    throw IoError (std::string ("has a quaternion qx qy qz qw of length ") + (length > 1.0 ? "infinity" : "zero"));
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity ();
  pose.linear () = rotation.normalized ().toRotationMatrix ();
  pose.translation () << values[0], values[1], values[2];
  return pose;
}

/** \brief A line as it is in a file. */
struct PoseLine
{
  std::optional<double> stamp;           ///< nothing: it has none
  std::optional<Eigen::Isometry3d> pose; ///< nothing: it is not finite, as where tracking was lost
};

/** \throws IoError without the place */
PoseLine
parsePose (const std::string& line)
{
  const std::vector<double> values = numbersOf (line);
  const bool has_stamp = values.size () == of_quaternion;
  if (!has_stamp && values.size () != of_rows && values.size () != of_matrix)
    throw IoError ("has " + std::to_string (values.size ()) + " numbers; " + form);
  PoseLine result;
  if (has_stamp)
  {
    result.stamp = stampOf (values[0]);
    if (!result.stamp)
      throw IoError ("has a stamp that is no time in seconds, micro- or nanoseconds, nor the number of a frame");
  }
  if (!std::all_of (values.begin (), values.end (), [] (double value) { return std::isfinite (value); }))
    return result;
  if (has_stamp)
    result.pose = poseOf (values.data () + 1);
  else
  {
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity ();
    for (std::size_t n = 0; n < values.size (); ++n)
      matrix (static_cast<int> (n / 4), static_cast<int> (n % 4)) = values[n];
    result.pose = poseOfMatrix (matrix);
  }
  return result;
}

} // namespace

std::vector<StampedPose>
loadTrajectory (const std::string& path, const std::vector<double>& frames)
{
  std::istringstream lines (readBytes (path));
  std::vector<PoseLine> read;
  std::string line;
  for (int number = 1; std::getline (lines, line); ++number)
    try
    {
      const std::size_t first = line.find_first_not_of (" \t\r");
      if (first == std::string::npos || line[first] == '#')
        continue;
      read.push_back (parsePose (line));
      if (read.back ().stamp.has_value () != read.front ().stamp.has_value ())
        throw IoError ("and the first pose are not both with a stamp, or both without");
    }
    catch (const IoError& error)
    {
      throw IoError (path + ": line " + std::to_string (number) + ": " + error.what ());
    }
  if (!frames.empty () && !read.empty () && !read.front ().stamp && read.size () != frames.size ())
    throw IoError (path + ": has " + std::to_string (read.size ()) + " poses without a stamp, but there are " +
                   std::to_string (frames.size ()) +
                   " frames, so which is whose is not known; give lines 'stamp tx ty tz qx qy qz qw'");
  std::vector<StampedPose> poses;
  for (std::size_t n = 0; n < read.size (); ++n)
    if (read[n].pose)
      poses.push_back ({read[n].stamp.value_or (frames.empty () ? static_cast<double> (n) : frames[n]), *read[n].pose});
  if (poses.empty ())
    throw IoError (path + ": has no poses" + (read.empty () ? "" : " that are finite") +
                   " (lines: stamp tx ty tz qx qy qz qw)");
  const auto earlier = [] (const StampedPose& a, const StampedPose& b) { return a.stamp < b.stamp; };
  std::stable_sort (poses.begin (), poses.end (), earlier);
  const auto twice = std::adjacent_find (
      poses.begin (), poses.end (), [] (const StampedPose& a, const StampedPose& b) { return a.stamp == b.stamp; });
  if (twice != poses.end ())
  {
    std::ostringstream stamp;
    stamp << twice->stamp;
    throw IoError (path + ": has two poses of stamp " + stamp.str ());
  }
  return poses;
}

void
saveTrajectory (const std::vector<StampedPose>& poses, const std::string& path)
{
  std::ostringstream out;
  out.imbue (std::locale::classic ());
  for (const StampedPose& stamped : poses)
  {
    const bool whole = stamped.stamp == std::floor (stamped.stamp) && std::abs (stamped.stamp) < 1e15;
    out << std::fixed << std::setprecision (whole ? 0 : 6) << stamped.stamp << std::setprecision (9);
    const Eigen::Vector3d t = stamped.pose.translation ();
    Eigen::Quaterniond q (stamped.pose.linear ());
    if (q.w () < 0.0)
      q.coeffs () = -q.coeffs ();
    for (const double value : {t.x (), t.y (), t.z (), q.x (), q.y (), q.z (), q.w ()})
      out << ' ' << (value == 0.0 ? 0.0 : value); // no -0
    out << '\n';
  }
  writeAtomically (path, [&out] (const std::string& temporary) { writeBytes (temporary, out.str ()); });
}

} // namespace pcl::cosection
