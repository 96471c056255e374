// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "scene_input.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/pcd_view.h>

#include <cstdint>
#include <filesystem>
#include <iterator>
#include <utility>

using namespace pcl::cosection;

namespace
{

constexpr std::size_t min_points = 100;

std::string
tooFew (std::uint32_t label, const LabelledView::Points& object)
{
  std::string text = "label " + std::to_string (label) + (label == 0 ? " (background)" : "") + " is skipped: ";
  if (object.readings >= min_points)
    text += "of its " + std::to_string (object.readings) + " valid points only " +
            std::to_string (object.points.size ()) + " have a reliable normal";
  else
    text += "it has " + std::to_string (object.readings) + " valid points";
  return (text + ", at least " + std::to_string (min_points) + " are needed");
}

} // namespace

SceneInput
readScene (const Settings& settings, const ProgressCallback& progress)
{
  SceneInput scene;
  std::map<std::uint32_t, LabelledView::Points> labels;
  for (std::size_t i = 0; i < settings.inputs.size (); ++i)
  {
    if (!progress ("reading " + std::filesystem::path (settings.inputs[i]).filename ().string (),
                   static_cast<double> (i) / static_cast<double> (settings.inputs.size ())))
      throw Cancelled ("interrupted");
    LabelledView view = readPcdView (settings.inputs[i], settings.reading);
    for (auto& [label, object] : view.objects)
    {
      LabelledView::Points& merged = labels[label];
      merged.readings += object.readings;
      std::move (object.points.begin (), object.points.end (), std::back_inserter (merged.points));
    }
    if (view.view)
      scene.views.push_back (std::move (*view.view));
    scene.has_colour = scene.has_colour || view.has_colour;
    std::move (view.warnings.begin (), view.warnings.end (), std::back_inserter (scene.warnings));
  }

  for (auto& [label, object] : labels)
    if (object.points.size () < min_points)
      scene.warnings.push_back (tooFew (label, object));
    else if (label == 0)
      scene.background = std::move (object.points);
    else
      scene.objects[static_cast<int> (label)] = std::move (object.points);
  if (scene.objects.empty ())
  {
    std::string reason = "no object to complete";
    if (labels.size () == 1 && labels.count (0) == 1)
      reason += ": all points have label 0, the background";
    else if (!scene.warnings.empty ())
      reason += ": " + scene.warnings.back ();
    throw DegenerateInput (reason);
  }
  return (scene);
}
