// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "flat_faces.h"

#include "pcl_cosection/common/quantile.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr double face_share = 0.03;     // of the points: smaller faces do not count
constexpr double face_cosine = 0.966;   // 15 degrees
constexpr std::size_t few_faces = 3;    // the largest
constexpr double few_faces_share = 0.7; // of the points

} // namespace

std::vector<Eigen::Vector3d>
evenDirections (int count, const Eigen::Matrix3d& axes)
{
  std::vector<Eigen::Vector3d> directions;
  const double golden = M_PI * (3.0 - std::sqrt (5.0));
  for (int n = 0; n < count; ++n)
  {
    const double z = 1.0 - (2.0 * n + 1.0) / count;
    const double r = std::sqrt (1.0 - z * z);
    const Eigen::Vector3d direction (r * std::cos (golden * n), r * std::sin (golden * n), z);
    if ((direction.array () < 0.0).any ())
      continue;
    for (int octant = 0; octant < 8; ++octant)
    {
      const Eigen::Array3d sense ((octant & 1) ? -1.0 : 1.0, (octant & 2) ? -1.0 : 1.0, (octant & 4) ? -1.0 : 1.0);
      directions.push_back (axes * (sense * direction.array ()).matrix ());
    }
  }
  return directions;
}

std::vector<Eigen::Vector3d>
faceNormals (const std::vector<OrientedPoint>& points, const std::vector<Eigen::Vector3d>& bins)
{
  std::vector<Eigen::Vector3d> sums (bins.size (), Eigen::Vector3d::Zero ());
  std::vector<int> counts (bins.size (), 0);
  for (const OrientedPoint& point : points)
  {
    const Eigen::Vector3d n = point.normal.cast<double> ();
    std::size_t nearest = 0;
    double largest = bins[0].dot (n);
    for (std::size_t b = 1; b < bins.size (); ++b)
      if (const double cosine = bins[b].dot (n); cosine > largest)
      {
        nearest = b;
        largest = cosine;
      }
    sums[nearest] += n;
    ++counts[nearest];
  }
  std::vector<Eigen::Vector3d> faces;
  while (true)
  {
    const std::ptrdiff_t fullest = std::max_element (counts.begin (), counts.end ()) - counts.begin ();
    if (counts[fullest] < face_share * static_cast<double> (points.size ()))
      return faces;
    const Eigen::Vector3d rough = sums[fullest].normalized ();
    Eigen::Vector3d sum = Eigen::Vector3d::Zero ();
    for (const OrientedPoint& point : points)
      if (point.normal.cast<double> ().dot (rough) > face_cosine)
        sum += point.normal.cast<double> ();
    counts[fullest] = 0;
    if (!(sum.norm () > 0.0))
      continue;
    faces.push_back (sum.normalized ());
    for (std::size_t b = 0; b < bins.size (); ++b)
      if (bins[b].dot (faces.back ()) > face_cosine)
        counts[b] = 0;
  }
}

bool
prevail (const std::vector<OrientedPoint>& points, const std::vector<Eigen::Vector3d>& faces)
{
  const auto on_face = [&] (const OrientedPoint& p) {
    const auto is_its = [&] (const Eigen::Vector3d& face) { return face.dot (p.normal.cast<double> ()) > face_cosine; };
    return std::any_of (faces.begin (),
                        faces.begin () + static_cast<std::ptrdiff_t> (std::min (few_faces, faces.size ())), is_its);
  };
  const std::ptrdiff_t count = std::count_if (points.begin (), points.end (), on_face);
  return static_cast<double> (count) > few_faces_share * static_cast<double> (points.size ());
}

} // namespace pcl::cosection
