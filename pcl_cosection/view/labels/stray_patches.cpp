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

constexpr int edge_px = 2; // width of an edge: of readings that are smeared, or missing
// As goesOnBeyond () has it. One among 80 parts that edges cut off has more, in simulated views of scanned objects with
// exact labels, and 209 among 219 with labels that are too large or shifted, or real.
constexpr double least_continued = 0.75;

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
    return most != continued.end () && goesOnBeyond (most->second, all, pixels, least_continued)
               ? std::optional<std::uint32_t> (most->first)
               : std::nullopt;
  }
};

/** \brief The pixel so many steps from one, if the row, or the image, goes on so far. */
std::optional<std::size_t>
pixelAt (const SensorCloud& cloud, std::size_t from, std::ptrdiff_t step, int steps)
{
  const auto width = static_cast<std::ptrdiff_t> (cloud.width), here = static_cast<std::ptrdiff_t> (from);
  const std::ptrdiff_t there = here + steps * step;
  const bool is_in = there >= 0 && there < static_cast<std::ptrdiff_t> (cloud.positions.size ()) &&
                     (step % width == 0 || there / width == here / width);
  return is_in ? std::optional<std::size_t> (static_cast<std::size_t> (there)) : std::nullopt;
}

/** \brief Add a side of a reading to the outline. Readings are missing at edges, or no step from one to the next is
 * large, as edges are smeared: so those a little farther count, too. */
void
addSide (const PinholeCamera& camera, const SensorCloud& cloud, std::size_t here, std::ptrdiff_t step, Outline& outline)
{
  std::optional<std::uint32_t> other;
  for (int steps = 1; steps <= edge_px; ++steps)
  {
    const std::optional<std::size_t> there = pixelAt (cloud, here, step, steps);
    if (!there || (other && cloud.labels[*there] != *other))
      break;
    if (!cloud.positions[*there].allFinite ())
      continue;
    if (!other)
    {
      other = cloud.labels[*there];
      if (*other == cloud.labels[here])
        return;
      ++outline.all;
    }
    if (!onOneSurface (camera, cloud, here, *there, steps))
      return;
  }
  if (other)
    ++outline.continued[*other];
}

std::vector<Outline>
outlinesOf (const PinholeCamera& camera, const SensorCloud& cloud, const std::vector<std::size_t>& readings,
            const std::vector<std::size_t>& patch_of)
{
  std::vector<Outline> outlines (readings.size ()); // by patch
  for (std::size_t r = 0; r < readings.size (); ++r)
    if (patch_of[r] != no_patch)
      for (const std::ptrdiff_t step : {-1, 1, -cloud.width, cloud.width})
        addSide (camera, cloud, readings[r], step, outlines[patch_of[r]]);
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

std::map<std::uint16_t, std::array<std::size_t, 2>>
relabelStrayPatches (const PinholeCamera& camera, const Image<float>& depth, Image<std::uint16_t>& mask)
{
  SensorCloud cloud;
  cloud.width = mask.width;
  cloud.height = mask.height;
  cloud.labels.assign (mask.pixels.begin (), mask.pixels.end ());
  for (int v = 0; v < mask.height; ++v)
    for (int u = 0; u < mask.width; ++u)
      cloud.positions.push_back (depth.at (u, v) > 0.0f
                                     ? Eigen::Vector3f (camera.unproject (u, v, depth.at (u, v)).cast<float> ())
                                     : Eigen::Vector3f::Constant (nan_value));
  Members members = membersOf (cloud);
  members.erase (ignored_label);
  LabelledView without_views;
  setWorkingRange (members, cloud, without_views);
  const std::map<std::uint32_t, double> moved = relabelStrayPatches (camera, members, cloud);
  std::copy (cloud.labels.begin (), cloud.labels.end (), mask.pixels.begin ());
  std::map<std::uint16_t, std::array<std::size_t, 2>> counts;
  for (const auto& [label, readings] : members)
  {
    const auto share = moved.find (label);
    const double elsewhere = share == moved.end () ? 0.0 : share->second * static_cast<double> (readings.size ());
    counts[static_cast<std::uint16_t> (label)] = {readings.size (), static_cast<std::size_t> (elsewhere + 0.5)};
  }
  return counts;
}

} // namespace pcl::cosection
