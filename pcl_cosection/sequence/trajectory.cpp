// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/io/trajectory.h>

#include "pcl_cosection/common/files.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <locale>
#include <sstream>

namespace pcl::cosection {
namespace {

constexpr double min_quaternion_norm = 1e-3;
constexpr double max_quaternion_norm = 1e100; // the square of more is infinite, and no rotation comes of it

StampedPose
parsePose (const std::string& line, const std::string& where)
{
  std::istringstream in (line);
  in.imbue (std::locale::classic ());
  std::array<double, 8> values;
  for (double& value : values)
    if (!(in >> value) || !std::isfinite (value))
      throw IoError (where + "must be eight finite numbers: stamp tx ty tz qx qy qz qw");
  std::string more;
  if (in >> more)
    throw IoError (where + "has more than the eight numbers stamp tx ty tz qx qy qz qw");
  const Eigen::Quaterniond rotation (values[7], values[4], values[5], values[6]);
  const double length = rotation.norm ();
  if (!(length > min_quaternion_norm && length < max_quaternion_norm))
    throw IoError (where + "has a quaternion qx qy qz qw of length " + (length > 1.0 ? "infinity" : "zero"));
  StampedPose stamped;
  stamped.stamp = values[0];
  stamped.pose.linear () = rotation.normalized ().toRotationMatrix ();
  stamped.pose.translation () << values[1], values[2], values[3];
  return stamped;
}

} // namespace

std::vector<StampedPose>
loadTrajectory (const std::string& path)
{
  std::istringstream lines (readBytes (path));
  std::vector<StampedPose> poses;
  std::string line;
  for (int number = 1; std::getline (lines, line); ++number)
  {
    const std::size_t first = line.find_first_not_of (" \t\r");
    if (first == std::string::npos || line[first] == '#')
      continue;
    poses.push_back (parsePose (line, path + ": line " + std::to_string (number) + " "));
  }
  if (poses.empty ())
    throw IoError (path + ": has no poses (lines: stamp tx ty tz qx qy qz qw)");
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
