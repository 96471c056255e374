// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "surface_patches.h"

#include "pcl_cosection/common/parallel.h"

#include <limits>
#include <queue>
#include <tuple>

namespace pcl::cosection {
namespace {

constexpr int cells_across = 64;      ///< of the grid over the image: 10 pixels of a VGA camera
constexpr int rounds = 5;             ///< of k-means
constexpr float normal_weight = 7.5f; ///< 30 degrees count as much as the size of a cell
constexpr float image_weight = 0.25f; ///< keeps patches compact where there are no normals

struct Cluster
{
  Eigen::Vector3f centre = Eigen::Vector3f::Zero (), normal = Eigen::Vector3f::Zero ();
  Eigen::Vector2f pixel = Eigen::Vector2f::Zero ();
  float inverse_size2 = 0.0f; ///< of a cell at its depth, 1/m^2; 0: empty
};

class Clustering
{
public:
  Clustering (const DepthGrid& grid, const std::vector<char>& used, int threads)
      : grid_ (grid)
      , used_ (used)
      , threads_ (threads)
      , cell_ (std::max (4, (grid.width + cells_across / 2) / cells_across))
      , columns_ ((grid.width + cell_ - 1) / cell_)
      , rows_ ((grid.height + cell_ - 1) / cell_)
      , clusters_ (static_cast<std::size_t> (columns_) * rows_)
      , nearest_ (grid.points.size (), -1)
  {
    for (int row = 0; row < rows_; ++row)
      for (int column = 0; column < columns_; ++column)
        seed (row, column);
  }

  std::vector<int> run ()
  {
    for (int round = 0; round < rounds; ++round)
    {
      assign ();
      if (round + 1 < rounds)
        update ();
    }
    return (std::move (nearest_));
  }

private:
  /** \brief The used pixel nearest to the middle of a cell, those with a normal first. */
  void seed (int row, int column)
  {
    int best = -1, best_distance = std::numeric_limits<int>::max ();
    for (int v = row * cell_; v < std::min (grid_.height, (row + 1) * cell_); ++v)
      for (int u = column * cell_; u < std::min (grid_.width, (column + 1) * cell_); ++u)
      {
        const int i = v * grid_.width + u;
        if (!used_[i])
          continue;
        const int du = u - column * cell_ - cell_ / 2, dv = v - row * cell_ - cell_ / 2;
        const int distance = du * du + dv * dv + (grid_.hasNormal (i) ? 0 : 4 * cell_ * cell_);
        if (distance < best_distance)
        {
          best_distance = distance;
          best = i;
        }
      }
    if (best < 0)
      return;
    Cluster& cluster = clusters_[row * columns_ + column];
    cluster.centre = grid_.points[best];
    if (grid_.hasNormal (best))
      cluster.normal = grid_.normals[best];
    finish (cluster, best % grid_.width, best / grid_.width);
  }

  void finish (Cluster& cluster, float u, float v) const
  {
    const float size = static_cast<float> (cell_) * grid_.pitch * cluster.centre.z ();
    cluster.inverse_size2 = 1.0f / (size * size);
    cluster.pixel = Eigen::Vector2f (u, v);
  }

  float distance (int i, float u, float v, const Cluster& cluster) const
  {
    float d = (grid_.points[i] - cluster.centre).squaredNorm () * cluster.inverse_size2;
    d += image_weight * (Eigen::Vector2f (u, v) - cluster.pixel).squaredNorm () / static_cast<float> (cell_ * cell_);
    if (grid_.hasNormal (i))
      d += normal_weight * (1.0f - grid_.normals[i].dot (cluster.normal));
    return (d);
  }

  void assign ()
  {
    parallelFor (0, grid_.height, threads_, [this] (int v) {
      const int row = v / cell_;
      for (int u = 0; u < grid_.width; ++u)
      {
        const int i = v * grid_.width + u;
        if (!used_[i])
          continue;
        const int column = u / cell_;
        float best = std::numeric_limits<float>::max ();
        for (int r = std::max (0, row - 1); r <= std::min (rows_ - 1, row + 1); ++r)
          for (int c = std::max (0, column - 1); c <= std::min (columns_ - 1, column + 1); ++c)
          {
            const Cluster& cluster = clusters_[r * columns_ + c];
            if (cluster.inverse_size2 <= 0.0f)
              continue;
            const float d = distance (i, static_cast<float> (u), static_cast<float> (v), cluster);
            if (d < best)
            {
              best = d;
              nearest_[i] = r * columns_ + c;
            }
          }
      }
    });
  }

  void update ()
  {
    std::vector<Cluster> sums (clusters_.size ());
    std::vector<int> count (clusters_.size (), 0);
    for (int i = 0; i < static_cast<int> (nearest_.size ()); ++i)
      if (nearest_[i] >= 0)
      {
        Cluster& sum = sums[nearest_[i]];
        sum.centre += grid_.points[i];
        sum.pixel += Eigen::Vector2f (static_cast<float> (i % grid_.width), static_cast<float> (i / grid_.width));
        if (grid_.hasNormal (i))
          sum.normal += grid_.normals[i];
        ++count[nearest_[i]];
      }
    for (std::size_t k = 0; k < sums.size (); ++k)
    {
      if (count[k] == 0)
        continue;
      const float share = 1.0f / static_cast<float> (count[k]);
      sums[k].centre *= share;
      if (sums[k].normal.squaredNorm () > 0.0f)
        sums[k].normal.normalize ();
      const Eigen::Vector2f pixel = sums[k].pixel * share;
      finish (sums[k], pixel.x (), pixel.y ());
      clusters_[k] = sums[k];
    }
  }

