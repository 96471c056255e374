// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "shape_volume.h"

#include "extent_bounds.h"
#include "solver_detail.h"

#include <pcl/cosection/common/parallel.h>
#include <pcl/cosection/surface/contact_prior.h>
#include <pcl/cosection/volume/distance_transform.h>
#include <pcl/cosection/volume/iso_surface.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl
{
namespace cosection
{

namespace
{

constexpr float observed_weight = 0.3f;        // sum of weights that makes a voxel one with data: a point within 1.1 sigma
constexpr double continued_plane_weight = 0.5; // of the data term on a continued plane, as of a densely measured one
constexpr double continued_plane_gap_vox = 2.0; // planes are continued where no data is nearer
constexpr double observed_reach_vox = 1.0;
constexpr double intersection_reach_vox = 1.0;
constexpr double hull_reach_vox = 1.5;
constexpr float carving_reach_vox = 1.5f; // from the boundary of free space into the hull
constexpr float vouched_depth_vox = 3.0f;  // behind a measured surface, where matter is sure: the reach of its points
constexpr float vouched_step_vox = 0.5f;
constexpr float vouched_radius_vox = 0.75f; // closes the gaps between points
constexpr float least_free_vox = 0.25f;    // of a voxel seen free, from the surface of the hull
constexpr double half_cells_vox = 1.0;      // what is lost by taking a point and a vertex for their voxels' centres
constexpr double confidence_scale_vox = 5.0;
constexpr std::size_t bytes_per_voxel = 80;
constexpr float border_voxels = 2.0f; // a closed surface stays so far inside its volume

/** \brief Raise a field near the border so that its zero set stays inside. */
void
keepOffBorder (SignedDistanceField& field)
{
  const Eigen::Vector3i& dims = field.grid.dims;
  for (int k = 0; k < dims.z (); ++k)
    for (int j = 0; j < dims.y (); ++j)
      for (int i = 0; i < dims.x (); ++i)
      {
        const int border = std::min ({i, j, k, dims.x () - 1 - i, dims.y () - 1 - j, dims.z () - 1 - k});
        const float bound = static_cast<float> ((border_voxels - static_cast<float> (border)) * field.grid.voxel_size_m);
        float& value = field.values[field.grid.index (i, j, k)];
        value = std::max (value, bound);
      }
}

} // namespace

ShapeVolume::ShapeVolume (const VoxelGrid& grid, const CoSectionOptions& options)
: grid_ (grid), options_ (options)
{
  problem_.dims = grid.dims;
  problem_.alpha = options.alpha;
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
  const Eigen::Vector3i shift =
      ((grid_.origin_m - other.grid_.origin_m) / grid_.voxel_size_m).array ().round ().cast<int> ();
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
  carved_ = evidence.carvedBounds ();
  evidence.data ().average (options_.weighting, problem_.weight, problem_.weighted_target);
  data_.assign (grid_.size (), 0);
  for (std::size_t n = 0; n < grid_.size (); ++n)
  {
    if (free_space_[n])
      problem_.weight[n] = problem_.weighted_target[n] = 0.0f;
    else
      data_[n] = evidence.data ().weight[n] >= observed_weight;
  }
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
    problem_.exterior.assign (grid_.size (), LowerBound ());
    for (std::size_t n = 0; n < grid_.size (); ++n)
      if (free_space_[n])
        problem_.exterior[n] = LowerBound (options_.hull_distance == HullDistance::Exact ? distance[n] : 1.0f,
                                           static_cast<float> (options_.beta_hull));
  }
}

void
ShapeVolume::addExtentPrior (const ExtentPrior& prior, const Eigen::Vector3d& extents_m, HiddenPlaces& places,
                             const std::vector<SymmetricExtent>& plausible)
{
  if (options_.beta_extent <= 0.0)
    return;
  problem_.exterior.resize (grid_.size ());
  std::vector<std::uint8_t> bounded (grid_.size ());
  for (std::size_t n = 0; n < grid_.size (); ++n)
    bounded[n] = static_cast<bool> (problem_.exterior[n]);
  const std::vector<float> bounds =
      extentBounds (prior, grid_, data_distance_vox_, extents_m, places, plausible, bounded, options_.threads);
  for (std::size_t n = 0; n < grid_.size (); ++n)
    if (bounds[n] > 0.0f)
      problem_.exterior[n] = LowerBound (bounds[n], static_cast<float> (options_.beta_extent));
}

void
ShapeVolume::addContactPrior (const std::vector<OrientedPoint>& points, const Eigen::Vector4d& plane,
                              const Eigen::Vector3d& center)
{
  if (options_.beta_contact <= 0.0)
    return;
  const std::vector<std::uint8_t> patch = ContactPrior ().patch (grid_, plane, points, center, free_space_);
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
  for (std::size_t n = 0; n < grid_.size (); ++n)
    supported[n] = !free_space_[n] && data_distance_vox_[n] <= options_.max_bound_vox;
  return supported;
}

SignedDistanceField
ShapeVolume::solvedField () const
{
  SignedDistanceField field;
  field.grid = grid_;
  field.values.resize (grid_.size ());
  for (std::size_t n = 0; n < grid_.size (); ++n)
    field.values[n] = static_cast<float> (carvedValue (n) * grid_.voxel_size_m);
  field.supported = supported ();
  return field;
}

float
ShapeVolume::hullValue (std::size_t n) const
{
  if (carved_.empty ())
    return free_space_[n] ? 0.5f : -0.5f;
  return free_space_[n] ? std::max (carved_[n], least_free_vox) : carved_[n];
}

template <typename Value> TriangleMesh
ShapeVolume::closedMeshOf (Value&& value) const
{
  IsoSurfaceOptions iso;
  iso.closed = true;
  iso.threads = options_.threads;
  SignedDistanceField field;
  field.grid = grid_;
  field.values.resize (grid_.size ());
  for (std::size_t n = 0; n < grid_.size (); ++n)
    field.values[n] = static_cast<float> (value (n) * grid_.voxel_size_m);
  keepOffBorder (field);
  TriangleMesh mesh = extractIsoSurface (field, iso);
  attachEvidence (mesh);
  return mesh;
}

TriangleMesh
ShapeVolume::observedParts (const TriangleMesh& mesh)
{
  const std::vector<int> component = labelComponents (mesh);
  std::vector<bool> observed (component.empty () ? 0 : *std::max_element (component.begin (), component.end ()) + 1, false);
  for (std::size_t v = 0; v < mesh.vertices.size (); ++v)
    if (mesh.provenance[v] == static_cast<std::uint8_t> (Provenance::Observed))
      observed[component[v]] = true;
  std::vector<bool> keep (mesh.triangles.size ());
  for (std::size_t t = 0; t < keep.size (); ++t)
    keep[t] = observed[component[mesh.triangles[t][0]]];
  return extractTriangles (mesh, keep);
}

TriangleMesh
ShapeVolume::closedMesh () const
{
  return observedParts (closedMeshOf ([this] (std::size_t n) { return carvedValue (n); }));
}

TriangleMesh
ShapeVolume::hullMesh () const
{
  return closedMeshOf ([this] (std::size_t n) { return hullValue (n); });
}

TriangleMesh
ShapeVolume::innerMesh (const std::vector<OrientedPoint>& points) const
{
  // Every point vouches for the voxels straight behind it.
  std::vector<std::uint8_t> vouched (grid_.size (), 0);
  for (const OrientedPoint& point : points)
    for (float depth = 0.0f; depth <= vouched_depth_vox; depth += vouched_step_vox)
    {
      const Eigen::Vector3d behind =
          point.position.cast<double> () - depth * grid_.voxel_size_m * point.normal.cast<double> ();
      if (const auto at = grid_.nearest (behind))
        vouched[grid_.index (at->x (), at->y (), at->z ())] = 1;
    }
  const std::vector<float> distance = distanceTransform (grid_.dims, vouched, options_.threads);
  return observedParts (
      closedMeshOf ([&] (std::size_t n) { return std::max (carvedValue (n), distance[n] - vouched_radius_vox); }));
}

TriangleMesh
ShapeVolume::outerMesh () const
{
  return closedMeshOf ([this] (std::size_t n) { return std::min (carvedValue (n), hullValue (n)); });
}

TriangleMesh
ShapeVolume::trimmedMesh (const std::vector<OrientedPoint>& points) const
{
  std::vector<std::uint8_t> seen = continued_;
  seen.resize (grid_.size (), 0);
  for (const OrientedPoint& point : points)
    if (const auto at = grid_.nearest (point.position.cast<double> ()))
      seen[grid_.index (at->x (), at->y (), at->z ())] = 1;
  const std::vector<float> distance_vox = distanceTransform (grid_.dims, seen, options_.threads);
  const double reach_vox = options_.max_bound_vox - half_cells_vox;

  IsoSurfaceOptions iso;
  iso.closed = false;
  iso.threads = options_.threads;
  const SignedDistanceField field = solvedField ();
  TriangleMesh mesh = extractIsoSurface (field, iso);
  attachEvidence (mesh);
  std::vector<bool> near (mesh.vertices.size ());
  for (std::size_t v = 0; v < near.size (); ++v)
  {
    const Eigen::Vector3i at = grid_.toVoxel (mesh.vertices[v].cast<double> ()).array ().round ().cast<int> ();
    if (!grid_.contains (at.x (), at.y (), at.z ()))
      continue;
    const std::size_t n = grid_.index (at.x (), at.y (), at.z ());
    near[v] = field.supported[n] && distance_vox[n] <= reach_vox;
  }
  std::vector<bool> keep (mesh.triangles.size ());
  for (std::size_t t = 0; t < keep.size (); ++t)
    keep[t] = near[mesh.triangles[t][0]] && near[mesh.triangles[t][1]] && near[mesh.triangles[t][2]];
  return extractTriangles (mesh, keep);
}

void
ShapeVolume::attachEvidence (TriangleMesh& mesh) const
{
  mesh.confidence.resize (mesh.vertices.size ());
  mesh.provenance.resize (mesh.vertices.size ());
  parallelFor (0, static_cast<int> (mesh.vertices.size ()), options_.threads, [&] (int v) {
    const Eigen::Vector3d at = grid_.toVoxel (mesh.vertices[v].cast<double> ());
    double data_distance = std::numeric_limits<double>::infinity ();
    bool bounded_by_body = false;
    bool bounded_by_hull = false;
    constexpr int reach = 2; // voxels, of the largest distance below
    const Eigen::Vector3i base = at.array ().floor ().cast<int> ();
    for (int dz = -reach + 1; dz <= reach; ++dz)
      for (int dy = -reach + 1; dy <= reach; ++dy)
        for (int dx = -reach + 1; dx <= reach; ++dx)
        {
          const Eigen::Vector3i cell = base + Eigen::Vector3i (dx, dy, dz);
          if (!grid_.contains (cell.x (), cell.y (), cell.z ()))
            continue;
          const std::size_t n = grid_.index (cell.x (), cell.y (), cell.z ());
          const double distance = (cell.cast<double> () - at).norm ();
          data_distance = std::min (data_distance, data_[n] ? distance : distance + data_distance_vox_[n]);
          bounded_by_hull |= (free_space_[n] || (!carved_.empty () && carved_[n] >= 0.0f)) && distance <= hull_reach_vox;
          bounded_by_body |= !problem_.intersection.empty () && problem_.intersection[n] &&
                             u_[n] < problem_.intersection[n].distance () && distance <= intersection_reach_vox;
        }
    Provenance provenance = Provenance::Inferred;
    if (data_distance <= observed_reach_vox)
      provenance = Provenance::Observed;
    else if (bounded_by_body)
      provenance = Provenance::Intersection;
    else if (bounded_by_hull)
      provenance = Provenance::Hull;
    mesh.provenance[v] = static_cast<std::uint8_t> (provenance);
    mesh.confidence[v] = static_cast<float> (std::exp (-data_distance / confidence_scale_vox));
  });
}

} // namespace cosection
} // namespace pcl
