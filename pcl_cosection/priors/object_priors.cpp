// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "object_priors.h"

#include "continuation.h"
#include "extent_prior.h"
#include "extrusion.h"
#include "fitted_profiles.h"
#include "inferred_support_plane.h"
#include "only_side.h"
#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/priors/proposal.h"
#include "pcl_cosection/priors/proposed/proposed_shape.h"
#include "pcl_cosection/priors/symmetry/copies.h"
#include "pcl_cosection/priors/symmetry/object_symmetry.h"
#include "pcl_cosection/priors/vessels/vessel_term.h"
#include "pcl_cosection/volume/distance_transform.h"
#include "rays_without_return.h"
#include "resting_planes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr std::size_t most_points = 10000; // even subset of the points for inferring a plane
constexpr double along_axis = 0.9;         // cosine: a round object stands on a plane across its axis
constexpr double hidden_foot_vox = 6.0;    // height of the lowest points from which a foot is hidden
constexpr double wall_end_vox = 3.0;       // above the lowest points: their normals tell how a wall goes on ...
constexpr double steep = 0.7;              // ... if the component of the normal across is larger
constexpr double first_before_vox = 2.0;   // distance from which space before a surface is empty, as copies are; ...
constexpr double beside_vox = 4.0;         // ... up to this one, data is of the same surface
constexpr float expected_bound_weight = 10.0f; // of expected free space, in multiples of beta_extent

/** \brief Mark voxels on rays without return as empty, for an object that was cut out of its scene. */
void
addRaysWithoutReturn (const Observation& object, BodyEnergy& energy)
{
  const std::vector<std::uint8_t> open = findRaysWithoutReturn (energy.grid, object.views, object.points (),
                                                                energy.options.threads);
  energy.empty = energy.free_space;
  for (std::size_t n = 0; n < open.size (); ++n)
    energy.empty[n] |= open[n] && !energy.data[n];
}

/** \brief Mark voxels before observed surface as empty, for an object of which no view is known: whatever saw it looked
 * through what is before it. */
void
addSpaceBeforeSurface (const Observation& object, BodyEnergy& energy)
{
  const VoxelGrid& grid = energy.grid;
  energy.empty = energy.free_space;
  const double farthest_vox = grid.dims.cast<double> ().norm ();
  for (const OrientedPoint& point : object.points ())
    for (double away_vox = first_before_vox; away_vox < farthest_vox; ++away_vox)
    {
      const auto at = grid.nearest (point.position.cast<double> () +
                                    away_vox * grid.voxel_size_m * point.normal.cast<double> ().normalized ());
      if (!at)
        break;
      const std::size_t n = grid.index (at->x (), at->y (), at->z ());
      if (!energy.data[n])
        energy.empty[n] = 1;
      else if (away_vox > beside_vox)
        break;
    }
}

/** \brief Add the extent bound.
 * \param[in] expected_vox distance to data and to surface that is expected
 * \param[in] unbounded 1 where it does not apply, or empty */
void
addExtentPrior (const ExtentPrior& prior, const Observation& object, const std::vector<float>& expected_vox,
                const std::vector<std::uint8_t>& unbounded, BodyEnergy& energy)
{
  const VoxelGrid& grid = energy.grid;
  const CoSectionOptions& options = energy.options;
  std::vector<LowerBound>& exterior = energy.problem.exterior;
  exterior.resize (grid.size ());
  std::vector<std::uint8_t> bounded (grid.size ());
  for (std::size_t n = 0; n < grid.size (); ++n)
    bounded[n] = static_cast<bool> (exterior[n]) || (!unbounded.empty () && unbounded[n]);
  std::vector<float> bounds = prior.bounds (grid, expected_vox, object.extents_m, object.hidden, bounded,
                                            options.threads);
  if (energy.empty != energy.free_space)
  {
    // The bound on a ray without return is at most the distance to the nearest voxel that is not on such a ray.
    std::vector<std::uint8_t> closed (grid.size ());
    for (std::size_t n = 0; n < grid.size (); ++n)
      closed[n] = !energy.empty[n];
    const std::vector<float> depth_vox = distanceTransform (grid.dims, closed, options.threads);
    const auto side_vox = static_cast<float> (prior.side_factor * object.extents_m[1] / grid.voxel_size_m);
    for (std::size_t n = 0; n < grid.size (); ++n)
      if (!bounded[n] && energy.empty[n] && !energy.free_space[n])
        bounds[n] = std::max (bounds[n], std::min (energy.data_distance_vox[n] - side_vox, depth_vox[n]));
  }
  for (std::size_t n = 0; n < grid.size (); ++n)
    if (bounds[n] > 0.0f)
      exterior[n] = LowerBound (bounds[n], static_cast<float> (options.beta_extent));
}

