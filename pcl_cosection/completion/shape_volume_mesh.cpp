// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "shape_volume.h"

#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/volume/distance_transform.h"
#include <pcl/cosection/volume/iso_surface.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

// The part of a volume that turns its field into meshes.

namespace pcl::cosection
{

namespace
{

constexpr double observed_reach_vox = 1.0;
constexpr double intersection_reach_vox = 1.0;
constexpr double hull_reach_vox = 1.5;
constexpr float vouched_depth_vox = 3.0f; // behind a measured surface, where matter is sure: the reach of its points
constexpr float vouched_step_vox = 0.5f;
constexpr float vouched_radius_vox = 0.75f; // closes the gaps between points
constexpr double half_cells_vox = 1.0;      // what is lost by taking a point and a vertex for their voxels' centres
constexpr double confidence_scale_vox = 5.0;
constexpr double small_component_voxels = 3.0; // long: what is smaller, beside something larger, is noise
struct Lump                                    // a part that is no more than noise: all of this holds
{
  float length;  // less, of the longest part's
  double share;  // of its vertices less are observed, of the share of the part seen best
  double weight; // less of all that are observed
};

constexpr std::array<Lump, 2> lumps = {{{0.33f, 0.5, 0.02}, {1.0f, 0.3, 0.04}}};
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
        const float bound = static_cast<float> ((border_voxels - static_cast<float> (border)) *
                                                field.grid.voxel_size_m);
        float& value = field.values[field.grid.index (i, j, k)];
        value = std::max (value, bound);
      }
}

} // namespace

template <typename Value>
TriangleMesh
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
ShapeVolume::observedParts (const TriangleMesh& mesh) const
{
  const std::vector<int> component = labelComponents (mesh);
  const std::size_t count = component.empty () ? 0 : *std::max_element (component.begin (), component.end ()) + 1;
  std::vector<std::size_t> all (count, 0), observed (count, 0); // vertices
  std::vector<Eigen::AlignedBox3f> boxes (count);
  for (std::size_t v = 0; v < mesh.vertices.size (); ++v)
  {
    boxes[component[v]].extend (mesh.vertices[v]);
    ++all[component[v]];
    observed[component[v]] += mesh.provenance[v] == static_cast<std::uint8_t> (Provenance::Observed);
  }
  const auto length = [&] (std::size_t c) { return boxes[c].sizes ().maxCoeff (); };
  float longest = 0.0f;
  for (std::size_t c = 0; c < count; ++c)
    if (observed[c] > 0)
      longest = std::max (longest, length (c));
  const float small_component = std::min (longest, static_cast<float> (small_component_voxels * grid_.voxel_size_m));
  const std::size_t all_observed = std::accumulate (observed.begin (), observed.end (), std::size_t (0));
  const auto share = [&] (std::size_t c) { return static_cast<double> (observed[c]) / static_cast<double> (all[c]); };
  const std::ptrdiff_t best = observed.empty ()
                                  ? 0
                                  : std::max_element (observed.begin (), observed.end ()) - observed.begin ();
  // What sensors see at the edge of something, between it and what is behind, makes lumps of which little more than
  // that is observed.
  const auto is_lump = [&] (std::size_t c) {
    return std::any_of (lumps.begin (), lumps.end (), [&] (const Lump& lump) {
      return length (c) < lump.length * longest && share (c) < lump.share * share (static_cast<std::size_t> (best)) &&
             static_cast<double> (observed[c]) < lump.weight * static_cast<double> (all_observed);
    });
  };
  std::vector<bool> keep (mesh.triangles.size ());
  for (std::size_t t = 0; t < keep.size (); ++t)
  {
    const auto c = static_cast<std::size_t> (component[mesh.triangles[t][0]]);
    keep[t] = observed[c] > 0 && length (c) >= small_component && !is_lump (c);
  }
  return extractTriangles (mesh, keep);
}

TriangleMesh
ShapeVolume::closedMesh () const
{
  return observedParts (closedMeshOf ([this] (std::size_t n) { return carvedValue (n); }));
}

TriangleMesh
ShapeVolume::innerMesh (const std::vector<OrientedPoint>& points) const
{
  // Every point vouches for the voxels straight behind it.
  std::vector<std::uint8_t> vouched (grid_.size (), 0);
  for (const OrientedPoint& point : points)
    for (float depth = 0.0f; depth <= vouched_depth_vox; depth += vouched_step_vox)
    {
      const Eigen::Vector3d behind = point.position.cast<double> () -
                                     depth * grid_.voxel_size_m * point.normal.cast<double> ();
      if (const auto at = grid_.nearest (behind))
        vouched[grid_.index (at->x (), at->y (), at->z ())] = 1;
    }
  const std::vector<float> distance = distanceTransform (grid_.dims, vouched, options_.threads);
  return observedParts (
      closedMeshOf ([&] (std::size_t n) { return std::max (carvedValue (n), distance[n] - vouched_radius_vox); }));
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
          bounded_by_hull |= (free_space_[n] || (!carved_.empty () && carved_[n] >= 0.0f)) &&
                             distance <= hull_reach_vox;
          bounded_by_body |= !problem_.intersection.empty () && problem_.intersection[n] &&
                             u_[n] < problem_.intersection[n].distance () && distance <= intersection_reach_vox;
        }
    Provenance provenance = Provenance::Inferred;
    if (data_distance <= observed_reach_vox && (facing_.empty () || facing_.face (mesh.vertices[v], mesh.normals[v])))
      provenance = Provenance::Observed;
    else if (bounded_by_body)
      provenance = Provenance::Intersection;
    else if (bounded_by_hull)
      provenance = Provenance::Hull;
    mesh.provenance[v] = static_cast<std::uint8_t> (provenance);
    mesh.confidence[v] = static_cast<float> (std::exp (-data_distance / confidence_scale_vox));
  });
}

} // namespace pcl::cosection
