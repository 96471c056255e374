// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "label_agreement.h"

#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/view/normals/estimated_normals.h"

#include <pcl/search/kdtree.h>

#include <algorithm>
#include <map>

using namespace pcl::cosection;

namespace {

constexpr std::size_t most_samples = 1000; // of a label of a view
constexpr std::size_t least_readings = 100;
constexpr float near_spacings = 2.0f; // two samples of one surface are about one spacing apart

} // namespace

std::optional<std::string>
LabelAgreement::add (const LabelledView& view)
{
  pcl::search::KdTree<pcl::PointXYZ> earlier;
  if (!points_.empty ())
    earlier.setInputCloud (points_.makeShared ());
  std::optional<std::string> warning;
  std::vector<std::uint32_t> new_labels;
  pcl::PointCloud<pcl::PointXYZ> new_points;
  for (const auto& [label, object] : view.objects)
  {
    if (label == 0 || object.points.size () < least_readings)
      continue;
    std::vector<Eigen::Vector3f> some;
    for (std::size_t p = 0; p < object.points.size (); p += object.points.size () / most_samples + 1)
      some.push_back (object.points[p].position);
    std::vector<float> spacings = neighbourDistances (some, 1, 1);
    const float near_m = near_spacings * upperMedian (spacings);
    std::map<std::uint32_t, std::size_t> on; // samples, by the label of the nearest earlier point
    pcl::Indices nearest (1);
    std::vector<float> squared_m (1);
    for (const Eigen::Vector3f& p : some)
    {
      const pcl::PointXYZ point (p.x (), p.y (), p.z ());
      if (!points_.empty () && earlier.nearestKSearch (point, 1, nearest, squared_m) > 0 &&
          squared_m[0] < near_m * near_m)
        ++on[labels_[static_cast<std::size_t> (nearest[0])]];
      new_points.push_back (point);
      new_labels.push_back (label);
    }
    const auto most = std::max_element (on.begin (), on.end (),
                                        [] (const auto& a, const auto& b) { return a.second < b.second; });
    if (most != on.end () && most->first != label && 2 * most->second > some.size () && !warning)
      warning = "what has label " + std::to_string (label) + " has label " + std::to_string (most->first) +
                " in a view before: a thing must have the same label in all views";
  }
  points_ += new_points;
  labels_.insert (labels_.end (), new_labels.begin (), new_labels.end ());
  return warning;
}