/** \brief Add the targets and lower bounds of a proposal. */
void
addProposal (const Proposal& proposal, BodyEnergy& energy)
{
  std::vector<LowerBound>& exterior = energy.problem.exterior;
  exterior.resize (energy.grid.size ());
  energy.expected.resize (energy.grid.size ());
  const float weight = expected_bound_weight * static_cast<float> (energy.options.beta_extent);
  for (std::size_t n = 0; n < energy.grid.size (); ++n)
  {
    energy.expected[n] = proposal.claims (n);
    energy.problem.weight[n] += proposal.weight[n];
    energy.problem.weighted_target[n] += proposal.weight[n] * proposal.target[n];
    if (proposal.least[n] > exterior[n].distance ())
      exterior[n] = LowerBound (proposal.least[n], weight);
  }
}

/** \brief The distance to data and to surface that is expected, voxels. */
std::vector<float>
distanceToExpected (const Proposal& proposal, const BodyEnergy& energy)
{
  if (proposal.empty ())
    return energy.data_distance_vox;
  std::vector<std::uint8_t> expected = energy.data;
  for (std::size_t n = 0; n < expected.size (); ++n)
    expected[n] |= proposal.surface[n];
  return distanceTransform (energy.grid.dims, expected, energy.options.threads);
}

/** \brief Let a surface of revolution reach the plane, if something hides its foot on all sides: its walls go on. */
void
addFoot (const Observation& object, const Eigen::Vector4d& plane, const Motions& turns, const BodyEnergy& energy,
         Proposal& proposal)
{
  const double step_m = energy.grid.voxel_size_m;
  std::vector<OrientedPoint> points;
  std::vector<double> heights_m;
  for (const Eigen::Affine3d& turn : turns)
    for (const OrientedPoint& point : object.points ())
    {
      points.push_back (moved (point, turn));
      heights_m.push_back (heightOver (plane, points.back ().position.cast<double> ()));
    }
  if (heights_m.empty ())
    return;
  const double lowest_m = quantile (heights_m, lowest_share);
  if (lowest_m < hidden_foot_vox * step_m)
    return;
  const Eigen::Vector3d up = plane.head<3> ();
  std::vector<OrientedPoint> leaning = object.points ();
  for (std::size_t p = 0; p < points.size (); ++p)
  {
    leaning.push_back (points[p]);
    const Eigen::Vector3d normal = points[p].normal.cast<double> ();
    const Eigen::Vector3d down = normal.dot (up) * normal - up;
    if (heights_m[p] > lowest_m + wall_end_vox * step_m || down.norm () < steep)
      continue;
    for (double depth_m = step_m; depth_m < heights_m[p]; depth_m += step_m)
      leaning.push_back ({(points[p].position.cast<double> () + depth_m / down.squaredNorm () * down).cast<float> (),
                          points[p].normal});
  }
  points.insert (points.end (), object.points ().begin (), object.points ().end ());
  for (const auto* walls : {&leaning, &points}) // vertical ones if free space cuts those that lean
    if (const Extrusion extrusion (energy, *walls, plane); extrusion.hasWalls ())
    {
      extrusion.addTo (proposal, lowest_m - step_m);
      return;
    }
}

/** \brief Whether motions take most of some points to observed surface: then copies are there already. */
bool
explain (const Motions& motions, const std::vector<OrientedPoint>& points, const BodyEnergy& energy)
{
  const auto isCopied = [&] (const OrientedPoint& point) {
    return std::any_of (motions.begin (), motions.end (), [&] (const Eigen::Affine3d& motion) {
      const auto at = energy.grid.nearest (motion * point.position.cast<double> ());
      return at && energy.data[energy.grid.index (at->x (), at->y (), at->z ())];
    });
  };
  return 2 * std::count_if (points.begin (), points.end (), isCopied) > static_cast<std::ptrdiff_t> (points.size ());
}

/** \brief Add what columns below the points expect. \param[in] motions number of those that take the object to itself
 */
void
addColumns (const BodyEnergy& energy, const std::vector<OrientedPoint>& points, const Eigen::Vector4d& plane,
            std::size_t motions, Proposal& proposal)
{
  const Extrusion extrusion (energy, points, plane);
  if (motions <= 1) // several motions tell how far it reaches on all sides
    extrusion.emptyBesideTops (proposal);
  extrusion.addTo (proposal);
}

/** \brief The shape that the user proposed, if it explains the measurements; else null. */
const ProposedShape*
usedProposal (const Observation& object, const ObjectSetting& setting, const std::vector<Eigen::Vector4d>& planes)
{
  const ProposedShape* shape = setting.priors.proposals ? proposedShape (object, setting, planes) : nullptr;
  return shape && shape->fit.used ? shape : nullptr;
}

