// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "stray_patches.h"

#include "label_patches.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace pcl::cosection {
namespace {

/** \brief The outline of a patch towards readings of other labels, counted in pairs of pixels. */
struct Outline
{
  std::size_t all = 0;
  std::map<std::uint32_t, std::size_t> continued; // pairs on one surface, by the other's label

  /** \brief The label of the surface that goes on here. \param[in] pixels of the patch */
  std::optional<std::uint32_t> owner (std::size_t pixels) const
  {
    const auto most = std::max_element (continued.begin (), continued.end (),
                                        [] (const auto& a, const auto& b) { return a.second < b.second; });
    return most != continued.end () && goesOnBeyond (most->second, all, pixels)
               ? std::optional<std::uint32_t> (most->first)
               : std::nullopt;
  }
};

std::vector<Outline>
outlinesOf (const PinholeCamera& camera, const SensorCloud& cloud, const std::vector<std::size_t>& readings,
            const std::vector<std::size_t>& patch_of)
{
  std::vector<Outline> outlines (readings.size ()); // by patch
  for (std::size_t r = 0; r < readings.size (); ++r)
  {
    if (patch_of[r] == no_patch)
      continue;
    Outline& outline = outlines[patch_of[r]];
    const std::size_t here = readings[r];
    visitBeside (cloud, here, [&] (std::size_t there) {
      if (cloud.labels[there] == cloud.labels[here] || !cloud.positions[there].allFinite ())
        return;
      ++outline.all;
      if (onOneSurface (camera, cloud, here, there))
        ++outline.continued[cloud.labels[there]];
    });
  }
  return outlines;
}

} // namespace

std::map<std::uint32_t, double>
relabelStrayPatches (const PinholeCamera& camera, const Members& members, SensorCloud& cloud)
{
  std::map<std::uint32_t, double> moved;
  std::vector<std::uint32_t> labels = cloud.labels;
  for (const auto& [label, readings] : members)
  {
    if (label == 0 || readings.empty ())
      continue;
    const LabelPatches patches = patchesOf (camera, cloud, readings);
    const std::vector<Outline> outlines = outlinesOf (camera, cloud, readings, patches.patch_of);
    std::vector<std::uint32_t> owners (readings.size (), label); // by patch
    for (std::size_t patch = 0; patch < owners.size (); ++patch)
      if (patch != patches.largest)
        owners[patch] = outlines[patch].owner (patches.sizes[patch]).value_or (label);
    std::size_t count = 0;
    for (std::size_t r = 0; r < readings.size (); ++r)
      if (const std::size_t patch = patches.patch_of[r]; patch != no_patch && owners[patch] != label)
      {
        labels[readings[r]] = owners[patch];
        ++count;
      }
    if (count > 0)
      moved[label] = static_cast<double> (count) / static_cast<double> (readings.size ());
  }
  cloud.labels = std::move (labels);
  return moved;
}

} // namespace pcl::cosection
