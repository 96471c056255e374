// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "frame_segmentation.h"

#include "unassigned_components.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace pcl::cosection
{

namespace
{

constexpr double growth_m = 0.03;     // in one frame, beyond what an object's model knows
constexpr float same_surface = 0.02f; // of the depth: a larger step to the next pixel leads to another surface
constexpr std::uint8_t first_unknown = 0;
constexpr std::uint8_t first_free = 2;

bool
isWithin (const AssociatedModel& model, const Eigen::Vector3f& point)
{
  return model.volume->grid ().nearest (model.T_model_sensor * point.cast<double> ()).has_value ();
}

/** \brief Let objects take unassigned pixels beside theirs, one ring after the other. */
void
growObjects (const FrameCloud& cloud, const std::vector<AssociatedModel>& models, const std::vector<std::uint16_t>& ids,
             const PointAssignment& assignment, const DataAssociation& association, ObjectGrowth growth,
             Image<std::uint16_t>& labels)
{
  std::vector<bool> unassigned;
  UnassignedComponents regions;
  std::map<std::uint16_t, std::size_t> pixels;
  if (growth == ObjectGrowth::Small)
  {
    for (const std::uint16_t label : labels.pixels)
    {
      unassigned.push_back (label == FrameSegmentation::unassigned);
      ++pixels[label];
    }
    regions = findUnassignedComponents (unassigned, cloud);
  }
  const int width = labels.width;
  const int height = labels.height;
  std::map<std::uint16_t, std::size_t> model_of;
  for (std::size_t m = 1; m < ids.size (); ++m)
    model_of[ids[m]] = m;
  std::vector<std::pair<std::size_t, Eigen::Vector3f>> front; // pixel, and where its growth began
  for (std::size_t n = 0; n < labels.pixels.size (); ++n)
    if (model_of.count (labels.pixels[n]) > 0)
      front.emplace_back (n, cloud.points[n]);
  while (!front.empty ())
  {
    std::vector<std::pair<std::size_t, Eigen::Vector3f>> next;
    for (const auto& [n, origin] : front)
    {
      const int u = static_cast<int> (n) % width;
      const int v = static_cast<int> (n) / width;
      const std::uint16_t id = labels.pixels[n];
      const AssociatedModel& model = models[model_of.at (id)];
      for (const auto& [du, dv] : {std::pair (-1, 0), std::pair (1, 0), std::pair (0, -1), std::pair (0, 1)})
      {
        if (u + du < 0 || v + dv < 0 || u + du >= width || v + dv >= height)
          continue;
        const std::size_t beside = static_cast<std::size_t> (v + dv) * width + u + du;
        if (labels.pixels[beside] != FrameSegmentation::unassigned || assignment.first[beside] != first_free)
          continue;
        if (growth == ObjectGrowth::Small && !regions.mayBelongTo (regions.of_pixel[beside], pixels[id]))
          continue;
        const Eigen::Vector3f& p = cloud.points[beside];
        if (std::abs (p.z () - cloud.points[n].z ()) > same_surface * p.z () || (p - origin).norm () > growth_m ||
            !isWithin (model, p) || association.evidence (model, p).free)
          continue;
        labels.pixels[beside] = id;
        next.emplace_back (beside, origin);
      }
    }
    front.swap (next);
  }
}

} // namespace

FrameSegmentation
segmentFrame (const FrameCloud& cloud, const std::vector<AssociatedModel>& models,
              const std::vector<std::uint16_t>& ids, const DataAssociation& association, ObjectGrowth growth)
{
  const PointAssignment assignment = association.assign (cloud.points, models);
  FrameSegmentation result;
  result.labels = Image<std::uint16_t> (cloud.camera.width, cloud.camera.height, 0);
  std::vector<double> sums (models.size (), 0.0);
  std::vector<std::size_t> counts (models.size (), 0);
  for (std::size_t n = 0; n < cloud.points.size (); ++n)
  {
    const std::uint8_t model = assignment.model[n];
    if (model == PointAssignment::no_point)
      continue;
    if (model != PointAssignment::none)
    {
      result.labels.pixels[n] = ids[model];
      sums[model] += assignment.probability[n];
      ++counts[model];
      continue;
    }
    bool open = assignment.first[n] == first_free;
    if (assignment.first[n] == first_unknown)
      for (std::size_t m = 1; m < models.size () && !open; ++m)
        open = isWithin (models[m], cloud.points[n]);
    if (open)
      result.labels.pixels[n] = FrameSegmentation::unassigned;
  }
  for (std::size_t m = 1; m < models.size (); ++m)
    if (counts[m] > 0)
      result.mean_probability[ids[m]] = sums[m] / static_cast<double> (counts[m]);
  growObjects (cloud, models, ids, assignment, association, growth, result.labels);
  return result;
}

void
applyMask (const FrameCloud& cloud, const Image<std::uint16_t>& mask,
           const std::map<std::uint16_t, std::uint16_t>& object_of, const std::vector<AssociatedModel>& models,
           const std::vector<std::uint16_t>& ids, const DataAssociation& association, FrameSegmentation& segmentation)
{
  std::map<std::uint16_t, std::size_t> model_of;
  for (std::size_t m = 1; m < ids.size (); ++m)
    model_of[ids[m]] = m;
  std::set<std::uint16_t> matched;
  for (const auto& [instance, object] : object_of)
    matched.insert (object);
  for (std::size_t n = 0; n < cloud.points.size (); ++n)
  {
    const Eigen::Vector3f& p = cloud.points[n];
    if (!std::isfinite (p.z ()))
      continue;
    std::uint16_t& label = segmentation.labels.pixels[n];
    const std::uint16_t instance = mask.pixels[n];
    if (instance == FrameSegmentation::unassigned)
    {
      label = FrameSegmentation::unassigned;
      continue;
    }
    if (instance == 0)
    {
      if (label == FrameSegmentation::unassigned || matched.count (label) > 0)
        label = association.evidence (models[0], p).free ? FrameSegmentation::unassigned : 0;
      continue;
    }
    const auto object = object_of.find (instance);
    if (object == object_of.end ())
    {
      if (label == 0)
        label = FrameSegmentation::unassigned;
      continue;
    }
    const auto model = model_of.find (object->second);
    if (model != model_of.end () && association.evidence (models[model->second], p).free)
    {
      if (label == object->second)
        label = FrameSegmentation::unassigned;
      continue;
    }
    label = object->second;
  }
}

Image<std::uint16_t>
widened (const Image<std::uint16_t>& labels, int pixels)
{
  Image<std::uint16_t> result = labels;
  for (const bool rows : {true, false})
  {
    const Image<std::uint16_t> before = result;
    const int length = rows ? labels.width : labels.height;
    const int lines = rows ? labels.height : labels.width;
    for (int line = 0; line < lines; ++line)
      for (int n = 0; n < length; ++n)
      {
        const std::uint16_t label = rows ? before.at (n, line) : before.at (line, n);
        if (label == 0)
          continue;
        for (int m = std::max (0, n - pixels); m <= std::min (length - 1, n + pixels); ++m)
        {
          std::uint16_t& other = rows ? result.at (m, line) : result.at (line, m);
          if (other == 0)
            other = label;
        }
      }
  }
  return result;
}

} // namespace pcl::cosection