/** \brief What the network completes, if the measurements confirm it and the object is no vessel, whose walls are finer
 * than the network's voxels. Else null. */
const LearnedShape*
usedCompletion (const Observation& object, const ObjectSetting& setting, const std::vector<Eigen::Vector4d>& planes)
{
  const std::optional<Eigen::Vector4d> plane = nearestPlaneBelow (object, planes);
  if (!setting.priors.learned || !object.network || !plane || shapeOf (object, setting, plane).wallThickness () > 0.0)
    return nullptr;
  const LearnedShape* shape = learnedShape (object, setting, *plane);
  return shape && shape->fit.used ? shape : nullptr;
}

/** \brief What priors expect that know nothing of the network. */
struct Expected
{
  Proposal proposal;
  bool is_round = false;       ///< a surface of revolution
  bool shows_one_side = false; ///< a flat one, behind which its outline goes on
};

/** \brief What symmetry, revolution and extrusion expect.
 * \param[in] resting planes on which the object rests, of all \a planes
 * \param[in] round surfaces of revolution */
Expected
expectedOf (const Observation& object, const ObjectSetting& setting, const std::vector<Eigen::Vector4d>& resting,
            const std::vector<Eigen::Vector4d>& planes, const std::vector<ProfiledShape>& round,
            const BodyEnergy& energy)
{
  const Eigen::Vector4d plane = !resting.empty ()  ? resting.front ()
                                : !planes.empty () ? planes.front ()
                                                   : Eigen::Vector4d (Eigen::Vector4d::Zero ());
  const bool extrudes = setting.priors.extrusion && !resting.empty ();
  const MeasuredShape shape = measuredShape (energy);
  const std::optional<Eigen::Vector4d> behind = extrudes ? planeBehindOnlySide (object, plane, shape) : std::nullopt;
  const ObjectSymmetry symmetry = symmetryOf (object, setting.priors, plane, !resting.empty (), behind, round, shape,
                                              energy);
  Proposal proposal (energy.grid.size ());
  Continuation continued = extrudes ? continuedBehindOthers (object, plane) : Continuation ();
  continued.points.insert (continued.points.end (), setting.under_others.begin (), setting.under_others.end ());
  if (continued.points.empty () || symmetry.tellsExtentAlong (continued.direction) ||
      explain (symmetry.motions, continued.points, energy))
  {
    const Motions motions = symmetry.all ();
    if (!motions.empty () || (setting.priors.symmetry && object.views.empty ()))
      addCopies (energy, shape, motions, object, plane, proposal);
    if (extrudes && symmetry.is_fitted)
      addFoot (object, plane, motions, energy, proposal);
    else if (extrudes)
      addColumns (energy, object.points (), plane, motions.size (), proposal);
    if (behind)
      Extrusion (energy, object.points (), *behind).addTo (proposal);
    return {proposal, symmetry.is_round, behind.has_value ()};
  }
  Observation whole = object;
  whole.inliers = object.points ();
  whole.inliers.insert (whole.inliers.end (), continued.points.begin (), continued.points.end ());
  const BodyEnergy of_whole = withExpectedPoints (energy, continued.points);
  const MeasuredShape shape_of_whole = measuredShape (of_whole);
  Motions motions = symmetryOf (whole, setting.priors, plane, true, {}, {}, shape_of_whole, energy).all ();
  motions.push_back (Eigen::Affine3d::Identity ());
  addCopies (of_whole, shape_of_whole, motions, whole, plane, proposal);
  addColumns (energy, whole.points (), plane, motions.size (), proposal);
  return {proposal};
}

/** \brief The signed distance that minimises the energy, without neighbours. */
SignedDistanceField
solvedAlone (const BodyEnergy& energy)
{
  BodySolution solution;
  solve (energy, Resolution::Full, solution, nullptr);
  SignedDistanceField field = solvedField (energy, solution);
  field.supported.clear ();
  return field;
}

} // namespace

double
wallThickness (const Observation& object, const ObjectSetting& setting, const std::vector<Eigen::Vector4d>& planes)
{
  if (const ProposedShape* proposed = usedProposal (object, setting, planes))
    return wallOf (proposed->mesh, object.voxel_size_m);
  return shapeOf (object, setting, nearestPlaneBelow (object, planes)).wallThickness ();
}

