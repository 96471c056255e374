// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "moving_patches.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>

namespace pcl::cosection {
namespace {

constexpr double rest = 1e-3;         // strength of being at rest, per pixel, where nothing is said
constexpr double undecided = 0.3;     // mean of a patch's votes: noise that its pixels share
constexpr double border_weight = 1.0; // per pixel of a border
constexpr int gap_px = 3;             // within which pixels are one part, if they are in depth, too

} // namespace

std::vector<char>
movingPatches (const PatchImage& image, const std::vector<float>& votes, const PatchEvidence& borders)
{
  const auto count = static_cast<Eigen::Index> (image.patches.size ());
  Eigen::VectorXd sum = Eigen::VectorXd::Zero (count);
  for (std::size_t i = 0; i < votes.size (); ++i)
    if (image.patch_of[i] >= 0)
      sum[image.patch_of[i]] += votes[i];
  for (Eigen::Index k = 0; k < count; ++k)
  {
    const double open = std::min (std::abs (sum[k]), undecided * image.patches[k].pixels);
    sum[k] -= sum[k] > 0.0 ? open : -open;
  }
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index k = 0; k < count; ++k)
    entries.emplace_back (k, k, std::abs (sum[k]) + rest * std::max (1, image.patches[k].pixels));
  for (const auto& [pair, evidence] : borders)
  {
    const double weight = border_weight * std::max (0.0f, evidence);
    if (!(weight > 0.0))
      continue;
    entries.emplace_back (pair.first, pair.first, weight);
    entries.emplace_back (pair.second, pair.second, weight);
    entries.emplace_back (pair.first, pair.second, -weight);
    entries.emplace_back (pair.second, pair.first, -weight);
  }
  Eigen::SparseMatrix<double> matrix (count, count);
  matrix.setFromTriplets (entries.begin (), entries.end ());
  const Eigen::VectorXd x = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> (matrix).solve (sum.cwiseMax (0.0));
  std::vector<char> moving (image.patches.size (), 0);
  for (Eigen::Index k = 0; k < count; ++k)
    moving[k] = x[k] > 0.5;
  return moving;
}

std::vector<int>
connectedParts (const DepthGrid& grid, const std::vector<char>& set, int min_pixels)
{
  DisjointSets sets = connectPixels (grid, gap_px, [&] (int i, int j) { return set[i] && set[j]; });
  std::vector<int> parts = sets.numbers ([&] (std::size_t i) { return set[i]; });
  std::vector<int> sizes (set.size (), 0), numbers (set.size (), 0);
  for (const int part : parts)
    if (part >= 0)
      ++sizes[part];
  int next = 0;
  for (std::size_t k = 0; k < sizes.size (); ++k)
    if (sizes[k] >= std::max (1, min_pixels))
      numbers[k] = ++next;
  for (int& part : parts)
    part = part < 0 ? 0 : numbers[part];
  return parts;
}

} // namespace pcl::cosection
