// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "vessel_term.h"

#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/energy/data/imls_data_term.h"
#include "pcl_cosection/energy/least_wall.h"
#include "pcl_cosection/volume/distance_transform.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>

namespace pcl::cosection {
namespace {

constexpr float near_weight = 0.3f;      // sum of weights: a point within 1.1 sigma
constexpr float far_weight = 0.01f;      // sum of weights: a point within 2.1 sigma
constexpr float least_handle = 3.0f;     // points nearby: of cups without a handle up to 2 of 2700 lie off the wall
constexpr float gap_vox = 2.0f;          // the term applies at least so far from data
constexpr double step_vox = 0.7;         // between points of the unseen parts
constexpr double vessel_weight = 100.0;  // of a wall, in multiples of beta_extent; it vanishes with less
constexpr double empty_weight = 10.0;    // of its cavity
constexpr double least_wall = 0.6;       // least thickness of a wall, of its mean thickness: noise would make holes
constexpr float empty_margin_vox = 1.0f; // distance of expected empty space from the surface
constexpr double empty_far_vox = 6.0;    // largest expected signed distance

/** \brief One point per cube of half the width of the Gaussians: enough for a weak term, whatever the number of views.
 */
std::vector<OrientedPoint>
thinned (const VoxelGrid& grid, const std::vector<OrientedPoint>& points, double sigma_vox)
{
  VoxelGrid halves;
  halves.dims = (2.0 / sigma_vox * grid.dims.cast<double> ()).array ().ceil ().cast<int> ();
  halves.voxel_size_m = 0.5 * sigma_vox * grid.voxel_size_m;
  halves.origin_m = grid.origin_m - Eigen::Vector3d::Constant (0.5 * (grid.voxel_size_m - halves.voxel_size_m));
  std::vector<bool> taken (halves.size (), false);
  std::vector<OrientedPoint> first;
  for (const OrientedPoint& point : points)
    if (const auto cell = halves.nearest (point.position.cast<double> ()))
      if (std::vector<bool>::reference here = taken[halves.index (cell->x (), cell->y (), cell->z ())]; !here)
      {
        here = true;
        first.push_back (point);
      }
  return first;
}

std::vector<OrientedPoint>
pick (const std::vector<OrientedPoint>& points, const std::function<bool (const OrientedPoint&)>& picked)
{
  std::vector<OrientedPoint> some;
  std::copy_if (points.begin (), points.end (), std::back_inserter (some), picked);
  return some;
}

ImlsDataTerm
termOf (const BodyEnergy& energy, const std::vector<OrientedPoint>& points)
{
  ImlsDataTerm term;
  term.weight.assign (energy.grid.size (), 0.0f);
  term.weighted_target.assign (energy.grid.size (), 0.0f);
  term.count.assign (energy.grid.size (), 0.0f);
  term.add (energy.grid, points, energy.options.sigma_vox, energy.options.threads);
  return term;
}

/** \brief Signed distances from one part of a vessel's surface, as measured or else as expected. */
struct PartOfWall
{
  std::vector<float> distance;        // voxels, positive outside; -infinity where the part is not known
  std::vector<std::uint8_t> expected; // 1 where the distance is as expected

