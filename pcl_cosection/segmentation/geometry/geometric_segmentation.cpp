// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/segmentation/geometric_segmentation.h>

#include "object_assembly.h"
#include "pcl_cosection/common/console_errors.h"
#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/common/require.h"
#include "vessel_floors.h"

#include <pcl/cosection/surface/normals.h>

#include <pcl/impl/pcl_base.hpp>
#include <pcl/point_types.h>

#include <algorithm>
#include <numeric>

namespace pcl::cosection {
namespace {

constexpr double seen_height = 1.5;       ///< in sizes of the largest object: what is too large must be seen to be
constexpr float outline_margin_m = 0.05f; ///< how far beyond the seen part of its support something may reach

/** \brief Median distance of horizontal neighbours over their depth; 0 without neighbours. */
float
columnPitch (const std::vector<Eigen::Vector3f>& points, int width, int height)
{
  std::vector<float> pitches;
  const int step = std::max (1, height / 60);
  for (int v = 0; v < height; v += step)
    for (int u = 0; u + 1 < width; u += step)
    {
      const Eigen::Vector3f& a = points[static_cast<std::size_t> (v) * width + u];
      const Eigen::Vector3f& b = points[static_cast<std::size_t> (v) * width + u + 1];
      const float pitch = std::abs (b.x () / b.z () - a.x () / a.z ());
      if (std::isfinite (pitch) && a.z () > 0.0f && b.z () > 0.0f)
        pitches.push_back (pitch);
    }
  return (pitches.empty () ? 0.0f : upperMedian (pitches));
}

/** \brief One per pixel: whether it is above the seen part of a support surface, on none of them, and not too high. */
std::vector<char>
pixelsAbove (const DepthGrid& grid, const Room& room, const ObjectSegmentationOptions& options)
{
  std::vector<char> above (grid.points.size (), 0);
  const auto highest = static_cast<float> (seen_height * options.max_object_size_m);
  parallelFor (0, static_cast<int> (above.size ()), options.threads, [&] (int i) {
    if (!grid.valid (i) || room.surface_of[i] >= 0)
      return;
    for (const SupportSurface& surface : room.surfaces)
    {
      const float height = surface.height (grid.points[i]);
      if (height > 0.0f && height < highest && surface.carries (grid, i, outline_margin_m))
        above[i] = 1;
    }
  });
  return (above);
}

/** \brief Number the objects anew, the largest in the image first. */
void
numberBySize (ObjectSegmentation& found)
{
  std::vector<std::size_t> pixels (found.objects + 1, 0);
  for (const std::uint32_t label : found.labels)
    ++pixels[label];
  std::vector<std::uint32_t> order (found.objects), number (found.objects + 1, 0);
  std::iota (order.begin (), order.end (), 1u);
  std::stable_sort (order.begin (), order.end (),
                    [&] (std::uint32_t a, std::uint32_t b) { return pixels[a] > pixels[b]; });
  for (std::uint32_t n = 0; n < found.objects; ++n)
    number[order[n]] = n + 1;
  for (std::uint32_t& label : found.labels)
    label = number[label];
}

} // namespace

void
ObjectSegmentationOptions::validate () const
{
  require (isPositive (max_object_size_m), "segmentation: max_object_size_m must be positive and finite");
  require (min_object_size_m > 0.0 && min_object_size_m < max_object_size_m,
           "segmentation: min_object_size_m must be positive and less than max_object_size_m");
  require (isPositive (min_support_area_m2), "segmentation: min_support_area_m2 must be positive and finite");
  require (concave_angle_rad > 0.0 && concave_angle_rad < 1.58,
           "segmentation: concave_angle_rad must be between 0 and pi / 2");
}

ObjectSegmentation
segmentObjects (const std::vector<Eigen::Vector3f>& points, int width, int height,
                const ObjectSegmentationOptions& options)
{
  options.validate ();
  requireImage ("segmentation", points.size (), width, height);
  const float pitch = columnPitch (points, width, height);
  if (pitch <= 0.0f)
    throw DegenerateInput ("the cloud has no two neighbouring readings in a row of its image, in front of the camera");
  OrganizedNormalsOptions normal_options;
  normal_options.threads = options.threads;
  const std::vector<Eigen::Vector3f> normals = computeOrganizedNormals (points, width, height, {}, normal_options);
  const DepthGrid grid{points, normals, width, height, pitch};
  const Room room = findRoom (grid, static_cast<float> (options.max_object_size_m),
                              static_cast<float> (options.min_support_area_m2), options.threads);
  if (room.surfaces.empty ())
    throw DegenerateInput ("no plane in view that objects could stand on");

  PatchImage patches = computeSurfacePatches (grid, pixelsAbove (grid, room, options), options.threads);
  removePatches (patches, findRoomEdges (grid, room, patches));
  const PatchEvidence evidence = convexityEvidence (grid, patches, static_cast<float> (options.concave_angle_rad));
  std::vector<int> object_of_patch = contractEdges (patches.patches.size (), evidence);
  ObjectSegmentation result;
  result.objects = static_cast<std::uint32_t> (assembleObjects (grid, room, patches, options, object_of_patch));
  result.labels.resize (points.size (), 0);
  result.too_long.resize (points.size (), 0);
  for (std::size_t i = 0; i < points.size (); ++i)
    if (patches.patch_of[i] >= 0)
    {
      const int object = object_of_patch[patches.patch_of[i]];
      result.labels[i] = object >= 0 ? static_cast<std::uint32_t> (object + 1) : 0;
      result.too_long[i] = object == too_long_object;
    }
  labelVesselFloors (grid, room, result.labels);
  numberBySize (result);
  for (const SupportSurface& surface : room.surfaces)
    result.support_planes.emplace_back (surface.normal.x (), surface.normal.y (), surface.normal.z (), surface.offset);
  return (result);
}

bool
GeometricSegmentationBase::setOptions (const ObjectSegmentationOptions& options)
{
  return reportErrors ("cosection::GeometricSegmentation::setOptions", [&] {
    options.validate ();
    options_ = options;
  });
}

bool
GeometricSegmentationBase::setMaximumObjectSize (double size_m)
{
  ObjectSegmentationOptions options = options_;
  options.max_object_size_m = size_m;
  return setOptions (options);
}

bool
GeometricSegmentationBase::setMinimumObjectSize (double size_m)
{
  ObjectSegmentationOptions options = options_;
  options.min_object_size_m = size_m;
  return setOptions (options);
}

bool
GeometricSegmentationBase::setConcaveAngle (double angle_rad)
{
  ObjectSegmentationOptions options = options_;
  options.concave_angle_rad = angle_rad;
  return setOptions (options);
}

void
GeometricSegmentationBase::setNumberOfThreads (unsigned int threads)
{
  options_.threads = static_cast<int> (threads);
}

bool
GeometricSegmentationBase::begin (bool input, unsigned int width, unsigned int height)
{
  support_planes_.clear ();
  if (!input)
    PCL_ERROR ("[pcl::cosection::GeometricSegmentation::segment] There is no input cloud.\n");
  else if (height <= 1)
    PCL_ERROR ("[pcl::cosection::GeometricSegmentation::segment] The input cloud is not organised: its height is %u.\n",
               height);
  return input && height > 1 && width > 0;
}

void
GeometricSegmentationBase::segmentPoints (const std::vector<Eigen::Vector3f>& points, int width, int height,
                                          const pcl::PCLHeader& header, pcl::PointCloud<pcl::Label>& labels,
                                          std::vector<pcl::PointIndices>& label_indices)
{
  ObjectSegmentation found;
  if (!reportErrors ("cosection::GeometricSegmentation::segment",
                     [&] { found = segmentObjects (points, width, height, options_); }))
    return;
  labels.header = header;
  labels.resize (found.labels.size ());
  labels.width = static_cast<std::uint32_t> (width);
  labels.height = static_cast<std::uint32_t> (height);
  label_indices.resize (found.objects);
  for (pcl::PointIndices& indices : label_indices)
    indices.header = header;
  for (std::size_t i = 0; i < found.labels.size (); ++i)
  {
    labels[i].label = found.labels[i];
    if (found.labels[i] > 0)
      label_indices[found.labels[i] - 1].indices.push_back (static_cast<pcl::index_t> (i));
  }
  for (const Eigen::Vector4f& plane : found.support_planes)
  {
    support_planes_.emplace_back ();
    support_planes_.back ().header = header;
    support_planes_.back ().values.assign (plane.data (), plane.data () + 4);
  }
}

} // namespace pcl::cosection

BOOST_PP_SEQ_FOR_EACH (PCL_COSECTION_TEMPLATE, pcl::cosection::GeometricSegmentation, PCL_COSECTION_XYZ_POINT_TYPES)
