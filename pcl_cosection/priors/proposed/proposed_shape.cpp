// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "proposed_shape.h"

#include "pcl_cosection/mesh/mesh_cleaning.h"
#include "pcl_cosection/priors/resting_planes.h"

#include <pcl/cosection/volume/mesh_distance.h>

#include <algorithm>
#include <cmath>

namespace pcl::cosection {
namespace {

constexpr double least_explained = 0.6; // true shapes in simulated views have 0.69 to 0.95 ...
constexpr double least_confirmed = 0.6; // ... and 0.70 to 0.97
constexpr double most_contradicted = 0.05;
constexpr double noise_vox = 0.5;        // voxels are as large as the points' noise and spacing ask for
constexpr float gap_vox = 2.0f;          // nothing is expected nearer to data
constexpr float far_vox = 6.0f;          // largest expected distance
constexpr float proposal_weight = 10.0f; // in multiples of beta_extent

/** \brief The larger, the better it fits. */
double
merit (const MeshAlignment& alignment)
{
  return alignment.explained + alignment.confirmed - 2.0 * alignment.contradicted;
}

TriangleMesh
moved (TriangleMesh mesh, const Eigen::Affine3d& T)
{
  for (Eigen::Vector3f& vertex : mesh.vertices)
    vertex = (T * vertex.cast<double> ()).cast<float> ();
  return mesh;
}

} // namespace

const ProposedShape*
proposedShape (const Observation& object, const ObjectSetting& setting, const std::vector<Eigen::Vector4d>& planes)
{
  if (!object.proposals || object.proposals->empty () || !object.proposed)
    return nullptr;
  ProposedShapes& shapes = *object.proposed;
  if (!shapes.aligned)
  {
    shapes.aligned = true;
    std::vector<Eigen::Vector4d> resting;
    if (const auto plane = nearestPlaneBelow (object, planes))
      resting.push_back (*plane);
    const AlignmentTarget target = {object.points (), object.views, setting.hidden, resting,
                                    noise_vox * object.voxel_size_m};
    for (std::size_t n = 0; n < object.proposals->size (); ++n)
    {
      const TriangleMesh mesh = cleanMesh ((*object.proposals)[n]);
      const auto alignment = mesh.empty () ? std::nullopt : alignMesh (mesh, target, setting.threads);
      if (!alignment || (shapes.best && merit (*alignment) <= merit (shapes.best->alignment)))
        continue;
      const bool is_used = alignment->explained >= least_explained && alignment->confirmed >= least_confirmed &&
                           alignment->contradicted <= most_contradicted;
      shapes.best = ProposedShape{n, *alignment, is_used, moved (mesh, alignment->T_object_mesh)};
    }
  }
  return shapes.best ? &*shapes.best : nullptr;
}

void
addProposedShape (const ProposedShape& shape, const BodyEnergy& energy, Proposal& proposal)
{
  const VoxelGrid& grid = energy.grid;
  const double reach_m = (far_vox + 2.0) * grid.voxel_size_m;
  const SignedDistanceField distance = sampleSignedDistance (shape.mesh, grid, reach_m, energy.options.threads);
  const float weight = proposal_weight * static_cast<float> (energy.options.beta_extent);
  for (std::size_t n = 0; n < grid.size (); ++n)
  {
    const bool is_known = distance.supported.empty () || distance.supported[n] != 0; // of an open mesh only near it
    const auto vox = static_cast<float> (distance.values[n] / grid.voxel_size_m);
    proposal.unbounded[n] = is_known && vox < 1.0f;
    proposal.surface[n] = is_known && std::abs (vox) < 1.0f;
    if (!is_known || energy.empty[n] || energy.data_distance_vox[n] < gap_vox)
      continue;
    proposal.weight[n] = weight;
    proposal.target[n] = std::clamp (vox, -far_vox, far_vox);
    proposal.least[n] = std::clamp (vox, 0.0f, far_vox);
  }
}

} // namespace pcl::cosection
