// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "support_surfaces.h"

#include "../common/disjoint_sets.h"

#include <pcl/cosection/common/parallel.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <map>

namespace pcl
{
namespace cosection
{

namespace
{

constexpr int block_px = 8;          ///< planes are sought among square blocks of so many pixels
constexpr float flat_block = 0.985f; ///< length of the mean normal of a block that is flat
constexpr float same_plane = 0.94f;  ///< cosine between a block's normal and its plane's: 20 degrees
constexpr float plane_sigmas = 4.0f; ///< distance of a block from its plane; noise and the sensor's distortion
constexpr int max_surfaces = 8;
constexpr float unseen_reach_m = 0.25f; ///< how far a plane goes on beyond the border of the image

/** \brief The mean of a square of pixels that lie on one smooth surface. */
struct Block
{
  Eigen::Vector3f centre, normal;
  float area_m2 = 0.0f; ///< 0: nothing flat there
  float sigma = 0.0f;
};

struct BlockImage
{
  int width, height;
  std::vector<Block> blocks;
};

BlockImage
flatBlocks (const DepthGrid& grid)
{
  BlockImage image{grid.width / block_px, grid.height / block_px, {}};
  image.blocks.resize (static_cast<std::size_t> (image.width) * image.height);
  for (int row = 0; row < image.height; ++row)
    for (int column = 0; column < image.width; ++column)
    {
      Eigen::Vector3f centre = Eigen::Vector3f::Zero (), normal = Eigen::Vector3f::Zero ();
      int n = 0;
      for (int v = row * block_px; v < (row + 1) * block_px; ++v)
        for (int u = column * block_px; u < (column + 1) * block_px; ++u)
        {
          const int i = v * grid.width + u;
          if (!grid.valid (i) || !grid.hasNormal (i))
            continue;
          centre += grid.points[i];
          normal += grid.normals[i];
          ++n;
        }
      if (n < block_px * block_px / 2)
        continue;
      Block& block = image.blocks[row * image.width + column];
      block.centre = centre / static_cast<float> (n);
      if (normal.norm () < flat_block * static_cast<float> (n))
        continue;
      block.normal = normal.normalized ();
      const float pixel_m = grid.pitch * block.centre.z ();
      const float cosine = std::max (0.1f, -block.normal.dot (block.centre.normalized ()));
      block.area_m2 = static_cast<float> (n) * pixel_m * pixel_m / cosine;
      block.sigma = static_cast<float> (depthNoiseSigma (block.centre.z ()));
    }
  return (image);
}

struct Plane
{
  Eigen::Vector3f normal = Eigen::Vector3f::Zero ();
  float offset = 0.0f;

