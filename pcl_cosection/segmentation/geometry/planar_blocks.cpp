// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "planar_blocks.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <numeric>
#include <optional>

namespace pcl::cosection {
namespace {

constexpr float flat_block = 0.985f; ///< length of the mean normal of a block that is flat
constexpr float flat_sigmas = 1.5f;  ///< or the root mean square of its inverse depths about a plane
constexpr double lateral_px = 0.5;   ///< standard deviation of where a depth is read
constexpr float same_plane = 0.94f;  ///< cosine between a block's normal and its plane's: 20 degrees
constexpr float plane_sigmas = 4.0f; ///< distance of a block from its plane; noise and the sensor's distortion
constexpr int max_planes = 32;
constexpr int max_seeds = 600;

/** \brief Sums for a plane through inverse depths, w = a x/z + b y/z + c: (a, b, c).p = 1 on it. */
class InverseDepthFit
{
public:
  void add (const Eigen::Vector3f& p)
  {
    const double w = 1.0 / p.z ();
    const Eigen::Vector3d ray (p.x () * w, p.y () * w, 1.0);
    lhs_ += ray * ray.transpose ();
    rhs_ += w * ray;
    squares_ += w * w;
  }

  /** \brief The plane's normal towards the sensor, if the pixels lie on one. \param[in] z of their middle */
  std::optional<Eigen::Vector3f> normal (double z, double pitch) const
  {
    const Eigen::Vector3d plane = lhs_.ldlt ().solve (rhs_);
    const double rms = std::sqrt (std::max (0.0, squares_ - plane.dot (rhs_)) / lhs_ (2, 2));
    const double noise = depthNoiseSigma (z) / (z * z);
    const double jitter = lateral_px * pitch * plane.head<2> ().norm ();
    if (!(rms < flat_sigmas * std::hypot (noise, jitter)) || !(plane.norm () > 0.0))
      return std::nullopt;
    return Eigen::Vector3f ((-plane.normalized ()).cast<float> ());
  }

private:
  Eigen::Matrix3d lhs_ = Eigen::Matrix3d::Zero ();
  Eigen::Vector3d rhs_ = Eigen::Vector3d::Zero ();
  double squares_ = 0.0;
};

PlanarBlock
planarBlock (const DepthGrid& grid, bool grazing, int row, int column)
{
  PlanarBlock block;
  Eigen::Vector3f centre = Eigen::Vector3f::Zero (), normal = Eigen::Vector3f::Zero ();
  InverseDepthFit fit;
  int readings = 0, with_normal = 0;
  for (int v = row * block_px; v < (row + 1) * block_px; ++v)
    for (int u = column * block_px; u < (column + 1) * block_px; ++u)
    {
      const int i = v * grid.width + u;
      if (!grid.valid (i) || (!grazing && !grid.hasNormal (i)))
        continue;
      fit.add (grid.points[i]);
      centre += grid.points[i];
      ++readings;
      if (grid.hasNormal (i))
      {
        normal += grid.normals[i];
        ++with_normal;
      }
    }
  constexpr int enough = block_px * block_px / 4;
  if (readings < enough)
    return block;
  block.centre = centre / static_cast<float> (readings);
  block.sigma = static_cast<float> (depthNoiseSigma (block.centre.z ()));
  if (2 * with_normal >= block_px * block_px && normal.norm () >= flat_block * static_cast<float> (with_normal))
    block.normal = normal.normalized ();
  else if (!grazing)
    return block;
  else if (const auto fitted = fit.normal (block.centre.z (), grid.pitch))
    block.normal = *fitted;
  else
    return block;
  const float pixel_m = grid.pitch * block.centre.z ();
  const float cosine = std::max (0.1f, -block.normal.dot (block.centre.normalized ()));
  block.area_m2 = static_cast<float> (readings) * pixel_m * pixel_m / cosine;
  return block;
}

/** \brief Least squares through the centres of the blocks, each weighted by its area over its variance. */
void
fitPlane (const std::vector<PlanarBlock>& blocks, const std::vector<int>& members, PlaneProposal& plane)
{
  double sum = 0.0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero ();
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero ();
  for (const int i : members)
  {
    const double weight = blocks[i].area_m2 / (blocks[i].sigma * blocks[i].sigma);
    const Eigen::Vector3d c = blocks[i].centre.cast<double> ();
    sum += weight;
    mean += weight * c;
    products += weight * c * c.transpose ();
  }
  mean /= sum;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen (products / sum - mean * mean.transpose ());
  Eigen::Vector3d normal = eigen.eigenvectors ().col (0);
  if (normal.dot (mean) > 0.0)
    normal = -normal;
  plane.normal = normal.cast<float> ();
  plane.offset = static_cast<float> (-normal.dot (mean));
}

/** \brief Groups of members that are no more than two blocks apart. */
std::vector<std::vector<int>>
connectedGroups (const BlockImage& image, const std::vector<int>& members)
{
  std::vector<char> in (image.blocks.size (), 0);
  for (const int i : members)
    in[i] = 1;
  DisjointSets sets (image.blocks.size ());
  for (const int i : members)
    for (int dv = 0; dv <= 2; ++dv)
      for (int du = -2; du <= 2; ++du)
      {
        const int u = i % image.width + du, v = i / image.width + dv;
        if (u >= 0 && u < image.width && v < image.height && in[v * image.width + u])
          sets.unite (i, v * image.width + u);
      }
  const std::vector<int> number = sets.numbers ([&] (std::size_t i) { return in[i]; });
  std::vector<std::vector<int>> groups;
  for (const int i : members)
  {
    groups.resize (std::max (groups.size (), static_cast<std::size_t> (number[i] + 1)));
    groups[number[i]].push_back (i);
  }
  return groups;
}

float
areaOf (const std::vector<PlanarBlock>& blocks, const std::vector<int>& members)
{
  return std::accumulate (members.begin (), members.end (), 0.0f,
                          [&] (float area, int i) { return area + blocks[i].area_m2; });
}

/** \brief Whether two blocks are farther apart. */
bool
longerThan (float length_m, const std::vector<PlanarBlock>& blocks, const std::vector<int>& members)
{
  for (const int i : members)
    for (const int j : members)
      if ((blocks[i].centre - blocks[j].centre).squaredNorm () > length_m * length_m)
        return true;
  return false;
}

/** \brief Planes through single blocks, with the surface of all blocks that they hold. */
class Seeds
{
public:
  Seeds (const std::vector<PlanarBlock>& blocks, const std::vector<int>& flat) : blocks_ (blocks)
  {
    for (std::size_t k = 0; k < flat.size (); k += 1 + flat.size () / max_seeds)
    {
      const PlanarBlock& block = blocks[flat[k]];
      PlaneProposal plane;
      plane.normal = block.normal;
      plane.offset = -block.normal.dot (block.centre);
      planes_.push_back (plane);
      block_.push_back (flat[k]);
    }
    count (flat, 1.0f);
  }

