// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "proposed_shape.h"

#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/energy/least_wall.h"
#include "pcl_cosection/mesh/mesh_cleaning.h"
#include "pcl_cosection/mesh/moved_mesh.h"
#include "pcl_cosection/priors/resting_planes.h"
#include "pcl_cosection/volume/mesh_distance/mesh_surface.h"

#include <pcl/cosection/volume/iso_surface.h>
#include <pcl/cosection/volume/mesh_distance.h>

#include <algorithm>
#include <cmath>

namespace pcl::cosection {
namespace {

constexpr double least_explained = 0.6; // true shapes in simulated views have 0.69 to 0.95 ...
constexpr double least_confirmed = 0.6; // ... and 0.70 to 0.97
constexpr double most_contradicted = 0.05;
constexpr double
    least_confirmed_learned = 0.5; // in real views 0.54 to 0.81; 0.42 and 0.25 at drills, which it does not know
constexpr double most_contradicted_learned = 0.06;
constexpr double as_well = 0.85;       // of the share that is explained without a proposal; of true shapes 0.84 to 1.25
constexpr double noise_vox = 0.5;      // voxels are as large as the points' noise and spacing ask for
constexpr float gap_vox = 2.0f;        // nothing is expected nearer to data
constexpr float near_vox = 3.0f;       // of the surface: what is a wall's is asked there
constexpr float far_vox = 6.0f;        // largest expected distance
constexpr double thick_wall_vox = 4.0; // of which voxels need not be smaller
constexpr float wall_weight = 100.0f;  // of a wall, which vanishes with less
constexpr double most_open = 0.01;     // edges per triangle at which a mesh ends: holes that change its volume little
constexpr float proposal_weight = 10.0f; // in multiples of beta_extent

/** \brief The larger, the better it fits. */
double
merit (const ProposalFit& fit)
{
  return fit.explained + fit.confirmed - 2.0 * fit.contradicted;
}

/** \brief The plane on which an object stands, or none. */
std::vector<Eigen::Vector4d>
restingOn (const Observation& object, const std::vector<Eigen::Vector4d>& planes)
{
  const auto plane = nearestPlaneBelow (object, planes);
  return plane ? std::vector<Eigen::Vector4d>{*plane} : std::vector<Eigen::Vector4d>{};
}

/** \brief What a shape is compared with. \param[in] resting planes on which it rests; must outlive the result */
MeasuredObject
measuredObject (const Observation& object, const std::vector<Eigen::Vector4d>& resting)
{
  return {object.points (), object.views, object.hidden, resting, noise_vox * object.voxel_size_m};
}

/** \brief Expect a distance at a voxel that is not near data.
 * \param[in] lacking_vox by how much a wall there is too thin
 * \param[in] factor of the weight
 * \return whether nothing else is to be said of the voxel: it is seen free, or not near data, or the distance is
 * unknown */
bool
expectDistance (const SignedDistanceField& distance, float lacking_vox, float factor, std::size_t n,
                const BodyEnergy& energy, Proposal& proposal)
{
  if (!distance.supported.empty () && distance.supported[n] == 0) // of an open mesh only near it
    return true;
  const auto vox = static_cast<float> (distance.values[n] / energy.grid.voxel_size_m);
  proposal.unbounded[n] = vox < 1.0f;
  proposal.surface[n] = std::abs (vox) < 1.0f;
  if (energy.empty[n])
    return true;
  if (energy.data_distance_vox[n] < gap_vox)
    return false;
  proposal.weight[n] = factor * static_cast<float> (energy.options.beta_extent);
  proposal.target[n] = std::clamp (vox - 0.5f * lacking_vox, -far_vox, far_vox); // as much on either side
  proposal.least[n] = std::max (0.0f, proposal.target[n]);
  return true;
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
    const std::vector<Eigen::Vector4d> resting = restingOn (object, planes);
    const MeasuredObject measured = measuredObject (object, resting);
    for (std::size_t n = 0; n < object.proposals->size (); ++n)
    {
      const TriangleMesh mesh = cleanMesh ((*object.proposals)[n]);
      auto fit = mesh.empty () ? std::nullopt : alignMesh (mesh, measured, setting.threads);
      if (!fit || (shapes.best && merit (*fit) <= merit (shapes.best->fit)))
        continue;
      fit->proposal = n;
      fit->used = fit->explained >= least_explained && fit->confirmed >= least_confirmed &&
                  fit->contradicted <= most_contradicted;
      shapes.best = ProposedShape{*fit, movedMesh (mesh, fit->T_object_proposal)};
    }
  }
  return shapes.best ? &*shapes.best : nullptr;
}

bool
keepIfAsGood (const SignedDistanceField& without, const Observation& object, const ObjectSetting& setting,
              const std::vector<Eigen::Vector4d>& planes)
{
  ProposalFit& fit = object.proposed->best.value ().fit;
  const TriangleMesh other = extractIsoSurface (without, {true, setting.threads});
  const std::vector<Eigen::Vector4d> resting = restingOn (object, planes);
  fit.used = fit.explained >= as_well * fitInPlace (other, measuredObject (object, resting)).explained;
  fit.withdrawn = !fit.used;
  return fit.used;
}

const LearnedShape*
learnedShape (const Observation& object, const ObjectSetting& setting, const Eigen::Vector4d& plane)
{
  if (!object.network || !object.proposed || object.virtual_view)
    return nullptr;
  ProposedShapes& shapes = *object.proposed;
  if (!shapes.completed)
  {
    shapes.completed = true;
    const bool is_cut_out = setting.priors.rays && setting.background.empty ();
    LearnedCompletion completion = completedByNetwork (*object.network, object.points (), object.views, plane,
                                                       is_cut_out);
    if (completion.mesh.empty ())
      return nullptr;
    const std::vector<Eigen::Vector4d> resting = {plane};
    ProposalFit fit = fitInPlace (completion.mesh, measuredObject (object, resting));
    fit.used = fit.confirmed >= least_confirmed_learned && fit.contradicted <= most_contradicted_learned;
    shapes.learned = LearnedShape{std::move (completion), fit};
  }
  return shapes.learned ? &*shapes.learned : nullptr;
}

void
leaveOutLearned (const Observation& object)
{
  if (object.proposed)
    object.proposed->learned.reset ();
}

double
wallOf (const TriangleMesh& shape, double voxel_size_m)
{
  const MeshTopology topology = computeTopology (shape);
  if (topology.boundary_edges > most_open * static_cast<double> (shape.triangles.size ()))
    return 0.0;
  const double mean_m = 2.0 * std::abs (computeMassProperties (shape).volume_m3) / surfaceArea (shape);
  return mean_m < thick_wall_vox * voxel_size_m ? mean_m : 0.0;
}

void
addExpectedDistance (const SignedDistanceField& distance, const BodyEnergy& energy, Proposal& proposal)
{
  for (std::size_t n = 0; n < energy.grid.size (); ++n)
    expectDistance (distance, 0.0f, proposal_weight, n, energy, proposal);
}

void
addProposedShape (const TriangleMesh& shape, BodyEnergy& energy, Proposal& proposal)
{
  const VoxelGrid& grid = energy.grid;
  const double reach_m = (far_vox + 2.0) * grid.voxel_size_m;
  const SignedDistanceField distance = sampleSignedDistance (shape, grid, reach_m, energy.options.threads);
  const SurfaceDistance surface (shape);
  // What a wall lacks to be so thick that it does not vanish between voxels.
  const auto lackingAt = [&] (const SurfaceDistance::Nearest& nearest) {
    const Eigen::Vector3d within = nearest.point - least_wall_vox * grid.voxel_size_m * nearest.normal;
    const SurfaceDistance::Nearest other = surface.nearest (within);
    const double beyond_m = (within - other.point).dot (other.normal); // the other side
    return static_cast<float> (std::clamp (beyond_m / grid.voxel_size_m, 0.0, least_wall_vox));
  };
  const auto beta = static_cast<float> (energy.options.beta_extent);
  const bool is_wall = wallOf (shape, grid.voxel_size_m) > 0.0;
  parallelFor (0, grid.dims.z (), threadsForVoxels (energy.options.threads, grid.size ()), [&] (int k) {
    for (int j = 0; j < grid.dims.y (); ++j)
      for (int i = 0; i < grid.dims.x (); ++i)
      {
        const std::size_t n = grid.index (i, j, k);
        const auto vox = static_cast<float> (distance.values[n] / grid.voxel_size_m);
        const bool is_near = std::abs (vox) < near_vox && !energy.empty[n];
        const SurfaceDistance::Nearest nearest = is_near ? surface.nearest (grid.center (i, j, k))
                                                         : SurfaceDistance::Nearest ();
        const float lacking = is_near ? lackingAt (nearest) : 0.0f;
        const float factor = is_wall && is_near ? wall_weight : proposal_weight;
        if (expectDistance (distance, lacking, factor, n, energy, proposal))
          continue;
        // Behind a measured surface its distance grows on, although the other side of a wall may be near.
        const float weight = energy.problem.weight[n], weighted_target = energy.problem.weighted_target[n];
        if (!is_near || weighted_target > 0.0f ||
            energy.facing.face (nearest.point.cast<float> (), nearest.normal.cast<float> ()))
          continue;
        const float measured = weight > 0.0f ? weighted_target / weight : -far_vox;
        const float thin = std::max (lacking, static_cast<float> (least_wall_vox) + measured + vox);
        energy.problem.weight[n] = energy.problem.weighted_target[n] = 0.0f;
        proposal.weight[n] = std::max (weight, wall_weight * beta);
        proposal.target[n] = vox - thin;
      }
  });
}

} // namespace pcl::cosection
