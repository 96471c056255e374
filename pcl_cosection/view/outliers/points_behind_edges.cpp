// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "points_behind_edges.h"

#include "pcl_cosection/view/visibility/depth_edges.h"

#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/view/normals/estimated_normals.h"

#include <pcl/cosection/common/camera.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr int spacing_neighbours = 6;
constexpr float reach_to_spacing = 0.72f; // square root of pi / 6: as many neighbours, a point in each square
constexpr float beside_spacings = 1.25f;  // from a point of an edge in the image
constexpr float behind_spacings = 6.0f;   // a surface of up to 78 degrees to the image falls off less on that way
constexpr float lonely_factor = 3.0f;     // of the usual spacing: trails have fewer points than surfaces
// A share of the usual distance in the image, that of the nearest pixels; means in cells have 0.5 to 0.8.
constexpr float regular = 0.93f;
constexpr float pixels_per_spacing = 1.5f; // of the most dense points
constexpr double most_dense = 0.1;         // share of all points
constexpr float most_pixels = 2048.0f;     // along a side
constexpr float most_pixels_beside = 30.0f;
constexpr float nearest_m = 1e-4f; // and ...
constexpr float farthest_m = 1e5f; // ... of what can be judged
constexpr float steepest = 10.0f;  // slope of a ray to the camera's axis

/** \brief Is it before the camera, so that it has a place in the image? */
bool
isBefore (const Eigen::Vector3f& point)
{
  return point.z () > nearest_m && point.z () < farthest_m && point.head<2> ().norm () < steepest * point.z ();
}

/** \brief Values of which such shares of all are smaller. */
template <std::size_t N>
std::array<float, N>
valuesOf (std::vector<float> values, const std::array<double, N>& shares)
{
  std::array<float, N> result;
  for (std::size_t n = 0; n < N; ++n)
    result[n] = quantile (values, shares[n]);
  return result;
}

/** \brief Are the points one per pixel of an image, so that the nearest one in the image is nowhere much nearer than is
 * usual? */
bool
isImage (const std::vector<Eigen::Vector3f>& points, int threads)
{
  std::vector<Eigen::Vector3f> slopes;
  slopes.reserve (points.size ());
  for (const Eigen::Vector3f& point : points)
    slopes.emplace_back (point.x () / point.z (), point.y () / point.z (), 0.0f);
  const auto [near, usual] = valuesOf<2> (neighbourDistances (slopes, 1, threads), {most_dense, 0.5});
  return near > regular * usual;
}

/** \brief From which depth on what is seen in a pixel is behind some point beside it. */
class DepthLimit
{
public:
  DepthLimit (const std::vector<Eigen::Vector3f>& points, const std::vector<float>& spacings)
  {
    std::vector<float> angles;
    angles.reserve (points.size ());
    for (std::size_t i = 0; i < points.size (); ++i)
    {
      slopes_.extend (slopeOf (points[i]));
      angles.push_back (spacings[i] / points[i].z ());
    }
    pixel_ = std::max ({valuesOf<1> (std::move (angles), {most_dense})[0] / pixels_per_spacing,
                        slopes_.sizes ().maxCoeff () / most_pixels, std::numeric_limits<float>::min ()});
    size_ = (slopes_.sizes () / pixel_).cast<int> ().array () + 1;
    limit_.assign (static_cast<std::size_t> (size_.x ()) * size_.y (), std::numeric_limits<float>::infinity ());
  }

  void add (const Eigen::Vector3f& point, float spacing)
  {
    const float z = point.z ();
    const float behind = z + std::max (behind_spacings * spacing, static_cast<float> (smallestEdgeStep (z)));
    const float radius = std::min (most_pixels_beside, beside_spacings * spacing / z / pixel_);
    const Eigen::Array2f centre = place (point);
    const Eigen::Array2i first = (centre - radius).ceil ().cast<int> ().max (0);
    const Eigen::Array2i last = (centre + radius).floor ().cast<int> ().min (size_ - 1);
    for (int v = first.y (); v <= last.y (); ++v)
      for (int u = first.x (); u <= last.x (); ++u)
        if ((Eigen::Array2f (static_cast<float> (u), static_cast<float> (v)) - centre).matrix ().squaredNorm () <=
            radius * radius)
        {
          float& limit = limit_[static_cast<std::size_t> (v) * size_.x () + u];
          limit = std::min (limit, behind);
        }
  }

  bool isBehind (const Eigen::Vector3f& point) const
  {
    const Eigen::Array2i at = place (point).round ().cast<int> ().max (0).min (size_ - 1);
    return point.z () > limit_[static_cast<std::size_t> (at.y ()) * size_.x () + at.x ()];
  }

private:
  static Eigen::Vector2f slopeOf (const Eigen::Vector3f& point) { return point.head<2> () / point.z (); }

  /** \brief In pixels. */
  Eigen::Array2f place (const Eigen::Vector3f& point) const
  {
    return (slopeOf (point) - slopes_.min ()).array () / pixel_;
  }

  Eigen::AlignedBox2f slopes_;
  float pixel_ = 0.0f;
  Eigen::Array2i size_;
  std::vector<float> limit_;
};

} // namespace

std::vector<bool>
findBehindEdges (const std::vector<Eigen::Vector3f>& points, int threads)
{
  std::vector<bool> behind (points.size ());
  if (points.empty () || !std::all_of (points.begin (), points.end (), isBefore) || // wide off, numbers say nothing
      isImage (points, threads))
    return behind;
  std::vector<float> spacings = neighbourDistances (points, spacing_neighbours, threads);
  for (float& spacing : spacings)
    spacing *= reach_to_spacing;
  const float lonely = lonely_factor * valuesOf<1> (spacings, {0.5})[0];
  DepthLimit limit (points, spacings);
  for (std::size_t i = 0; i < points.size (); ++i)
    limit.add (points[i], spacings[i]);
  for (std::size_t i = 0; i < points.size (); ++i)
    behind[i] = spacings[i] > lonely && limit.isBehind (points[i]);
  return behind;
}

} // namespace pcl::cosection