  /** \brief Add the surface of blocks to the planes that hold them, or take it away. */
  void count (const std::vector<int>& members, float sign)
  {
    for (const int i : members)
      for (PlaneProposal& plane : planes_)
        if (plane.holds (blocks_[i]))
          plane.area_m2 += sign * blocks_[i].area_m2;
  }

  /** \brief The plane with the most surface whose own block is left; nothing without. */
  const PlaneProposal* best (const std::vector<char>& left) const
  {
    const PlaneProposal* best = nullptr;
    for (std::size_t k = 0; k < planes_.size (); ++k)
      if (left[block_[k]] && (best == nullptr || planes_[k].area_m2 > best->area_m2))
        best = &planes_[k];
    return best;
  }

private:
  const std::vector<PlanarBlock>& blocks_;
  std::vector<PlaneProposal> planes_;
  std::vector<int> block_;
};

} // namespace

bool
PlaneProposal::holds (const PlanarBlock& block) const
{
  return normal.dot (block.normal) > same_plane &&
         std::abs (normal.dot (block.centre) + offset) < plane_sigmas * block.sigma;
}

BlockImage
findPlanarBlocks (const DepthGrid& grid, bool grazing)
{
  BlockImage image{grid.width / block_px, grid.height / block_px, {}};
  image.blocks.reserve (static_cast<std::size_t> (image.width) * image.height);
  for (int row = 0; row < image.height; ++row)
    for (int column = 0; column < image.width; ++column)
      image.blocks.push_back (planarBlock (grid, grazing, row, column));
  return image;
}

std::vector<PlaneProposal>
proposePlanes (const BlockImage& image, float max_object_size_m, float min_area_m2)
{
  const std::vector<PlanarBlock>& blocks = image.blocks;
  std::vector<int> flat;
  std::vector<char> left (blocks.size (), 0);
  for (int i = 0; i < static_cast<int> (blocks.size ()); ++i)
    if (blocks[i].area_m2 > 0.0f)
    {
      flat.push_back (i);
      left[i] = 1;
    }
  Seeds seeds (blocks, flat);
  const auto membersOf = [&] (const PlaneProposal& plane) {
    std::vector<int> members;
    for (const int i : flat)
      if (left[i] && plane.holds (blocks[i]))
        members.push_back (i);
    return members;
  };
  const auto discard = [&] (std::vector<int>& members) {
    members.erase (std::remove_if (members.begin (), members.end (), [&] (int i) { return !left[i]; }), members.end ());
    seeds.count (members, -1.0f);
    for (const int i : members)
      left[i] = 0;
  };
  std::vector<PlaneProposal> proposals;
  while (proposals.size () < max_planes)
  {
    const PlaneProposal* const best = seeds.best (left);
    if (best == nullptr || best->area_m2 < 0.5f * min_area_m2)
      break;
    PlaneProposal plane = *best;
    std::vector<int> members = membersOf (plane), before;
    for (int step = 0; step < 5 && members.size () >= 3; ++step)
    {
      before = members;
      fitPlane (blocks, members, plane);
      members = membersOf (plane);
    }
    if (members.size () < 3 || areaOf (blocks, members) < 0.5f * min_area_m2)
    {
      members.insert (members.end (), before.begin (), before.end ());
      discard (members);
      continue;
    }
    for (const std::vector<int>& group : connectedGroups (image, members))
      if (longerThan (max_object_size_m, blocks, group))
      {
        plane.blocks.insert (plane.blocks.end (), group.begin (), group.end ());
        plane.large = true;
      }
    if (!plane.large)
      plane.blocks = members;
    plane.area_m2 = areaOf (blocks, plane.blocks);
    proposals.push_back (plane);
    discard (members);
  }
  return proposals;
}

} // namespace pcl::cosection
