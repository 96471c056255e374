// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "mesh_measures.h"

#include "common/triangle_distance.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>

namespace pcl::cosection::test {
namespace {

constexpr std::uint32_t leaf_size = 4;

/** \brief The numbers of the attribute \a name of an XML header. */
std::vector<double>
xmlAttribute (const std::string& xml, const std::string& name)
{
  std::vector<double> numbers;
  const std::string opening = name + "=\"";
  const std::size_t begin = xml.find (opening);
  if (begin == std::string::npos)
    return (numbers);
  const std::size_t first = begin + opening.size ();
  std::istringstream values (xml.substr (first, xml.find ('"', first) - first));
  for (double value; values >> value;)
    numbers.push_back (value);
  return (numbers);
}

std::vector<Eigen::Vector3d>
inliersOf (const std::vector<Eigen::Vector3d>& points, const FittedPlane& plane, double tolerance_m)
{
  std::vector<Eigen::Vector3d> result;
  for (const Eigen::Vector3d& p : points)
    if (std::abs (plane.height (p)) <= tolerance_m)
      result.push_back (p);
  return (result);
}

FittedPlane
leastSquaresPlane (const std::vector<Eigen::Vector3d>& points)
{
  Eigen::Vector3d mean = Eigen::Vector3d::Zero ();
  for (const Eigen::Vector3d& p : points)
    mean += p / static_cast<double> (points.size ());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero ();
  for (const Eigen::Vector3d& p : points)
    covariance += (p - mean) * (p - mean).transpose () / static_cast<double> (points.size ());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver (covariance);
  FittedPlane plane;
  plane.normal = solver.eigenvectors ().col (0);
  plane.d = -plane.normal.dot (mean);
  if (plane.d < 0.0)
  {
    plane.normal = -plane.normal;
    plane.d = -plane.d;
  }
  plane.inliers = points.size ();
  plane.rms_m = std::sqrt (std::max (0.0, solver.eigenvalues ()[0]));
  return (plane);
}

} // namespace

ExactMeshDistance::ExactMeshDistance (const TriangleMesh& mesh)
{
  triangles_.reserve (mesh.triangles.size ());
  for (const TriangleMesh::Triangle& t : mesh.triangles)
    triangles_.push_back ({mesh.vertices[t[0]].cast<double> (), mesh.vertices[t[1]].cast<double> (),
                           mesh.vertices[t[2]].cast<double> ()});
  if (!triangles_.empty ())
    build (0, static_cast<std::uint32_t> (triangles_.size ()));
}

std::uint32_t
ExactMeshDistance::build (std::uint32_t begin, std::uint32_t end)
{
  const auto index = static_cast<std::uint32_t> (nodes_.size ());
  Node node;
  node.begin = begin;
  node.end = end;
  for (std::uint32_t i = begin; i < end; ++i)
    for (const Eigen::Vector3d& corner : triangles_[i])
      node.box.extend (corner);
  nodes_.push_back (node);
  if (end - begin > leaf_size)
  {
    Eigen::Index axis = 0;
    node.box.sizes ().maxCoeff (&axis);
    const std::uint32_t middle = begin + (end - begin) / 2;
    const auto centre = [axis] (const std::array<Eigen::Vector3d, 3>& t) { return (t[0] + t[1] + t[2])[axis]; };
    std::nth_element (triangles_.begin () + begin, triangles_.begin () + middle, triangles_.begin () + end,
                      [&] (const auto& a, const auto& b) { return (centre (a) < centre (b)); });
    build (begin, middle);
    const std::uint32_t right = build (middle, end);
    nodes_[index].right = right;
  }
  return (index);
}

double
ExactMeshDistance::operator() (const Eigen::Vector3d& p) const
{
  double best = std::numeric_limits<double>::infinity ();
  std::vector<std::uint32_t> open;
  if (!nodes_.empty ())
    open.push_back (0);
  while (!open.empty ())
  {
    const std::uint32_t index = open.back ();
    const Node& node = nodes_[index];
    open.pop_back ();
    if (node.box.squaredExteriorDistance (p) >= best * best)
      continue;
    if (node.right == 0)
    {
      for (std::uint32_t i = node.begin; i < node.end; ++i)
        best = std::min (best, distanceToTriangle (p, triangles_[i][0], triangles_[i][1], triangles_[i][2]));
      continue;
    }
    const std::uint32_t left = index + 1;
    const bool left_first = nodes_[left].box.squaredExteriorDistance (p) <
                            nodes_[node.right].box.squaredExteriorDistance (p);
    open.push_back (left_first ? node.right : left);
    open.push_back (left_first ? left : node.right);
  }
  return (best);
}

std::vector<Eigen::Vector3d>
sampleByArea (const TriangleMesh& mesh, std::size_t count, unsigned seed)
{
  std::vector<double> area_up_to;
  double area = 0.0;
  for (const TriangleMesh::Triangle& t : mesh.triangles)
  {
    const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double> ();
    const Eigen::Vector3d b = mesh.vertices[t[1]].cast<double> ();
    const Eigen::Vector3d c = mesh.vertices[t[2]].cast<double> ();
    area += 0.5 * (b - a).cross (c - a).norm ();
    area_up_to.push_back (area);
  }
  std::vector<Eigen::Vector3d> samples;
  if (!(area > 0.0))
    return (samples);
  std::mt19937 random (seed);
  std::uniform_real_distribution<double> uniform (0.0, 1.0);
  for (std::size_t i = 0; i < count; ++i)
  {
    const auto found = std::upper_bound (area_up_to.begin (), area_up_to.end (), uniform (random) * area);
    const auto triangle = std::min<std::ptrdiff_t> (found - area_up_to.begin (),
                                                    static_cast<std::ptrdiff_t> (area_up_to.size ()) - 1);
    const TriangleMesh::Triangle& t = mesh.triangles[static_cast<std::size_t> (triangle)];
    const double root = std::sqrt (uniform (random));
    const double along = uniform (random);
    samples.push_back ((1.0 - root) * mesh.vertices[t[0]].cast<double> () +
                       root * (1.0 - along) * mesh.vertices[t[1]].cast<double> () +
                       root * along * mesh.vertices[t[2]].cast<double> ());
  }
  return (samples);
}

double
percentile (std::vector<double> values, double fraction)
{
  if (values.empty ())
    return (std::numeric_limits<double>::quiet_NaN ());
  const auto rank = static_cast<std::ptrdiff_t> (std::ceil (fraction * static_cast<double> (values.size ()))) - 1;
  const auto at = values.begin () +
                  std::clamp<std::ptrdiff_t> (rank, 0, static_cast<std::ptrdiff_t> (values.size ()) - 1);
  std::nth_element (values.begin (), at, values.end ());
  return (*at);
}

double
boxDiagonal (const std::vector<Eigen::Vector3d>& points, double trim)
{
  Eigen::Vector3d size;
  for (int axis = 0; axis < 3; ++axis)
  {
    std::vector<double> values;
    for (const Eigen::Vector3d& p : points)
      values.push_back (p[axis]);
    size[axis] = percentile (values, 1.0 - trim) - percentile (values, trim);
  }
  return (size.norm ());
}

std::optional<FittedPlane>
fitDominantPlane (const std::vector<Eigen::Vector3d>& points, double tolerance_m, unsigned seed)
{
  constexpr int trials = 500;
  constexpr int refits = 3;
  if (points.size () < 3)
    return (std::nullopt);
  std::mt19937 random (seed);
  std::uniform_int_distribution<std::size_t> any (0, points.size () - 1);
  FittedPlane best;
  for (int trial = 0; trial < trials; ++trial)
  {
    const Eigen::Vector3d& a = points[any (random)];
    const Eigen::Vector3d& b = points[any (random)];
    const Eigen::Vector3d& c = points[any (random)];
    const Eigen::Vector3d normal = (b - a).cross (c - a);
    if (!(normal.norm () > 0.0))
      continue;
    FittedPlane plane;
    plane.normal = normal.normalized ();
    plane.d = -plane.normal.dot (a);
    plane.inliers = static_cast<std::size_t> (
        std::count_if (points.begin (), points.end (),
                       [&] (const Eigen::Vector3d& p) { return (std::abs (plane.height (p)) <= tolerance_m); }));
    if (plane.inliers > best.inliers)
      best = plane;
  }
  if (best.inliers < 3)
    return (std::nullopt);
  for (int refit = 0; refit < refits; ++refit)
    best = leastSquaresPlane (inliersOf (points, best, tolerance_m));
  return (best);
}

std::optional<VolumeBox>
readVolumeBox (const std::string& vti_path)
{
  constexpr std::size_t longest_header = 4096;
  std::ifstream file (vti_path, std::ios::binary);
  std::string header (longest_header, '\0');
  file.read (header.data (), static_cast<std::streamsize> (longest_header));
  header.resize (static_cast<std::size_t> (file.gcount ()));
  const std::vector<double> extent = xmlAttribute (header, "WholeExtent");
  const std::vector<double> origin = xmlAttribute (header, "Origin");
  const std::vector<double> spacing = xmlAttribute (header, "Spacing");
  if (extent.size () != 6 || origin.size () != 3 || spacing.size () != 3)
    return (std::nullopt);
  VolumeBox volume;
  volume.voxel_size_m = spacing[0];
  for (int axis = 0; axis < 3; ++axis)
  {
    volume.centres.min ()[axis] = origin[axis] + spacing[axis] * extent[2 * axis];
    volume.centres.max ()[axis] = origin[axis] + spacing[axis] * extent[2 * axis + 1];
  }
  return (volume);
}

} // namespace pcl::cosection::test