  PartOfWall (const BodyEnergy& energy, const std::vector<OrientedPoint>& seen,
              const std::vector<OrientedPoint>& hidden)
      : distance (energy.grid.size (), -std::numeric_limits<float>::infinity ())
      , expected (energy.grid.size ())
  {
    std::vector<std::uint8_t> near (energy.grid.size ());
    {
      const ImlsDataTerm term = termOf (energy, seen);
      for (std::size_t n = 0; n < near.size (); ++n)
      {
        near[n] = !energy.empty[n] && term.weight[n] >= near_weight;
        if (term.weight[n] >= far_weight)
          distance[n] = term.weighted_target[n] / term.weight[n];
      }
    }
    const std::vector<float> seen_distance = distanceTransform (energy.grid.dims, near, energy.options.threads);
    const ImlsDataTerm term = termOf (energy, hidden);
    for (std::size_t n = 0; n < near.size (); ++n)
      if (seen_distance[n] >= gap_vox && term.weight[n] >= near_weight)
      {
        expected[n] = 1;
        distance[n] = term.weighted_target[n] / term.weight[n];
      }
  }
};

} // namespace

void
addVessel (BodyEnergy& energy, const ProfiledShape& shape, const std::vector<OrientedPoint>& measured,
           Proposal& proposal)
{
  const std::vector<OrientedPoint> few = thinned (energy.grid, measured, std::max (1.0, energy.options.sigma_vox));
  const std::vector<OrientedPoint> expected = shape.hiddenSide (few, step_vox * energy.grid.voxel_size_m);
  const VoxelGrid& grid = energy.grid;
  const CoSectionOptions& options = energy.options;
  const auto isOfWall = [&] (const OrientedPoint& p) { return shape.holds (p.position.cast<double> ()); };
  const auto find = [&] (VesselPart part) {
    const auto isOfPart = [&] (const OrientedPoint& p) { return shape.partOf (p) == part; };
    return PartOfWall (energy, pick (measured, [&] (const OrientedPoint& p) { return isOfPart (p) && isOfWall (p); }),
                       pick (expected, isOfPart));
  };
  const PartOfWall outer = find (VesselPart::Outer), bottom = find (VesselPart::Bottom);
  const PartOfWall inner = find (VesselPart::Inner), rim = find (VesselPart::Rim);
  const ImlsDataTerm handles = termOf (energy, pick (measured, [&] (const OrientedPoint& p) { return !isOfWall (p); }));
  const double wall_vox = std::max (least_wall * shape.wallThickness () / grid.voxel_size_m, least_wall_vox);

  const auto set = [&] (std::size_t n, double weight, double target) {
    energy.problem.weight[n] = static_cast<float> (weight);
    energy.problem.weighted_target[n] = static_cast<float> (weight * target);
  };
  parallelFor (0, grid.dims.z (), threadsForVoxels (options.threads, grid.size ()), [&] (int k) {
    for (int j = 0; j < grid.dims.y (); ++j)
    {
      const std::vector<float> beyond_m = shape.region ().beyond (grid, j, k);
      for (int i = 0; i < grid.dims.x (); ++i)
      {
        const std::size_t n = grid.index (i, j, k);
        const auto beyond_vox = static_cast<float> (beyond_m[static_cast<std::size_t> (i)] / grid.voxel_size_m);
        proposal.least[n] = std::max (proposal.least[n], beyond_vox - empty_margin_vox);
        const bool is_handle = handles.weight[n] >= near_weight && handles.count[n] >= least_handle;
        if (energy.empty[n] || is_handle)
          continue;
        const PartOfWall& outside = outer.distance[n] > bottom.distance[n] ? outer : bottom;
        const double from_outside = outside.distance[n];
        const double from_inner = inner.distance[n];
        const double from_rim = rim.distance[n];
        // Missing thickness; 0 unless both sides are known.
        const double lacking = std::max (0.0, wall_vox + from_outside + from_inner);
        const double from_sides = std::max (from_outside, from_inner) - 0.5 * lacking;
        const double target = std::max (from_sides, from_rim);
        const PartOfWall& nearer = from_rim > from_sides ? rim : from_outside > from_inner ? outside : inner;
        if (nearer.expected[n])
          set (n, vessel_weight * options.beta_extent, target);
        else if (energy.problem.weight[n] > 0.0f && std::isfinite (target))
          set (n, energy.problem.weight[n], target);
        else if (energy.problem.weight[n] <= 0.0f)
        {
          const Eigen::Vector3d place = grid.center (i, j, k);
          const double clearance_vox = std::max (shape.depthInCavity (place), shape.depthUnder (place)) /
                                       grid.voxel_size_m;
          if (clearance_vox > empty_margin_vox)
            set (n, empty_weight * options.beta_extent, std::min (clearance_vox, empty_far_vox));
        }
      }
    }
  });
}

} // namespace pcl::cosection
