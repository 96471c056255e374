// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "background_blocks.h"

#include "pcl_cosection/common/boxes.h"
#include "pcl_cosection/common/byte_text.h"
#include "pcl_cosection/completion/place_bodies.h"
#include "pcl_cosection/energy/data/imls_data_term.h"
#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <string>
#include <utility>

namespace pcl::cosection {
namespace {

using Place = std::array<int, 3>; // of a block: z, y, x
using Box = Eigen::AlignedBox3i;

constexpr int default_edge = 256; // voxels
// Blocks overlap by twice this, but for small ones. The fields of two neighbours hold each other's values at this
// distance, and where these are not the solution, the difference decays over it: with 8, surfaces of a real room that
// points hardly determine differed by more than .1 voxels from those of a single volume; with 24, none did.
constexpr int largest_margin = 24;
constexpr int margins_of_edge = 4; // a quarter of the edge at most, so that half of it is left
constexpr std::size_t kept_bytes_per_voxel = sizeof (float) + 2 * sizeof (std::uint8_t) + 1; // field, votes, marks
constexpr std::size_t result_bytes_per_voxel = sizeof (float) + sizeof (std::uint8_t);

std::size_t
volume (const Box& box)
{
  const Eigen::Vector3i dims = box.sizes ().array () + 1;
  return static_cast<std::size_t> (dims.x ()) * dims.y () * dims.z ();
}

bool
isSame (const Box& a, const Box& b)
{
  return a.min () == b.min () && a.max () == b.max ();
}

/** \brief The quotient rounded down. */
int
floorDivide (int n, int divisor)
{
  return n >= 0 ? n / divisor : -((divisor - 1 - n) / divisor);
}

Place
placeOf (const BackgroundBlocks& blocks, const Eigen::Vector3i& voxel)
{
  return {floorDivide (voxel.z (), blocks.core_edge), floorDivide (voxel.y (), blocks.core_edge),
          floorDivide (voxel.x (), blocks.core_edge)};
}

Box
coreOf (const BackgroundBlocks& blocks, const Place& place)
{
  const Eigen::Vector3i first = blocks.core_edge * Eigen::Vector3i (place[2], place[1], place[0]);
  return Box (first, Eigen::Vector3i (first.array () + blocks.core_edge - 1)).intersection (blocks.whole);
}

Box
grown (const Box& box, int voxels)
{
  return {Eigen::Vector3i (box.min ().array () - voxels), Eigen::Vector3i (box.max ().array () + voxels)};
}

Box
domainOf (const BackgroundBlocks& blocks, const Place& place)
{
  return grown (coreOf (blocks, place), blocks.margin).intersection (blocks.whole);
}

/** \brief The voxels of the lattice that a background has. \param[in] box world frame */
Box
wholeOf (const Eigen::AlignedBox3d& box, CompletionMode mode, const BackgroundBlocks& blocks)
{
  const auto toVoxel = [&] (const Eigen::Vector3d& p) {
    return Eigen::Array3d ((p - blocks.origin_m).array () / blocks.voxel_size_m);
  };
  Box whole (Eigen::Vector3i (toVoxel (box.min ()).floor ().cast<int> ()),
             Eigen::Vector3i (toVoxel (box.max ()).ceil ().cast<int> ()));
  if (mode == CompletionMode::Once || blocks.whole.isEmpty ())
    return whole;
  for (int a = 0; a < 3; ++a)
  {
    if (whole.min ()[a] < blocks.whole.min ()[a])
      whole.min ()[a] -= growth_vox;
    if (whole.max ()[a] > blocks.whole.max ()[a])
      whole.max ()[a] += growth_vox;
  }
  return whole.merged (blocks.whole);
}

/** \brief Whether a continued plane runs through a box. */
bool
runsThrough (const PlaneContinuation& continuation, const Eigen::AlignedBox3d& box)
{
  const Eigen::AlignedBox3d common = box.intersection (continuation.region);
  if (common.isEmpty ())
    return false;
  const Eigen::Vector3d normal = continuation.plane.head<3> ();
  const double middle = normal.dot (common.center ()) + continuation.plane[3];
  return std::abs (middle) <= 0.5 * normal.cwiseAbs ().dot (common.sizes ());
}

/** \brief The places of the blocks that have data near. */
std::set<Place>
occupiedPlaces (const std::vector<OrientedPoint>& points, const std::vector<PlaneContinuation>& planes,
                const CoSectionOptions& options, const BackgroundBlocks& blocks)
{
  const VoxelGrid grid = gridOf (blocks, blocks.whole);
  const int reach = static_cast<int> (std::ceil (options.max_bound_vox + cutoff_sigmas * options.sigma_vox)) + 1;
  const Place first = placeOf (blocks, blocks.whole.min ()), last = placeOf (blocks, blocks.whole.max ());
  Box places (Eigen::Vector3i (first[2], first[1], first[0]), Eigen::Vector3i (last[2], last[1], last[0]));
  VoxelGrid cells; // one per place
  cells.dims = places.sizes ().array () + 1;
  std::vector<bool> occupied (cells.size (), false);
  for (const OrientedPoint& point : points)
  {
    const auto at = grid.nearest (point.position.cast<double> ());
    if (!at)
      continue;
    const Eigen::Vector3i voxel = *at + blocks.whole.min ();
    const Place low = placeOf (blocks, (voxel.array () - reach).matrix ().cwiseMax (blocks.whole.min ()));
    const Place high = placeOf (blocks, (voxel.array () + reach).matrix ().cwiseMin (blocks.whole.max ()));
    for (int k = low[0]; k <= high[0]; ++k)
      for (int j = low[1]; j <= high[1]; ++j)
        for (int i = low[2]; i <= high[2]; ++i)
          occupied[cells.index (i - first[2], j - first[1], k - first[0])] = true;
  }
  std::set<Place> result;
  for (int k = first[0]; k <= last[0]; ++k)
    for (int j = first[1]; j <= last[1]; ++j)
      for (int i = first[2]; i <= last[2]; ++i)
      {
        const Place place{k, j, i};
        const Eigen::AlignedBox3d near = boxOf (gridOf (blocks, grown (coreOf (blocks, place), reach)));
        if (occupied[cells.index (i - first[2], j - first[1], k - first[0])] ||
            std::any_of (planes.begin (), planes.end (),
                         [&] (const PlaneContinuation& plane) { return runsThrough (plane, near); }))
          result.insert (place);
      }
  return result;
}

/** \brief \throws MemoryLimitExceeded */
void
checkMemory (const BackgroundBlocks& blocks, const std::set<Place>& places, std::size_t limit_bytes,
             std::size_t used_bytes)
{
  std::size_t all = 0, largest = 0;
  for (const Place& place : places)
  {
    const std::size_t voxels = volume (domainOf (blocks, place));
    all += voxels;
    largest = std::max (largest, voxels);
  }
  VoxelGrid one;
  one.dims = {static_cast<int> (largest), 1, 1};
  const std::size_t bytes = all * (kept_bytes_per_voxel + result_bytes_per_voxel) + estimateBytes (one);
  if (limit_bytes == 0 || (used_bytes < limit_bytes && bytes <= limit_bytes - used_bytes))
    return;
  throw MemoryLimitExceeded (std::to_string (places.size ()) + " blocks of " + std::to_string (all) +
                             " voxels together need " + byteText (bytes) + "; " + byteText (limit_bytes) +
                             " are allowed, of which points, views and other volumes take " + byteText (used_bytes));
}

/** \brief A new block without a field. */
BackgroundBlock
makeBlock (const BackgroundBlocks& blocks, const Box& core, const Box& domain, const CoSectionOptions& options)
{
  BackgroundBlock block;
  block.core = core;
  block.domain = domain;
  block.body.grid = gridOf (blocks, domain);
  block.body.options = options;
  return block;
}

/** \brief Mark the blocks as changed through which planes run that are new, or were there before. */
void
markChangedPlanes (const std::vector<PlaneContinuation>& planes, BackgroundBlocks& blocks)
{
  const auto isSamePlane = [] (const PlaneContinuation& a, const PlaneContinuation& b) {
    return a.plane == b.plane && a.region.min () == b.region.min () && a.region.max () == b.region.max ();
  };
  const auto mark = [&] (const std::vector<PlaneContinuation>& changed, const std::vector<PlaneContinuation>& others) {
    for (const PlaneContinuation& plane : changed)
      if (std::none_of (others.begin (), others.end (), [&] (const auto& other) { return isSamePlane (plane, other); }))
        for (auto& [place, block] : blocks.blocks)
          block.is_current = block.is_current && !runsThrough (plane, boxOf (*block.body.grid));
  };
  mark (planes, blocks.planes);
  mark (blocks.planes, planes);
  blocks.planes = planes;
}

} // namespace

int
blockEdge (const CoSectionOptions& options)
{
  return options.background_block_vox > 0 ? options.background_block_vox : default_edge;
}

VoxelGrid
gridOf (const BackgroundBlocks& blocks, const Box& voxels)
{
  VoxelGrid grid;
  grid.voxel_size_m = blocks.voxel_size_m;
  grid.dims = voxels.sizes ().array () + 1;
  grid.origin_m = blocks.origin_m + blocks.voxel_size_m * voxels.min ().cast<double> ();
  return grid;
}

std::size_t
bytesOf (const BackgroundBlocks& blocks)
{
  std::size_t voxels = 0;
  for (const auto& [place, block] : blocks.blocks)
    voxels += volume (block.domain);
  return voxels * kept_bytes_per_voxel;
}

void
placeBlocks (const Scene& scene, const Eigen::AlignedBox3d& box, double voxel_size_m,
             const std::vector<PlaneContinuation>& planes, const CoSectionOptions& options, CompletionMode mode,
             std::size_t used_bytes, BackgroundBlocks& blocks)
{
  BackgroundBlocks next;
  const int margin = std::min (largest_margin, blockEdge (options) / margins_of_edge);
  const int core_edge = blockEdge (options) - 2 * margin;
  const bool same_lattice = blocks.voxel_size_m == voxel_size_m && blocks.core_edge == core_edge;
  next.voxel_size_m = voxel_size_m;
  next.core_edge = core_edge;
  next.margin = margin;
  next.origin_m = same_lattice ? blocks.origin_m : layoutBox (box, voxel_size_m).origin_m;
  next.whole = same_lattice ? blocks.whole : Box ();
  next.whole = wholeOf (box, mode, next);
  const std::set<Place> places = occupiedPlaces (scene.background, planes, options, next);
  checkMemory (next, places, options.max_memory_bytes, used_bytes);

  const VoxelGrid whole = gridOf (next, next.whole);
  for (const Place& place : places)
  {
    const Box core = coreOf (next, place);
    const Box domain = domainOf (next, place);
    const auto old = same_lattice ? blocks.blocks.find (place) : blocks.blocks.end ();
    const bool is_kept = old != blocks.blocks.end () && isSame (old->second.core, core) &&
                         isSame (old->second.domain, domain);
    BackgroundBlock block = is_kept ? std::move (old->second) : makeBlock (next, core, domain, options);
    block.solved_share = 0.0;
    block.solver.iterations = 0;
    if (!block.body.evidence)
      block.body.evidence = std::make_unique<ShapeEvidence> (*block.body.grid, whole, options);
    next.blocks.emplace (place, std::move (block));
  }
  next.planes = std::move (blocks.planes);
  blocks = std::move (next);
  markChangedPlanes (planes, blocks);
}

BackgroundBlock*
ownerOf (BackgroundBlocks& blocks, const Eigen::Vector3i& voxel)
{
  const auto found = blocks.blocks.find (placeOf (blocks, voxel));
  return found == blocks.blocks.end () ? nullptr : &found->second;
}

void
takeFromNeighbours (BackgroundBlocks& blocks, BackgroundBlock& block)
{
  const Place place = placeOf (blocks, block.core.min ());
  for (int n = 0; n < 27; ++n)
  {
    const auto other = blocks.blocks.find ({place[0] + n / 9 - 1, place[1] + n / 3 % 3 - 1, place[2] + n % 3 - 1});
    if (n == 13 || other == blocks.blocks.end ())
      continue;
    const BackgroundBlock& from = other->second;
    const Box common = block.domain.intersection (from.core);
    if (common.isEmpty ())
      continue;
    const VoxelGrid& grid = *from.body.grid;
    forEachVoxelOf (block, common, [&] (const Eigen::Vector3i& voxel, std::size_t at) {
      const Eigen::Vector3i own = voxel - from.domain.min ();
      block.body.solution.u[at] = from.body.solution.u[grid.index (own.x (), own.y (), own.z ())];
    });
  }
}

Box
freeVoxels (const BackgroundBlocks& blocks, const BackgroundBlock& block)
{
  Eigen::Vector3i first, last;
  for (int a = 0; a < 3; ++a)
  {
    first[a] = block.domain.min ()[a] == blocks.whole.min ()[a] ? 0 : fixed_layers;
    last[a] = block.domain.sizes ()[a] - (block.domain.max ()[a] == blocks.whole.max ()[a] ? 0 : fixed_layers);
  }
  return {first, last};
}

} // namespace pcl::cosection
