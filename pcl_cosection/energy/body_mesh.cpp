// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "body_mesh.h"

#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/volume/distance_transform.h"
#include <pcl/cosection/volume/iso_surface.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace pcl::cosection {
namespace {

constexpr double observed_reach_vox = 1.0;
constexpr double intersection_reach_vox = 1.0;
constexpr double hull_reach_vox = 1.5;
constexpr float vouched_depth_vox = 3.0f; // depth of sure matter behind a measured surface: the cutoff of the data term
constexpr float vouched_step_vox = 0.5f;
constexpr float vouched_radius_vox = 0.75f; // closes the gaps between points
constexpr double half_cells_vox = 1.0;      // largest error of replacing a point and a vertex by their voxels' centres
constexpr double confidence_scale_vox = 5.0;
constexpr double small_component_voxels = 3.0; // length: smaller components beside a larger one are noise

/** \brief A component is noise if it is smaller than all of this. */
struct NoiseLimits
{
  float length;  // relative to the longest component
  double share;  // observed share of its vertices, relative to the best observed component
  double weight; // share of all observed vertices
};

constexpr std::array<NoiseLimits, 2> noise_limits = {{{0.33f, 0.5, 0.02}, {1.0f, 0.3, 0.04}}};
constexpr float border_voxels = 2.0f; // distance of a closed surface from the border of its volume

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

/** \brief Provenance and confidence of each vertex. */
void
attachEvidence (const BodyEnergy& energy, const BodySolution& solution, TriangleMesh& mesh)
{
  mesh.confidence.resize (mesh.vertices.size ());
  mesh.provenance.resize (mesh.vertices.size ());
  parallelFor (0, static_cast<int> (mesh.vertices.size ()), energy.options.threads, [&] (int v) {
    const Eigen::Vector3d at = energy.grid.toVoxel (mesh.vertices[v].cast<double> ());
    double data_distance = std::numeric_limits<double>::infinity ();
    bool bounded_by_body = false;
    bool bounded_by_hull = false;
    constexpr int reach = 2; // voxels, the largest distance below rounded up
    const Eigen::Vector3i base = at.array ().floor ().cast<int> ();
    for (int dz = -reach + 1; dz <= reach; ++dz)
      for (int dy = -reach + 1; dy <= reach; ++dy)
        for (int dx = -reach + 1; dx <= reach; ++dx)
        {
          const Eigen::Vector3i cell = base + Eigen::Vector3i (dx, dy, dz);
          if (!energy.grid.contains (cell.x (), cell.y (), cell.z ()))
            continue;
          const std::size_t n = energy.grid.index (cell.x (), cell.y (), cell.z ());
          const double distance = (cell.cast<double> () - at).norm ();
          data_distance = std::min (data_distance, energy.data[n] ? distance : distance + energy.data_distance_vox[n]);
          bounded_by_hull |= (energy.free_space[n] || (!energy.carved.empty () && energy.carved[n] >= 0.0f)) &&
                             distance <= hull_reach_vox;
          bounded_by_body |= !energy.problem.intersection.empty () && energy.problem.intersection[n] &&
                             solution.u[n] < energy.problem.intersection[n].distance () &&
                             distance <= intersection_reach_vox;
        }
    Provenance provenance = Provenance::Inferred;
    if (data_distance <= observed_reach_vox &&
        (energy.facing.empty () || energy.facing.face (mesh.vertices[v], mesh.normals[v])))
      provenance = Provenance::Observed;
    else if (bounded_by_body)
      provenance = Provenance::Intersection;
    else if (bounded_by_hull)
      provenance = Provenance::Hull;
    mesh.provenance[v] = static_cast<std::uint8_t> (provenance);
    mesh.confidence[v] = static_cast<float> (std::exp (-data_distance / confidence_scale_vox));
  });
}

/** \brief Zero set of a field, value (n) in voxels. */
template <typename Value>
TriangleMesh
closedMeshOf (const BodyEnergy& energy, const BodySolution& solution, Value&& value)
{
  SignedDistanceField field;
  field.grid = energy.grid;
  field.values.resize (energy.grid.size ());
  for (std::size_t n = 0; n < energy.grid.size (); ++n)
    field.values[n] = static_cast<float> (value (n) * energy.grid.voxel_size_m);
  keepOffBorder (field);
  const IsoSurfaceOptions closed{true, energy.options.threads};
  TriangleMesh mesh = extractIsoSurface (field, closed);
  attachEvidence (energy, solution, mesh);
  return mesh;
}

/** \brief The mesh without components that have no data, and without those that are noise. */
TriangleMesh
observedComponents (const BodyEnergy& energy, const TriangleMesh& mesh)
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
  const float small_component = std::min (longest,
                                          static_cast<float> (small_component_voxels * energy.grid.voxel_size_m));
  const std::size_t all_observed = std::accumulate (observed.begin (), observed.end (), std::size_t (0));
  const auto share = [&] (std::size_t c) { return static_cast<double> (observed[c]) / static_cast<double> (all[c]); };
  const std::size_t best = std::max_element (observed.begin (), observed.end ()) - observed.begin ();
  // Mixed pixels at a depth edge make small components with hardly any observed vertices but those pixels.
  const auto is_noise = [&] (std::size_t c) {
    return std::any_of (noise_limits.begin (), noise_limits.end (), [&] (const NoiseLimits& limits) {
      return length (c) < limits.length * longest && share (c) < limits.share * share (best) &&
             static_cast<double> (observed[c]) < limits.weight * static_cast<double> (all_observed);
    });
  };
  std::vector<bool> keep (mesh.triangles.size ());
  for (std::size_t t = 0; t < keep.size (); ++t)
  {
    const auto c = static_cast<std::size_t> (component[mesh.triangles[t][0]]);
    keep[t] = observed[c] > 0 && length (c) >= small_component && !is_noise (c);
  }
  return extractTriangles (mesh, keep);
}

