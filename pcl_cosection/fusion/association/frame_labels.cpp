// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "frame_labels.h"

#include "unassigned_components.h"
#include <pcl/cosection/fusion/frame_segmenter.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr std::uint16_t unassigned = TrackedFrame::unassigned;
constexpr double growth_m = 0.03;     // in one frame, beyond the space that an object's model knows
constexpr float same_surface = 0.02f; // of the depth: a larger step to the next pixel leads to another surface
constexpr std::uint8_t background_unknown = 0;
constexpr std::uint8_t background_free = 2;

bool
isWithin (const AssociatedModel& model, const Eigen::Vector3f& point)
{
  return model.volume->grid ().nearest (model.T_model_sensor * point.cast<double> ()).has_value ();
}

std::map<std::uint16_t, std::size_t>
modelsByLabel (const SceneModels& scene)
{
  std::map<std::uint16_t, std::size_t> model_of;
  for (std::size_t m = 1; m < scene.models.size (); ++m)
    model_of[scene.label (m)] = m;
  return model_of;
}

} // namespace

PixelAssociation
associatePixels (const FrameCloud& cloud, const SceneModels& scene, const DataAssociation& association)
{
  const std::vector<AssociatedModel>& models = scene.models;
  const PointAssignment assignment = association.assign (cloud.points, models);
  PixelAssociation result{LabelImage (cloud.camera.width, cloud.camera.height, 0), {}, assignment.first};
  std::vector<double> sums (models.size (), 0.0);
  std::vector<std::size_t> counts (models.size (), 0);
  for (std::size_t n = 0; n < cloud.points.size (); ++n)
  {
    const std::uint8_t model = assignment.model[n];
    if (model == PointAssignment::no_point)
      continue;
    if (model != PointAssignment::none)
    {
      result.labels.pixels[n] = scene.label (model);
      sums[model] += assignment.probability[n];
      ++counts[model];
      continue;
    }
    bool open = assignment.first[n] == background_free;
    if (assignment.first[n] == background_unknown)
      for (std::size_t m = 1; m < models.size () && !open; ++m)
        open = isWithin (models[m], cloud.points[n]);
    if (open)
      result.labels.pixels[n] = unassigned;
  }
  for (std::size_t m = 1; m < models.size (); ++m)
    if (counts[m] > 0)
      result.mean_probability[scene.label (m)] = sums[m] / static_cast<double> (counts[m]);
  return result;
}

LabelImage
growObjects (const PixelAssociation& associated, const FrameCloud& cloud, const SceneModels& scene,
             const DataAssociation& association, ObjectGrowth growth)
{
  LabelImage labels = associated.labels;
  std::optional<UnassignedComponents> components; // of which only small ones may join
  std::map<std::uint16_t, std::size_t> pixels_of; // labels
  if (growth == ObjectGrowth::Small)
  {
    std::vector<bool> is_unassigned;
    for (const std::uint16_t label : labels.pixels)
    {
      is_unassigned.push_back (label == unassigned);
      ++pixels_of[label];
    }
    components = findUnassignedComponents (is_unassigned, cloud);
  }
  const std::map<std::uint16_t, std::size_t> model_of = modelsByLabel (scene);
  std::vector<std::pair<std::size_t, Eigen::Vector3f>> front; // pixel, and where its growth began
  for (std::size_t n = 0; n < labels.pixels.size (); ++n)
    if (model_of.count (labels.pixels[n]) > 0)
      front.emplace_back (n, cloud.points[n]);
  while (!front.empty ())
  {
    std::vector<std::pair<std::size_t, Eigen::Vector3f>> next;
    for (const auto& [n, origin] : front)
    {
      const int u = static_cast<int> (n) % labels.width;
      const int v = static_cast<int> (n) / labels.width;
      const std::uint16_t label = labels.pixels[n];
      const AssociatedModel& model = scene.models[model_of.at (label)];
      for (const auto& [du, dv] : {std::pair (-1, 0), std::pair (1, 0), std::pair (0, -1), std::pair (0, 1)})
      {
        if (u + du < 0 || v + dv < 0 || u + du >= labels.width || v + dv >= labels.height)
          continue;
        const std::size_t beside = static_cast<std::size_t> (v + dv) * labels.width + u + du;
        if (labels.pixels[beside] != unassigned || associated.background[beside] != background_free ||
            (components && !components->mayBelongTo (components->of_pixel[beside], pixels_of.at (label))))
          continue;
        const Eigen::Vector3f& p = cloud.points[beside];
        if (std::abs (p.z () - cloud.points[n].z ()) > same_surface * p.z () || (p - origin).norm () > growth_m ||
            !isWithin (model, p) || association.evidence (model, p).free)
          continue;
        labels.pixels[beside] = label;
        next.emplace_back (beside, origin);
      }
    }
    front.swap (next);
  }
  return labels;
}

