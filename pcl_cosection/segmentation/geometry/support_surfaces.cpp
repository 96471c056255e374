// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "support_surfaces.h"

#include "pcl_cosection/common/convex_hull.h"

#include <Eigen/LU>

namespace pcl::cosection {
namespace {

constexpr float unseen_reach_m = 0.25f; ///< how far a plane goes on beyond the border of the image

Eigen::Matrix<float, 6, 1>
quadricTerms (const DepthGrid& grid, float column, float row)
{
  const float u = 2.0f * column / static_cast<float> (grid.width) - 1.0f;
  const float v = 2.0f * row / static_cast<float> (grid.height) - 1.0f;
  Eigen::Matrix<float, 6, 1> terms;
  terms << 1.0f, u, v, u * u, u * v, v * v;
  return (terms);
}

/** \brief Height of the blocks' centres as a quadric in the image. */
Eigen::Matrix<float, 6, 1>
fitDistortion (const DepthGrid& grid, const BlockImage& image, const PlaneProposal& plane)
{
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  // Damped where the plane is not seen.
  Matrix6 lhs = 1e-3 * static_cast<double> (plane.blocks.size ()) * Matrix6::Identity ();
  Eigen::Matrix<double, 6, 1> rhs = Eigen::Matrix<double, 6, 1>::Zero ();
  for (const int i : plane.blocks)
  {
    const float half = 0.5f * (block_px - 1);
    const Eigen::Matrix<double, 6, 1> terms = quadricTerms (grid,
                                                            static_cast<float> (i % image.width * block_px) + half,
                                                            static_cast<float> (i / image.width * block_px) + half)
                                                  .cast<double> ();
    lhs += terms * terms.transpose ();
    rhs += terms * static_cast<double> (plane.normal.dot (image.blocks[i].centre) + plane.offset);
  }
  return (lhs.ldlt ().solve (rhs).cast<float> ());
}

} // namespace

float
SupportSurface::distance (const DepthGrid& grid, int u, int v) const
{
  const int i = v * grid.width + u;
  const float limit = 3.0f * grid.sigma (i);
  const float distorted = distortion.dot (quadricTerms (grid, static_cast<float> (u), static_cast<float> (v)));
  const float height_m = height (grid.points[i]) - std::clamp (distorted, -limit, limit);
  // A steep face keeps its lowest readings; along the plane there may be more of the sensor's distortion.
  const float cosine = grid.hasNormal (i) ? grid.normals[i].dot (normal) : 0.8f;
  const float sigmas = cosine > 0.9f ? 4.0f : cosine > 0.7f ? 3.0f : 1.5f;
  return (std::abs (height_m) / (sigmas * grid.sigma (i)));
}

bool
SupportSurface::carries (const DepthGrid& grid, int pixel, float margin_m) const
{
  const Eigen::Vector3f& p = grid.points[pixel];
  const Eigen::Vector2f at = place (p);
  float outside_m = outline.empty () ? unseen_reach_m : 0.0f;
  for (std::size_t k = 0; k < outline.size (); ++k)
  {
    const Eigen::Vector2f edge = outline[(k + 1) % outline.size ()] - outline[k];
    outside_m = std::max (outside_m, -cross<float> (edge, at - outline[k]) / std::max (1e-6f, edge.norm ()));
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

SupportSurface
makeSurface (const DepthGrid& grid, const BlockImage& image, const PlaneProposal& plane)
{
  SupportSurface surface;
  surface.normal = plane.normal;
  surface.offset = plane.offset;
  surface.area_m2 = plane.area_m2;
  surface.axis_u = plane.normal.unitOrthogonal ();
  surface.axis_v = plane.normal.cross (surface.axis_u);
  surface.distortion = fitDistortion (grid, image, plane);
  std::vector<Eigen::Vector2f> feet;
  for (const int i : plane.blocks)
    feet.push_back (surface.place (image.blocks[i].centre));
  surface.outline = convexHull (feet);
  return (surface);
}

std::vector<SupportSurface>
findSupportSurfaces (const DepthGrid& grid, float max_object_size_m, float min_area_m2)
{
  const BlockImage image = findPlanarBlocks (grid, false);
  std::vector<SupportSurface> surfaces;
  for (const PlaneProposal& plane : proposePlanes (image, max_object_size_m, min_area_m2))
    if (plane.large || (surfaces.empty () && plane.area_m2 >= min_area_m2))
      surfaces.push_back (makeSurface (grid, image, plane));
  return (surfaces);
}

} // namespace pcl::cosection
