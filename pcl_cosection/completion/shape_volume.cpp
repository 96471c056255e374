// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "shape_volume.h"

#include "pcl_cosection/energy/solver/local_solver.h"
#include "pcl_cosection/energy/solver/solver_detail.h"
#include "pcl_cosection/priors/extent_bounds.h"
#include "pcl_cosection/priors/hidden_side_term.h"

#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/priors/contact_prior.h"
#include "pcl_cosection/volume/distance_transform.h"

#include <algorithm>
#include <cmath>

namespace pcl::cosection
{

namespace
{

constexpr float observed_weight = 0.3f; // sum of weights that makes a voxel one with data: a point within 1.1 sigma
constexpr double continued_plane_weight = 0.5;  // of the data term on a continued plane, as of a densely measured one
constexpr double continued_plane_gap_vox = 2.0; // planes are continued where no data is nearer
constexpr float carving_reach_vox = 1.5f;       // from the boundary of free space into the hull
constexpr std::size_t bytes_per_voxel = 94;
constexpr double
    follow_margin_vox = 3.0; // what follows new evidence at full resolution reaches so far beyond what is supported

} // namespace

ShapeVolume::ShapeVolume (const VoxelGrid& grid, const CoSectionOptions& options) : grid_ (grid), options_ (options)
{
  problem_.dims = grid.dims;
  problem_.alpha = options.alpha;
}

template <typename Function>
void
ShapeVolume::forEachVoxel (Function&& f) const
{
  const std::size_t plane = grid_.index (0, 0, 1);
  parallelFor (0, grid_.dims.z (), threadsForVoxels (options_.threads, grid_.size ()), [&] (int k) {
    for (std::size_t n = k * plane; n < (k + 1) * plane; ++n)
      f (n);
  });
}

std::size_t
ShapeVolume::estimateBytes (const VoxelGrid& grid)
{
  return grid.size () * bytes_per_voxel;
}

void
ShapeVolume::startFrom (const ShapeVolume& other)
{
  if (other.u_.empty () || !other.solved_fully_)
    return;
  const Eigen::Vector3i
      shift = ((grid_.origin_m - other.grid_.origin_m) / grid_.voxel_size_m).array ().round ().cast<int> ();
  u_.resize (grid_.size ());
  for (int k = 0; k < grid_.dims.z (); ++k)
    for (int j = 0; j < grid_.dims.y (); ++j)
      for (int i = 0; i < grid_.dims.x (); ++i)
      {
        // Beyond the other volume it is as far outside as its border is, and the way to there.
        const Eigen::Vector3i at = Eigen::Vector3i (i, j, k) + shift;
        const Eigen::Vector3i inside = at.cwiseMax (0).cwiseMin (other.grid_.dims - Eigen::Vector3i::Ones ());
        u_[grid_.index (i, j, k)] = other.u_[other.grid_.index (inside.x (), inside.y (), inside.z ())] +
                                    static_cast<float> ((at - inside).cast<double> ().norm ());
      }
  solved_fully_ = true;
  if (grid_.origin_m == other.grid_.origin_m && grid_.dims == other.grid_.dims)
    quarter_ = other.quarter_;
}

bool
ShapeVolume::hasData () const
{
  return std::any_of (data_.begin (), data_.end (), [] (std::uint8_t d) { return d != 0; });
}

void
ShapeVolume::prepare (const ShapeEvidence& evidence, const std::vector<PlaneContinuation>& planes)
{
  changed_ = true;
  free_space_ = evidence.freeSpace ();
  empty_ = free_space_;
  facing_ = NormalBinOccupancy ();
  carved_ = evidence.carvedBounds ();
  evidence.data ().average (options_.weighting, problem_.weight, problem_.weighted_target, options_.threads);
  data_.resize (grid_.size ());
  forEachVoxel ([&] (std::size_t n) {
    if (free_space_[n])
      problem_.weight[n] = problem_.weighted_target[n] = 0.0f;
    data_[n] = !free_space_[n] && evidence.data ().weight[n] >= observed_weight;
  });
  data_distance_vox_ = distanceTransform (grid_.dims, data_, options_.threads);
  continued_.assign (planes.empty () ? 0 : grid_.size (), 0);

  for (const PlaneContinuation& continuation : planes)
    parallelFor (0, grid_.dims.z (), options_.threads, [&] (int k) {
      for (int j = 0; j < grid_.dims.y (); ++j)
        for (int i = 0; i < grid_.dims.x (); ++i)
        {
          const std::size_t n = grid_.index (i, j, k);
          if (free_space_[n] || data_distance_vox_[n] < continued_plane_gap_vox)
            continue;
          const Eigen::Vector3d p = grid_.center (i, j, k);
          const double s = (continuation.plane.head<3> ().dot (p) + continuation.plane[3]) / grid_.voxel_size_m;
          if (std::abs (s) > 3.0 * options_.sigma_vox || !continuation.region.contains (p))
            continue;
          const double w = continued_plane_weight * std::exp (-s * s / (options_.sigma_vox * options_.sigma_vox));
          problem_.weight[n] = static_cast<float> (w);
          problem_.weighted_target[n] = static_cast<float> (w * s);
          if (std::abs (s) <= 1.0)
            data_[n] = continued_[n] = 1;
        }
    });
  if (!planes.empty ())
    data_distance_vox_ = distanceTransform (grid_.dims, data_, options_.threads);

  if (options_.use_hull && options_.beta_hull > 0.0)
  {
    const std::vector<float> distance = hullDistance (grid_.dims, free_space_, options_.threads);
    problem_.exterior.resize (grid_.size ());
    forEachVoxel ([&] (std::size_t n) {
      problem_.exterior[n] = free_space_[n]
                                 ? LowerBound (options_.hull_distance == HullDistance::Exact ? distance[n] : 1.0f,
                                               static_cast<float> (options_.beta_hull))
                                 : LowerBound ();
    });
  }
}

void
ShapeVolume::setRaysWithoutReturn (const std::vector<std::uint8_t>& open)
{
  empty_ = free_space_;
  for (std::size_t n = 0; n < open.size (); ++n)
    empty_[n] |= open[n] && !data_[n];
}

std::vector<float>
ShapeVolume::distanceToExpected (const std::vector<SymmetricExtent>& plausible) const
{
  std::vector<std::uint8_t> expected;
  for (const SymmetricExtent& extent : plausible)
    for (const OrientedPoint& point : extent.continuation ())
    {
      // The wall, and what it encloses: from it inwards as far as to beside the middle.
      const Eigen::Vector3d wall = point.position.cast<double> ();
      const Eigen::Vector3d outwards = point.normal.cast<double> ();
      const double middle_m = std::max (0.0, outwards.dot (wall - extent.center ()));
      for (double depth_m = 0.0; depth_m <= middle_m; depth_m += grid_.voxel_size_m)
        if (const auto at = grid_.nearest (wall - depth_m * outwards))
        {
          if (expected.empty ())
            expected = data_;
          expected[grid_.index (at->x (), at->y (), at->z ())] = 1;
        }
    }
  return expected.empty () ? data_distance_vox_ : distanceTransform (grid_.dims, expected, options_.threads);
}

void
ShapeVolume::addExtentPrior (const ExtentPrior& prior, const Eigen::Vector3d& extents_m, OcclusionMap& places,
                             const std::vector<SymmetricExtent>& plausible)
{
  if (options_.beta_extent <= 0.0)
    return;
  problem_.exterior.resize (grid_.size ());
  std::vector<std::uint8_t> bounded (grid_.size ());
  for (std::size_t n = 0; n < grid_.size (); ++n)
    bounded[n] = static_cast<bool> (problem_.exterior[n]);
  std::vector<float> bounds = extentBounds (prior, grid_, distanceToExpected (plausible), extents_m, places, plausible,
                                            bounded, options_.threads);
  if (empty_ != free_space_)
  {
    // An open place is no farther from the surface than from the nearest place that is not open.
    std::vector<std::uint8_t> closed (grid_.size ());
    for (std::size_t n = 0; n < grid_.size (); ++n)
      closed[n] = !empty_[n];
    const std::vector<float> depth_vox = distanceTransform (grid_.dims, closed, options_.threads);
    const auto side_vox = static_cast<float> (prior.side_factor * extents_m[1] / grid_.voxel_size_m);
    for (std::size_t n = 0; n < grid_.size (); ++n)
      if (!bounded[n] && empty_[n] && !free_space_[n])
        bounds[n] = std::max (bounds[n], std::min (data_distance_vox_[n] - side_vox, depth_vox[n]));
  }
  for (std::size_t n = 0; n < grid_.size (); ++n)
    if (bounds[n] > 0.0f)
      problem_.exterior[n] = LowerBound (bounds[n], static_cast<float> (options_.beta_extent));
}

void
ShapeVolume::addHiddenSide (const SymmetricExtent& plausible, const std::vector<OrientedPoint>& points)
{
  if (options_.beta_extent > 0.0)
    cosection::addHiddenSide (problem_, grid_, plausible, points, {empty_, data_distance_vox_}, options_);
  if (plausible.wallThickness () > 0.0)
    facing_ = NormalBinOccupancy (grid_, points);
}

void
ShapeVolume::addContactPrior (const std::vector<OrientedPoint>& points, const Eigen::Vector4d& plane,
                              const Eigen::Vector3d& center)
{
  if (options_.beta_contact <= 0.0)
    return;
  const std::vector<std::uint8_t> patch = ContactPrior ().patch (grid_, plane, points, center, empty_);
  for (std::size_t n = 0; n < patch.size (); ++n)
  {
    if (!patch[n] || data_[n])
      continue;
    const auto i = static_cast<int> (n % grid_.dims.x ());
    const auto j = static_cast<int> (n / grid_.dims.x () % grid_.dims.y ());
    const auto k = static_cast<int> (n / grid_.dims.x () / grid_.dims.y ());
    const double height_vox = (plane.head<3> ().dot (grid_.center (i, j, k)) + plane[3]) / grid_.voxel_size_m;
    problem_.weight[n] += static_cast<float> (options_.beta_contact);
    problem_.weighted_target[n] -= static_cast<float> (options_.beta_contact * height_vox);
  }
}

void
ShapeVolume::setIntersection (std::vector<LowerBound> bounds)
{
  changed_ |= bounds != problem_.intersection;
  problem_.intersection = std::move (bounds);
}

SolverSummary
ShapeVolume::solve (Resolution resolution, const ProgressCallback& progress)
{
  SolverOptions solver = options_.solver;
  solver.threads = options_.threads;
  changed_ = false;
  if (resolution == Resolution::Half && solveAtHalfResolution (problem_, solver, half_u_, u_, progress))
    return {};
  std::vector<float> ().swap (half_u_);
  solved_fully_ = true;
  return cosection::solve (problem_, solver, u_, progress);
}

SolverSummary
ShapeVolume::follow (const ProgressCallback& progress)
{
  SolverOptions solver = options_.solver;
  solver.threads = options_.threads;
  QuarterResolution quarter;
  std::swap (quarter, quarter_); // back when all has been done
  const bool follows = quarter.update (problem_, solver, u_, progress) && solved_fully_;
  std::optional<LocalSolution> local;
  if (follows)
  {
    const auto reach_vox = static_cast<float> (options_.max_bound_vox + follow_margin_vox);
    local = solveNearData (problem_, solver, {data_distance_vox_, reach_vox}, u_, progress);
  }
  solved_share_ = local ? static_cast<double> (local->voxels) / static_cast<double> (grid_.size ()) : 1.0;
  const SolverSummary summary = local ? local->summary : solve (Resolution::Full, progress);
  changed_ = false;
  quarter_ = std::move (quarter);
  return summary;
}

SignedDistanceField
ShapeVolume::measuredField () const
{
  SignedDistanceField field;
  field.grid = grid_;
  field.values.resize (grid_.size (), 0.0f);
  field.supported.resize (grid_.size (), 0);
  for (std::size_t n = 0; n < grid_.size (); ++n)
    if (data_[n])
    {
      field.values[n] = static_cast<float> (problem_.weighted_target[n] / problem_.weight[n] * grid_.voxel_size_m);
      field.supported[n] = 1;
    }
  return field;
}

float
ShapeVolume::carvedValue (std::size_t n) const
{
  if (carved_.empty () || carved_[n] <= -carving_reach_vox)
    return u_[n];
  return std::max (u_[n], carved_[n]);
}

std::vector<std::uint8_t>
ShapeVolume::supported () const
{
  std::vector<std::uint8_t> supported (grid_.size ());
  forEachVoxel (
      [&] (std::size_t n) { supported[n] = !free_space_[n] && data_distance_vox_[n] <= options_.max_bound_vox; });
  return supported;
}

SignedDistanceField
ShapeVolume::solvedField () const
{
  SignedDistanceField field;
  field.grid = grid_;
  field.values.resize (grid_.size ());
  forEachVoxel ([&] (std::size_t n) { field.values[n] = static_cast<float> (carvedValue (n) * grid_.voxel_size_m); });
  field.supported = supported ();
  return field;
}

} // namespace pcl::cosection