LabelImage
relabelled (LabelImage labels, const LabelMap& new_label)
{
  if (!new_label.empty ())
    for (std::uint16_t& label : labels.pixels)
      if (const auto found = new_label.find (label); found != new_label.end ())
        label = found->second;
  return labels;
}

LabelImage
applyMask (LabelImage labels, const Image<std::uint16_t>& mask, const LabelMap& object_of, const FrameCloud& cloud,
           const SceneModels& scene, const DataAssociation& association)
{
  const std::map<std::uint16_t, std::size_t> model_of = modelsByLabel (scene);
  std::set<std::uint16_t> matched;
  for (const auto& [instance, object] : object_of)
    matched.insert (object);
  for (std::size_t n = 0; n < cloud.points.size (); ++n)
  {
    const Eigen::Vector3f& p = cloud.points[n];
    if (!std::isfinite (p.z ()))
      continue;
    std::uint16_t& label = labels.pixels[n];
    const std::uint16_t instance = mask.pixels[n];
    const auto object = object_of.find (instance);
    if (instance == FrameSegmenter::ignored)
      label = unassigned;
    else if (instance == 0)
    {
      if (label == unassigned || matched.count (label) > 0)
        label = association.evidence (scene.models[0], p).free ? unassigned : 0;
    }
    else if (object == object_of.end ())
      label = label == 0 ? unassigned : label;
    else
    {
      const auto model = model_of.find (object->second);
      if (model == model_of.end () || !association.evidence (scene.models[model->second], p).free)
        label = object->second;
      else if (label == object->second)
        label = unassigned;
    }
  }
  return labels;
}

LabelImage
withoutMoving (LabelImage labels, const MovingParts& moving, const FrameCloud& cloud)
{
  const Image<std::uint8_t> moves = movingPixels (moving, cloud, labels);
  for (std::size_t n = 0; n < labels.pixels.size (); ++n)
    if (moves.pixels[n])
      labels.pixels[n] = unassigned;
  return labels;
}

LabelImage
withoutLost (LabelImage labels, const ObjectMap& objects, const PosedFrame& frame)
{
  for (const auto& [id, object] : objects.by_id)
    if (object.state == ObjectState::Lost)
      for (std::size_t n = 0; n < frame.cloud.points.size (); ++n)
      {
        const Eigen::Vector3d p = frame.T_world_camera * frame.cloud.points[n].cast<double> ();
        const auto cell = object.volume->sample<float> (
            Eigen::Vector3f ((object.T_world_object.inverse () * p).cast<float> ()));
        if (labels.pixels[n] == 0 && cell && cell->value () < 0.5 * object.volume->truncation ())
          labels.pixels[n] = unassigned;
      }
  return labels;
}

LabelImage
withoutUnconfirmed (LabelImage labels, const ObjectMap& objects)
{
  for (const auto& [id, object] : objects.by_id)
    if (!object.confirmed)
      std::replace (labels.pixels.begin (), labels.pixels.end (), static_cast<std::uint16_t> (id), unassigned);
  return labels;
}

LabelImage
widened (const LabelImage& labels, int pixels)
{
  LabelImage result = labels;
  for (const bool rows : {true, false})
  {
    const LabelImage before = result;
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
