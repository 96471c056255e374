// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "convexity_graph.h"

#include "pcl_cosection/common/disjoint_sets.h"

#include <queue>

namespace pcl::cosection {
namespace {

constexpr int bridge_px = 5;           ///< pixels without a normal that may lie between two patches
constexpr int gap_px = 1;              ///< pixels of these that may show something farther away
constexpr float behind_sigmas = 6.0f;  ///< by so much, seen through a gap
constexpr float against_limit = -2.0f; ///< evidence of one pixel of a deep concave edge
constexpr float step_evidence = -0.5f; ///< of one pixel of a step between parallel surfaces
constexpr float smooth_bend = 0.7f;    ///< largest angle between neighbouring patches of one smooth surface
constexpr float step_sigmas = 4.0f;    ///< height of such a step

/** \brief Evidence per pixel of the border between two patches. */
float
evidenceOf (const SurfacePatch& a, const SurfacePatch& b, float concave_angle)
{
  const Eigen::Vector3f between = a.centre - b.centre;
  const float angle = std::acos (std::clamp (a.normal.dot (b.normal), -1.0f, 1.0f));
  if (angle < concave_angle)
  {
    const Eigen::Vector3f mean = (a.normal + b.normal).normalized ();
    const float step = std::abs (mean.dot (between)) - 0.5f * std::tan (angle) * between.norm ();
    if (step > step_sigmas * static_cast<float> (depthNoiseSigma (a.centre.z ())))
      return (step_evidence);
  }
  const bool concave = between.dot (a.normal - b.normal) < 0.0f;
  if (!concave)
    return (1.0f);
  // The inside of a bowl bends within its patches, too; at an edge the bend is between them.
  const Eigen::Vector3f direction = between.normalized ();
  const float bend = std::max (0.0f, std::min (-a.curvature (direction), -b.curvature (direction))) * between.norm ();
  return (std::clamp (1.0f - (angle - std::min (bend, smooth_bend)) / concave_angle, against_limit, 1.0f));
}

bool
isBehind (const DepthGrid& grid, int i, int before)
{
  return (grid.points[i].z () - grid.points[before].z () > behind_sigmas * grid.sigma (before));
}

} // namespace

PatchEvidence
convexityEvidence (const DepthGrid& grid, const PatchImage& image, float concave_angle_rad)
{
  std::map<std::pair<int, int>, int> border; // pixels
  const auto follow = [&] (int first, int stride, int steps, int) {
    int last = -1, last_step = 0, gap = 0;
    for (int k = 0; k < steps; ++k)
    {
      const int i = first + k * stride;
      if (grid.valid (i) && last >= 0 && isBehind (grid, i, last))
        ++gap;
      if (image.patch_of[i] < 0 || !grid.hasNormal (i))
        continue;
      if (last >= 0 && gap <= gap_px && k - last_step <= bridge_px && image.patch_of[i] != image.patch_of[last] &&
          grid.continuous (i, last, k - last_step))
        ++border[std::minmax (image.patch_of[i], image.patch_of[last])];
      last = i;
      last_step = k;
      gap = 0;
    }
  };
  forEachLine (grid, follow);

  PatchEvidence evidence;
  for (const auto& [pair, pixels] : border)
    evidence[pair] = static_cast<float> (pixels) *
                     evidenceOf (image.patches[pair.first], image.patches[pair.second], concave_angle_rad);
  return (evidence);
}

std::vector<int>
contractEdges (std::size_t patches, const PatchEvidence& evidence)
{
  struct Candidate
  {
    float evidence;
    int a, b;
    bool operator<(const Candidate& other) const
    {
      return (std::make_tuple (evidence, other.a, other.b) < std::make_tuple (other.evidence, a, b));
    }
  };
  std::vector<std::map<int, float>> neighbours (patches);
  std::priority_queue<Candidate> queue;
  for (const auto& [pair, value] : evidence)
  {
    neighbours[pair.first][pair.second] = value;
    neighbours[pair.second][pair.first] = value;
    if (value > 0.0f)
      queue.push ({value, pair.first, pair.second});
  }
  DisjointSets sets (patches);
  while (!queue.empty ())
  {
    const Candidate best = queue.top ();
    queue.pop ();
    const auto edge = neighbours[best.a].find (best.b);
    if (edge == neighbours[best.a].end () || edge->second != best.evidence)
      continue; // joined or changed since
    const int keep = std::min (best.a, best.b), gone = std::max (best.a, best.b);
    sets.unite (keep, gone);
    neighbours[keep].erase (gone);
    for (const auto& [other, value] : neighbours[gone])
    {
      if (other == keep)
        continue;
      neighbours[other].erase (gone);
      const float sum = neighbours[keep][other] += value;
      neighbours[other][keep] = sum;
      if (sum > 0.0f)
        queue.push ({sum, std::min (keep, other), std::max (keep, other)});
    }
    neighbours[gone].clear ();
  }
  return sets.numbers ();
}

} // namespace pcl::cosection