  const DepthGrid& grid_;
  const std::vector<char>& used_;
  const int threads_, cell_, columns_, rows_;
  std::vector<Cluster> clusters_;
  std::vector<int> nearest_;
};

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

} // namespace

PatchImage
computeSurfacePatches (const DepthGrid& grid, const std::vector<char>& used, int threads)
{
  const std::vector<int> nearest = Clustering (grid, used, threads).run ();
  DisjointSets sets = connectPixels (grid, 1,
                                     [&] (int i, int j) { return nearest[i] >= 0 && nearest[i] == nearest[j]; });
  PatchImage image{sets.numbers ([&] (std::size_t i) { return nearest[i] >= 0; }), {}};
  for (int i = 0; i < static_cast<int> (nearest.size ()); ++i)
  {
    if (image.patch_of[i] < 0)
      continue;
    if (image.patch_of[i] == static_cast<int> (image.patches.size ())) // its first pixel
      image.patches.emplace_back ();
    SurfacePatch& patch = image.patches[image.patch_of[i]];
    patch.centre += grid.points[i];
    if (grid.hasNormal (i))
      patch.normal += grid.normals[i];
    ++patch.pixels;
  }
  for (SurfacePatch& patch : image.patches)
  {
    patch.centre /= static_cast<float> (patch.pixels);
    if (patch.normal.squaredNorm () > 0.0f)
      patch.normal.normalize ();
  }
  for (int i = 0; i < static_cast<int> (nearest.size ()); ++i)
    if (nearest[i] >= 0 && grid.hasNormal (i))
    {
      SurfacePatch& patch = image.patches[image.patch_of[i]];
      const Eigen::Vector3f from_centre = grid.points[i] - patch.centre;
      patch.spread += from_centre * from_centre.transpose ();
      patch.bend += from_centre * (grid.normals[i] - patch.normal).transpose ();
    }
  return (image);
}

void
removePatches (PatchImage& image, const std::vector<char>& gone)
{
  std::vector<int> number (image.patches.size (), -1);
  std::vector<SurfacePatch> kept;
  for (std::size_t k = 0; k < gone.size (); ++k)
    if (!gone[k])
    {
      number[k] = static_cast<int> (kept.size ());
      kept.push_back (image.patches[k]);
    }
  for (int& patch : image.patch_of)
    patch = patch < 0 ? -1 : number[patch];
  image.patches = std::move (kept);
}

PatchEvidence
convexityEvidence (const DepthGrid& grid, const PatchImage& image, float concave_angle_rad)
{
  std::map<std::pair<int, int>, int> border; // pixels, the smaller number first
  forEachLine (grid, [&] (int first, int stride, int steps, int) {
    int last = -1, last_step = 0, gap = 0;
    for (int k = 0; k < steps; ++k)
    {
      const int i = first + k * stride;
      if (grid.valid (i) && last >= 0)
        gap += grid.points[i].z () - grid.points[last].z () > behind_sigmas * grid.sigma (last);
      if (image.patch_of[i] < 0 || !grid.hasNormal (i))
        continue;
      if (last >= 0 && gap <= gap_px && k - last_step <= bridge_px && image.patch_of[i] != image.patch_of[last] &&
          grid.continuous (i, last, k - last_step))
        ++border[std::minmax (image.patch_of[i], image.patch_of[last])];
      last = i;
      last_step = k;
      gap = 0;
    }
  });

  PatchEvidence evidence;
  for (const auto& [pair, pixels] : border)
    evidence[pair] = static_cast<float> (pixels) *
                     evidenceOf (image.patches[pair.first], image.patches[pair.second], concave_angle_rad);
  return (evidence);
}

std::vector<int>
contractEdges (std::size_t patches, const PatchEvidence& evidence)
{
  std::vector<std::map<int, float>> neighbours (patches);
  // Evidence and minus the numbers of a pair, the smaller one first: of equal evidence that of the smallest numbers.
  std::priority_queue<std::tuple<float, int, int>> queue;
  for (const auto& [pair, value] : evidence)
  {
    neighbours[pair.first][pair.second] = value;
    neighbours[pair.second][pair.first] = value;
    if (value > 0.0f)
      queue.emplace (value, -pair.first, -pair.second);
  }
  DisjointSets sets (patches);
  while (!queue.empty ())
  {
    const auto [best, minus_keep, minus_gone] = queue.top ();
    queue.pop ();
    const int keep = -minus_keep, gone = -minus_gone;
    const auto edge = neighbours[keep].find (gone);
    if (edge == neighbours[keep].end () || edge->second != best)
      continue; // joined or changed since
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
        queue.emplace (sum, -std::min (keep, other), -std::max (keep, other));
    }
    neighbours[gone].clear ();
  }
  return sets.numbers ();
}

} // namespace pcl::cosection