  bool
  holds (const Block& b) const
  {
    return (normal.dot (b.normal) > same_plane && std::abs (normal.dot (b.centre) + offset) < plane_sigmas * b.sigma);
  }
};

/** \brief Least squares through the centres of the blocks, each weighted by its area over its variance. */
Plane
fitPlane (const std::vector<Block>& blocks, const std::vector<int>& members)
{
  double sum = 0.0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero ();
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero ();
  for (const int i : members)
  {
    const double weight = blocks[i].area_m2 / (blocks[i].sigma * blocks[i].sigma);
    const Eigen::Vector3d c = blocks[i].centre.cast<double> ();
    sum += weight;
    mean += weight * c;
    products += weight * c * c.transpose ();
  }
  mean /= sum;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen (products / sum - mean * mean.transpose ());
  Eigen::Vector3d normal = eigen.eigenvectors ().col (0);
  if (normal.dot (mean) > 0.0)
    normal = -normal;
  return {normal.cast<float> (), static_cast<float> (-normal.dot (mean))};
}

/** \brief Groups of members that are no more than two blocks apart. */
std::vector<std::vector<int>>
connectedGroups (const BlockImage& image, const std::vector<int>& members)
{
  std::vector<char> in (image.blocks.size (), 0);
  for (const int i : members)
    in[i] = 1;
  DisjointSets sets (image.blocks.size ());
  for (const int i : members)
    for (int dv = 0; dv <= 2; ++dv)
      for (int du = -2; du <= 2; ++du)
      {
        const int u = i % image.width + du, v = i / image.width + dv;
        if (u >= 0 && u < image.width && v < image.height && in[v * image.width + u])
          sets.unite (i, v * image.width + u);
      }
  std::map<std::size_t, std::vector<int>> groups;
  for (const int i : members)
    groups[sets.find (i)].push_back (i);
  std::vector<std::vector<int>> result;
  for (auto& group : groups)
    result.push_back (std::move (group.second));
  return (result);
}

float
areaOf (const std::vector<Block>& blocks, const std::vector<int>& members)
{
  float area = 0.0f;
  for (const int i : members)
    area += blocks[i].area_m2;
  return (area);
}

float
cross (const Eigen::Vector2f& a, const Eigen::Vector2f& b)
{
  return (a.x () * b.y () - a.y () * b.x ());
}

/** \brief Convex hull, counter-clockwise (A. M. Andrew's monotone chain, 1979). */
std::vector<Eigen::Vector2f>
convexHull (std::vector<Eigen::Vector2f> points)
{
  std::sort (points.begin (), points.end (), [] (const Eigen::Vector2f& a, const Eigen::Vector2f& b) {
    return (a.x () < b.x () || (a.x () == b.x () && a.y () < b.y ()));
  });
  std::vector<Eigen::Vector2f> hull;
  for (int pass = 0; pass < 2; ++pass)
  {
    const std::size_t first = hull.size ();
    for (const Eigen::Vector2f& p : points)
    {
      while (hull.size () >= first + 2 && cross (hull.back () - hull[hull.size () - 2], p - hull.back ()) <= 0.0f)
        hull.pop_back ();
      hull.push_back (p);
    }
    hull.pop_back ();
    std::reverse (points.begin (), points.end ());
  }
  return (hull);
}

Eigen::Matrix<float, 6, 1>
quadricTerms (const DepthGrid& grid, float column, float row)
{
  const float u = 2.0f * column / static_cast<float> (grid.width) - 1.0f;
  const float v = 2.0f * row / static_cast<float> (grid.height) - 1.0f;
  Eigen::Matrix<float, 6, 1> terms;
  terms << 1.0f, u, v, u * u, u * v, v * v;
  return (terms);
}

/** \brief Height of the members' centres as a quadric in the image. */
Eigen::Matrix<float, 6, 1>
fitDistortion (const DepthGrid& grid, const BlockImage& image, const std::vector<int>& members, const Plane& plane)
{
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  Matrix6 lhs =
      1e-3 * static_cast<double> (members.size ()) * Matrix6::Identity (); // damped where the plane is not seen
  Eigen::Matrix<double, 6, 1> rhs = Eigen::Matrix<double, 6, 1>::Zero ();
  for (const int i : members)
  {
    const float half = 0.5f * (block_px - 1);
    const Eigen::Matrix<double, 6, 1> terms =
        quadricTerms (grid, static_cast<float> (i % image.width * block_px) + half,
                      static_cast<float> (i / image.width * block_px) + half)
            .cast<double> ();
    lhs += terms * terms.transpose ();
    rhs += terms * static_cast<double> (plane.normal.dot (image.blocks[i].centre) + plane.offset);
  }
  return (lhs.ldlt ().solve (rhs).cast<float> ());
}

SupportSurface
makeSurface (const DepthGrid& grid, const BlockImage& image, const Plane& plane, const std::vector<int>& members)
{
  SupportSurface surface;
  surface.normal = plane.normal;
  surface.offset = plane.offset;
  surface.area_m2 = areaOf (image.blocks, members);
  surface.axis_u = plane.normal.unitOrthogonal ();
  surface.axis_v = plane.normal.cross (surface.axis_u);
  surface.distortion = fitDistortion (grid, image, members, plane);
  std::vector<Eigen::Vector2f> feet;
  for (const int i : members)
    feet.emplace_back (surface.axis_u.dot (image.blocks[i].centre), surface.axis_v.dot (image.blocks[i].centre));
  surface.outline = convexHull (feet);
  return (surface);
}

/** \brief Diagonal of the outline's box along its longest pair of points. */
float
lengthOf (const std::vector<Eigen::Vector2f>& outline)
{
  float length = 0.0f;
  for (const Eigen::Vector2f& a : outline)
    for (const Eigen::Vector2f& b : outline)
      length = std::max (length, (a - b).norm ());
  return (length);
}

} // namespace

float
SupportSurface::height (const DepthGrid& grid, int u, int v) const
{
  const Eigen::Vector3f& p = grid.points[static_cast<std::size_t> (v) * grid.width + u];
  const float limit = 3.0f * static_cast<float> (depthNoiseSigma (p.z ()));
  return (height (p) - std::clamp (distortion.dot (quadricTerms (grid, static_cast<float> (u), static_cast<float> (v))),
                                   -limit, limit));
}

bool
SupportSurface::carries (const DepthGrid& grid, int pixel, float margin_m) const
{
  const Eigen::Vector3f& p = grid.points[pixel];
  const Eigen::Vector2f place (axis_u.dot (p), axis_v.dot (p));
  float outside_m = outline.empty () ? unseen_reach_m : 0.0f;
  for (std::size_t k = 0; k < outline.size (); ++k)
  {
    const Eigen::Vector2f edge = outline[(k + 1) % outline.size ()] - outline[k];
    outside_m = std::max (outside_m, -cross (edge, place - outline[k]) / std::max (1e-6f, edge.norm ()));
  }
  if (outside_m <= margin_m || outside_m >= unseen_reach_m)
    return (outside_m <= margin_m);
  const Eigen::Vector3f foot = p - height (p) * normal;
  if (foot.z () <= 0.0f)
    return (true);
  const float u = static_cast<float> (pixel % grid.width) + (foot.x () / foot.z () - p.x () / p.z ()) / grid.pitch;
  const float v = static_cast<float> (pixel / grid.width) + (foot.y () / foot.z () - p.y () / p.z ()) / grid.pitch;
  return (u < 0.0f || v < 0.0f || u >= static_cast<float> (grid.width) || v >= static_cast<float> (grid.height));
}

std::vector<SupportSurface>
findSupportSurfaces (const DepthGrid& grid, float max_object_size_m, float min_area_m2)
{
  BlockImage image = flatBlocks (grid);
  std::vector<Block>& blocks = image.blocks;
  std::vector<int> flat;
  for (int i = 0; i < static_cast<int> (blocks.size ()); ++i)
    if (blocks[i].area_m2 > 0.0f)
      flat.push_back (i);
  const auto membersOf = [&] (const Plane& plane) {
    std::vector<int> members;
    for (const int i : flat)
      if (blocks[i].area_m2 > 0.0f && plane.holds (blocks[i]))
        members.push_back (i);
    return (members);
  };

  std::vector<SupportSurface> surfaces;
  for (int tries = 0; tries < 3 * max_surfaces && static_cast<int> (surfaces.size ()) < max_surfaces; ++tries)
  {
    float best_area = 0.0f;
    Plane best;
    for (std::size_t k = 0; k < flat.size (); k += 1 + flat.size () / 600)
    {
      const Block& seed = blocks[flat[k]];
      if (seed.area_m2 <= 0.0f)
        continue;
      const Plane plane{seed.normal, -seed.normal.dot (seed.centre)};
      float area = 0.0f;
      for (const int i : flat)
        area += plane.holds (blocks[i]) ? blocks[i].area_m2 : 0.0f;
      if (area > best_area)
      {
        best_area = area;
        best = plane;
      }
    }
    std::vector<int> members = membersOf (best);
    for (int step = 0; step < 5 && members.size () >= 3; ++step)
    {
      best = fitPlane (blocks, members);
      members = membersOf (best);
    }
    if (members.size () < 3)
      break;
    std::vector<int> large;
    for (const std::vector<int>& group : connectedGroups (image, members))
    {
      const bool first = surfaces.empty () && areaOf (blocks, group) >= min_area_m2;
      if (first || lengthOf (makeSurface (grid, image, best, group).outline) > max_object_size_m)
        large.insert (large.end (), group.begin (), group.end ());
    }
    if (!large.empty ())
      surfaces.push_back (makeSurface (grid, image, best, large));
    else if (areaOf (blocks, members) < 0.5f * min_area_m2)
      break;
    for (const int i : members)
      blocks[i].area_m2 = 0.0f;
  }
  return (surfaces);
}

std::vector<char>
pixelsOnSurfaces (const DepthGrid& grid, const std::vector<SupportSurface>& surfaces, int threads)
{
  std::vector<char> on (grid.points.size (), 0);
  parallelFor (0, grid.height, threads, [&] (int v) {
    for (int u = 0; u < grid.width; ++u)
    {
      const int i = v * grid.width + u;
      if (!grid.valid (i))
        continue;
      for (const SupportSurface& surface : surfaces)
      {
        // A steep face keeps its lowest readings; along the plane there may be more of the sensor's distortion.
        const float cosine = grid.hasNormal (i) ? grid.normals[i].dot (surface.normal) : 0.8f;
        const float sigmas = cosine > 0.9f ? 4.0f : cosine > 0.7f ? 3.0f : 1.5f;
        if (std::abs (surface.height (grid, u, v)) < sigmas * grid.sigma (i))
          on[i] = 1;
      }
    }
  });
  return (on);
}

} // namespace cosection
} // namespace pcl
