// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
// Written by hand, because VTK's cell locators do not say whether a face, an edge or a corner is nearest, which the
// sign of the distance depends on.

#include "triangle_tree.h"

#include <algorithm>
#include <array>

namespace pcl::cosection {
namespace {

constexpr std::uint32_t faces_of_leaf = 4;
constexpr int max_depth = 64;     // halves of 2^32 triangles are deep enough by far
constexpr double rounding = 1e-9; // relative, of squared distances; far more than they can be off

} // namespace

TriangleTree::TriangleTree (const TriangleMesh& mesh)
{
  faces_.resize (mesh.triangles.size ());
  for (std::uint32_t t = 0; t < faces_.size (); ++t)
  {
    Face& face = faces_[t];
    for (int n = 0; n < 3; ++n)
      face.corners[n] = mesh.vertices[mesh.triangles[t][n]].cast<double> ();
    face.normal = (face.corners[1] - face.corners[0]).cross (face.corners[2] - face.corners[0]).normalized ();
    for (int n = 0; n < 3; ++n)
      face.outward[n] = (face.corners[(n + 1) % 3] - face.corners[n]).cross (face.normal).normalized ();
    face.triangle = t;
  }
  nodes_.reserve (faces_.size ());
  nodes_.emplace_back ();
  build (0, 0, static_cast<std::uint32_t> (faces_.size ()));
  place_.resize (faces_.size ());
  for (std::uint32_t n = 0; n < faces_.size (); ++n)
    place_[faces_[n].triangle] = n;
}

void
TriangleTree::build (std::uint32_t node, std::uint32_t first, std::uint32_t last)
{
  Eigen::AlignedBox3d box, centres;
  const auto centre = [] (const Face& face) -> Eigen::Vector3d {
    return face.corners[0] + face.corners[1] + face.corners[2];
  };
  for (std::uint32_t n = first; n < last; ++n)
  {
    for (const Eigen::Vector3d& corner : faces_[n].corners)
      box.extend (corner);
    centres.extend (centre (faces_[n]));
  }
  nodes_[node].low = box.min ().cast<float> (); // exact: corners are floats
  nodes_[node].high = box.max ().cast<float> ();
  if (last - first <= faces_of_leaf)
  {
    nodes_[node].first = first;
    nodes_[node].count = last - first;
    return;
  }
  int axis = 0;
  centres.sizes ().maxCoeff (&axis);
  const std::uint32_t middle = first + (last - first) / 2;
  std::nth_element (faces_.begin () + first, faces_.begin () + middle, faces_.begin () + last,
                    [&] (const Face& a, const Face& b) {
                      const double u = centre (a)[axis];
                      const double v = centre (b)[axis];
                      return u != v ? u < v : a.triangle < b.triangle;
                    });
  const auto children = static_cast<std::uint32_t> (nodes_.size ());
  nodes_.emplace_back ();
  nodes_.emplace_back ();
  nodes_[node].first = children;
  build (children, first, middle);
  build (children + 1, middle, last);
}

void
TriangleTree::compare (const Face& face, const Eigen::Vector3d& p, NearestPoint& nearest)
{
  const auto isFarther = [&] (double squared) { return squared * (1.0 - rounding) > nearest.squared_m2; };
  const auto isNearer = [&] (double squared) {
    return squared < nearest.squared_m2 || (squared == nearest.squared_m2 && face.triangle < nearest.triangle);
  };
  const Eigen::Vector3d to_p[3] = {p - face.corners[0], p - face.corners[1], p - face.corners[2]};
  const double height = face.normal.dot (to_p[0]);
  const double squared_height = height * height;
  if (isFarther (squared_height))
    return;
  double beyond[3];
  for (int n = 0; n < 3; ++n)
  {
    beyond[n] = face.outward[n].dot (to_p[n]);
    if (beyond[n] > 0.0 && isFarther (squared_height + beyond[n] * beyond[n]))
      return;
  }
  if (beyond[0] <= 0.0 && beyond[1] <= 0.0 && beyond[2] <= 0.0)
  {
    if (isNearer (squared_height))
      nearest = {squared_height, face.triangle, NearestPoint::Face, height * face.normal};
    return;
  }
  // The nearest point is on the border, on one of the sides that p is beyond.
  for (int n = 0; n < 3; ++n)
  {
    if (beyond[n] <= 0.0)
      continue;
    const int m = (n + 1) % 3;
    const Eigen::Vector3d side = face.corners[m] - face.corners[n];
    const double along = side.dot (to_p[n]);
    const double squared_length = side.squaredNorm ();
    NearestPoint found;
    found.triangle = face.triangle;
    found.feature = static_cast<std::uint8_t> (along <= 0.0              ? NearestPoint::Vertex + n
                                               : along >= squared_length ? NearestPoint::Vertex + m
                                                                         : NearestPoint::Edge + n);
    if (along <= 0.0)
      found.offset_m = to_p[n];
    else if (along >= squared_length)
      found.offset_m = to_p[m];
    else
      found.offset_m = to_p[n] - along / squared_length * side;
    found.squared_m2 = found.offset_m.squaredNorm ();
    if (isNearer (found.squared_m2))
      nearest = found;
  }
}

NearestPoint
TriangleTree::nearest (const Eigen::Vector3d& p, double bound_m, std::uint32_t hint) const
{
  struct Pending
  {
    std::uint32_t node;
    double squared_m2;
  };
  std::array<Pending, max_depth> stack;
  int size = 0;
  NearestPoint nearest;
  constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max ();
  nearest.squared_m2 = bound_m * bound_m;
  nearest.triangle = none;
  compare (faces_[place_[hint]], p, nearest);
  // Equally near triangles are compared too, so the result does not depend on the order of the search.
  const auto mayHold = [&] (double squared) { return squared * (1.0 - rounding) <= nearest.squared_m2; };
  const auto squaredDistance = [&] (std::uint32_t n) {
    double sum = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double beyond = std::max ({nodes_[n].low[axis] - p[axis], p[axis] - nodes_[n].high[axis], 0.0});
      sum += beyond * beyond;
    }
    return sum;
  };
  stack[size++] = {0, squaredDistance (0)};
  while (size > 0)
  {
    const Pending pending = stack[--size];
    if (!mayHold (pending.squared_m2))
      continue;
    const Node& node = nodes_[pending.node];
    if (node.count > 0)
    {
      for (std::uint32_t n = node.first; n < node.first + node.count; ++n)
        compare (faces_[n], p, nearest);
      continue;
    }
    Pending near = {node.first, squaredDistance (node.first)};
    Pending far = {node.first + 1, squaredDistance (node.first + 1)};
    if (far.squared_m2 < near.squared_m2)
      std::swap (near, far);
    if (mayHold (far.squared_m2))
      stack[size++] = far;
    stack[size++] = near;
  }
  if (nearest.triangle == none)
    nearest.squared_m2 = std::numeric_limits<double>::infinity ();
  return nearest;
}

} // namespace pcl::cosection