/** \brief Zero set of a field between some voxels. \param[in] within empty: everywhere */
TriangleMesh
openMesh (const SignedDistanceField& field, const Eigen::AlignedBox3i& within, int threads)
{
  if (within.isEmpty ())
    return extractIsoSurface (field, IsoSurfaceOptions{false, threads});
  std::vector<std::uint8_t> marks (field.grid.size (), 0);
  for (int k = within.min ().z (); k <= within.max ().z (); ++k)
    for (int j = within.min ().y (); j <= within.max ().y (); ++j)
      std::fill_n (marks.begin () + static_cast<std::ptrdiff_t> (field.grid.index (within.min ().x (), j, k)),
                   within.sizes ().x () + 1, std::uint8_t (1));
  return extractOpenIsoSurface (field, marks, threads);
}

} // namespace

TriangleMesh
closedMesh (const BodyEnergy& energy, const BodySolution& solution)
{
  return observedComponents (
      energy, closedMeshOf (energy, solution, [&] (std::size_t n) { return carvedValue (energy, solution, n); }));
}

TriangleMesh
innerMesh (const BodyEnergy& energy, const BodySolution& solution, const std::vector<OrientedPoint>& points)
{
  // The voxels straight behind each point are surely matter.
  std::vector<std::uint8_t> vouched (energy.grid.size (), 0);
  for (const OrientedPoint& point : points)
    for (float depth = 0.0f; depth <= vouched_depth_vox; depth += vouched_step_vox)
    {
      const Eigen::Vector3d behind = point.position.cast<double> () -
                                     depth * energy.grid.voxel_size_m * point.normal.cast<double> ();
      if (const auto at = energy.grid.nearest (behind))
        vouched[energy.grid.index (at->x (), at->y (), at->z ())] = 1;
    }
  const std::vector<float> distance = distanceTransform (energy.grid.dims, vouched, energy.options.threads);
  return observedComponents (energy, closedMeshOf (energy, solution, [&] (std::size_t n) {
                               return std::max (carvedValue (energy, solution, n), distance[n] - vouched_radius_vox);
                             }));
}

TriangleMesh
trimmedMesh (const BodyEnergy& energy, const BodySolution& solution, const std::vector<OrientedPoint>& points,
             const Eigen::AlignedBox3i& within)
{
  std::vector<std::uint8_t> seen = energy.continued;
  seen.resize (energy.grid.size (), 0);
  for (const OrientedPoint& point : points)
    if (const auto at = energy.grid.nearest (point.position.cast<double> ()))
      seen[energy.grid.index (at->x (), at->y (), at->z ())] = 1;
  const std::vector<float> distance_vox = distanceTransform (energy.grid.dims, seen, energy.options.threads);
  const double reach_vox = energy.options.max_bound_vox - half_cells_vox;
  const SignedDistanceField field = solvedField (energy, solution);
  TriangleMesh mesh = openMesh (field, within, energy.options.threads);
  attachEvidence (energy, solution, mesh);
  std::vector<bool> near (mesh.vertices.size ());
  for (std::size_t v = 0; v < near.size (); ++v)
    if (const auto at = energy.grid.nearest (mesh.vertices[v].cast<double> ()))
    {
      const std::size_t n = energy.grid.index (at->x (), at->y (), at->z ());
      near[v] = field.supported[n] && distance_vox[n] <= reach_vox;
    }
  std::vector<bool> keep (mesh.triangles.size ());
  for (std::size_t t = 0; t < keep.size (); ++t)
    keep[t] = near[mesh.triangles[t][0]] && near[mesh.triangles[t][1]] && near[mesh.triangles[t][2]];
  return extractTriangles (mesh, keep);
}

} // namespace pcl::cosection