std::optional<Eigen::Vector4d>
inferSupportPlane (const Observation& object, const ObjectSetting& setting)
{
  const std::optional<Eigen::Vector4d> no_plane;
  const ProfiledShape& shape = shapeOf (object, setting, no_plane);
  if (shape.wallThickness () > 0.0)
    return std::nullopt;
  const std::vector<OrientedPoint>& all = object.points ();
  std::vector<OrientedPoint> points;
  for (std::size_t p = 0; p < all.size (); p += all.size () / most_points + 1)
    if (all[p].position.allFinite () && all[p].normal.allFinite ())
      points.push_back (all[p]);
  if (shape.isFaceted ()) // flat faces end at edges, so their ends show no contact
    return std::nullopt;
  std::optional<Eigen::Vector4d> plane = contactBoundaryPlane (points, object.views);
  if (const std::optional<Eigen::Vector3d> axis = shape.axisDirection ();
      plane && axis && std::abs (axis->dot (plane->head<3> ())) < along_axis)
    plane.reset ();
  return plane;
}

Eigen::AlignedBox3d
boxDownToPlanes (const Observation& object, const ObjectSetting& setting, const std::vector<Eigen::Vector4d>& planes)
{
  Eigen::AlignedBox3d box = boxWithFeet (object, setting, planes);
  if (setting.priors.extrusion)
    for (const Eigen::Vector4d& plane : planes)
      for (const OrientedPoint& point : continuedBehindOthers (object, plane).points)
        box.extend (point.position.cast<double> ());
  const auto extend = [&] (const TriangleMesh& guessed) {
    for (const Eigen::Vector3f& vertex : guessed.vertices)
      box.extend (vertex.cast<double> ());
  };
  if (const ProposedShape* proposed = usedProposal (object, setting, planes))
    extend (proposed->mesh);
  else if (const LearnedShape* learned = usedCompletion (object, setting, planes))
    extend (learned->completion.mesh);
  return box;
}

void
addPriors (const Observation& object, const ObjectSetting& setting, const std::vector<Eigen::Vector4d>& planes,
           BodyEnergy& energy)
{
  const Priors& priors = setting.priors;
  const std::vector<Eigen::Vector4d> resting = restingPlanes (object, setting, planes, energy);
  std::vector<ProfiledShape> profiled;
  if (priors.revolution || priors.vessels)
    profiled = profiledShapes (object, setting, resting);
  const auto first_vessel = std::partition (
      profiled.begin (), profiled.end (), [] (const ProfiledShape& shape) { return !(shape.wallThickness () > 0.0); });
  const std::vector<ProfiledShape> vessels (first_vessel, profiled.end ());
  const bool is_cut_out = setting.background.empty ();
  if (priors.rays && is_cut_out && vessels.empty ()) // they have no thin walls
    addRaysWithoutReturn (object, energy);
  if (priors.rays && object.views.empty ())
    addSpaceBeforeSurface (object, energy);
  const auto addExpected = [&] (const Proposal& proposal) {
    if (priors.extent)
      addExtentPrior (is_cut_out ? ExtentPrior::cutOut () : ExtentPrior (), object,
                      distanceToExpected (proposal, energy), proposal.unbounded, energy);
    if (!proposal.empty ())
      addProposal (proposal, energy);
  };
  Expected expected;
  if (vessels.empty () && (priors.symmetry || priors.extrusion || !profiled.empty ()))
    expected = expectedOf (object, setting, resting, planes, profiled, energy);
  Proposal& proposal = expected.proposal;
  if (!(energy.options.beta_extent > 0.0))
    return;
  if (!vessels.empty ())
  {
    proposal = Proposal (energy.grid.size ());
    energy.facing = NormalBinOccupancy (energy.grid, object.points ());
    for (const ProfiledShape& vessel : vessels)
      addVessel (energy, vessel, object.points (), proposal);
  }
  const ProposedShape* proposed = usedProposal (object, setting, planes);
  // The others are more exact on surfaces of revolution, and on six of seven scanned things seen head on.
  if (expected.is_round || expected.shows_one_side)
    leaveOutLearned (object);
  const LearnedShape* learned = proposed || !vessels.empty () ? nullptr : usedCompletion (object, setting, planes);
  if (!proposed && !learned)
  {
    addExpected (proposal);
    return;
  }
  // What the other priors make of the object tells whether a proposal is better, and is what the network corrects.
  const EnergyProblem problem = energy.problem;
  const std::vector<std::uint8_t> claimed = energy.expected;
  addExpected (proposal);
  const SignedDistanceField without = solvedAlone (energy);
  if (proposed && !keepIfAsGood (without, object, setting, planes))
    return;
  energy.problem = problem;
  energy.expected = claimed;
  proposal = Proposal (energy.grid.size ());
  if (proposed)
  {
    energy.facing = NormalBinOccupancy (energy.grid, object.points ());
    addProposedShape (proposed->mesh, energy, proposal);
  }
  else
    addExpectedDistance (correctedDistance (learned->completion, without, energy.options.threads), energy, proposal);
  addExpected (proposal);
}

} // namespace pcl::cosection
