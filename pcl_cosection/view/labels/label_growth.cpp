// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "label_growth.h"

#include "label_patches.h"
#include "pcl_cosection/common/plane_height.h"
#include "pcl_cosection/view/support_plane.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace pcl::cosection {
namespace {

constexpr double least_of_grown = 0.3;         // as goesOnBeyond () has it, once a label is known to be too small
constexpr int margins_across = 80;             // the largest margin, in parts of the image's width
constexpr double plane_sigmas = 4.0;           // of depth noise: nearer to a plane, readings are of it
constexpr double plane_reach = 2.0;            // of the object's length: of a tall one, only the top may be seen
constexpr std::size_t most_for_planes = 20000; // points of the background or an object that are looked at for planes

/** \brief The readings of a label without parts, besides the largest, that are no wider than the largest margin: of a
 * label that is too large, they may be on what is behind its object. */
std::vector<std::size_t>
bodyOf (const PinholeCamera& camera, const SensorCloud& cloud, const std::vector<std::size_t>& readings)
{
  if (readings.empty ())
    return {};
  const LabelPatches patches = patchesOf (camera, cloud, readings);
  const auto margin = static_cast<std::size_t> (cloud.width / margins_across);
  std::vector<std::size_t> least_size (patches.sizes.size (), 0);
  for (std::size_t r = 0; r < readings.size (); ++r)
    if (const std::size_t patch = patches.patch_of[r]; patch != no_patch)
      visitBeside (cloud, readings[r], [&] (std::size_t j) {
        if (cloud.labels[j] != cloud.labels[readings[r]])
          least_size[patch] += margin;
      });
  std::vector<std::size_t> body;
  for (std::size_t r = 0; r < readings.size (); ++r)
    if (const std::size_t patch = patches.patch_of[r];
        patch != no_patch && (patch == patches.largest || patches.sizes[patch] >= least_size[patch]))
      body.push_back (readings[r]);
  return body;
}

/** \brief Readings as points that face the sensor, no more than most_for_planes. */
std::vector<OrientedPoint>
facingPoints (const SensorCloud& cloud, const std::vector<std::size_t>& readings)
{
  std::vector<OrientedPoint> points;
  for (std::size_t r = 0; r < readings.size (); r += readings.size () / most_for_planes + 1)
  {
    const Eigen::Vector3f& p = cloud.positions[readings[r]];
    points.push_back ({p, -p.normalized ()});
  }
  return points;
}

/** \brief A label while it grows. */
struct GrowingLabel
{
  std::uint32_t label = 0;
  std::size_t pixels = 0;
  std::vector<std::size_t> outline; // its pixels beside others without a label
  std::vector<Eigen::Vector4d> planes;
  double near_plane_m = 0.0;
  int grown_px = 0;
};

class LabelGrowth
{
public:
  LabelGrowth (const PinholeCamera& camera, SensorCloud& cloud) : camera_ (camera), cloud_ (cloud) {}

  /** \brief The readings around \a label, if the surface goes on there; else nothing. */
  std::vector<std::size_t> ringAround (GrowingLabel& label) const
  {
    std::size_t all = 0, continued = 0;
    std::vector<std::size_t> outline, ring;
    for (const std::size_t i : label.outline)
    {
      bool outer = false;
      visitBeside (cloud_, i, [&] (std::size_t j) {
        if (cloud_.labels[j] != 0 || !cloud_.positions[j].allFinite ())
          return;
        outer = true;
        const bool goes_on = onOneSurface (camera_, cloud_, i, j), on_plane = onPlane (label, j);
        if (goes_on && on_plane) // the object meets what it stands on
          return;
        ++all;
        if (!goes_on || on_plane || besideEdge (j))
          return;
        ++continued;
        ring.push_back (j);
      });
      if (outer)
        outline.push_back (i);
    }
    label.outline = std::move (outline);
    if (!(label.grown_px == 0 ? goesOnBeyond (continued, all, label.pixels)
                              : goesOnBeyond (continued, all, label.pixels, least_of_grown)))
      ring.clear ();
    return ring;
  }

  void grow (GrowingLabel& label, const std::vector<std::size_t>& ring)
  {
    for (const std::size_t j : ring)
      if (cloud_.labels[j] == 0)
      {
        cloud_.labels[j] = label.label;
        label.outline.push_back (j);
        ++label.pixels;
      }
    ++label.grown_px;
  }

  bool onPlane (const GrowingLabel& label, std::size_t j) const
  {
    const Eigen::Vector3d p = cloud_.positions[j].cast<double> ();
    return std::any_of (label.planes.begin (), label.planes.end (),
                        [&] (const Eigen::Vector4d& plane) { return heightOver (plane, p) <= label.near_plane_m; });
  }

private:
  /** \brief Whether a reading may be mixed from both sides of an edge. */
  bool besideEdge (std::size_t j) const
  {
    bool beside = false;
    visitBeside (cloud_, j, [&] (std::size_t k) {
      const double a = cloud_.positions[j].z (), b = cloud_.positions[k].z ();
      beside = beside || !(std::abs (a - b) <= smallestEdgeStep (std::min (a, b), cloud_.working_range_m));
    });
    return beside;
  }

  const PinholeCamera& camera_;
  SensorCloud& cloud_;
};

} // namespace

std::map<std::uint32_t, double>
growLabels (const PinholeCamera& camera, const Members& members, SensorCloud& cloud)
{
  std::map<std::uint32_t, double> added;
  const auto background = members.find (0);
  if (background == members.end ())
    return added;
  LabelGrowth growth (camera, cloud);
  const std::vector<OrientedPoint> seen_background = facingPoints (cloud, background->second);
  const Surroundings surroundings = surroundingsOf (members, cloud);
  std::vector<GrowingLabel> growing;
  for (const auto& [label, readings] : members)
  {
    if (label == 0)
      continue;
    GrowingLabel grows;
    grows.label = label;
    grows.pixels = readings.size ();
    const std::vector<std::size_t> body = bodyOf (camera, cloud, readings);
    grows.outline = body;
    if (growth.ringAround (grows).empty ()) // not even with what may be of its support planes
      continue;
    const double noise_m = depthNoiseSigma (surroundings.at (label).center ().z (), cloud.working_range_m);
    grows.near_plane_m = plane_sigmas * noise_m;
    SupportPlaneOptions options;
    options.inlier_distance_m = grows.near_plane_m;
    options.noise_m = noise_m;
    options.reach = plane_reach;
    grows.planes = findSupportPlanes (seen_background, facingPoints (cloud, body), options);
    if (grows.planes.empty ())
      continue;
    std::vector<std::size_t> off_planes;
    std::copy_if (body.begin (), body.end (), std::back_inserter (off_planes),
                  [&] (std::size_t i) { return !growth.onPlane (grows, i); });
    grows.outline = bodyOf (camera, cloud, off_planes);
    growing.push_back (std::move (grows));
  }
  for (int step = 0; step < cloud.width / margins_across; ++step)
  {
    std::vector<std::vector<std::size_t>> rings;
    for (GrowingLabel& label : growing)
      rings.push_back (label.grown_px == step ? growth.ringAround (label) : std::vector<std::size_t> ());
    for (std::size_t g = 0; g < growing.size (); ++g)
      if (!rings[g].empty ())
        growth.grow (growing[g], rings[g]);
  }
  for (const GrowingLabel& label : growing)
    if (const std::size_t before = members.at (label.label).size (); label.pixels > before)
      added[label.label] = static_cast<double> (label.pixels - before) / static_cast<double> (label.pixels);
  return added;
}

} // namespace pcl::cosection
