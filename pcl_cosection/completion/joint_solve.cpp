// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "joint_solve.h"

#include "neighbours.h"
#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/energy/constraints/intersection_constraint.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>
#include <string>

namespace pcl::cosection {
namespace {

constexpr double penetration_voxels = 0.5; // deeper penetration makes weights grow
constexpr double coarse_voxels = 2.0;      // upper limit of the allowed depth in coarse surroundings, object voxels
constexpr double weight_growth = 4.0;
constexpr double max_weight_growth = 1024.0;

/** \brief Progress values when the passes of one resolution begin, after the first of them, and after all. */
struct PassProgress
{
  double begin;
  double first;
  double end;
};

constexpr PassProgress half_progress{0.3, 0.45, 0.5};
constexpr PassProgress full_progress{0.5, 0.8, 0.95};

/** \brief 1 for each row of voxels with values below zero, 2 for one with others, 3 for one with both. */
std::vector<std::uint8_t>
signsOfRows (const SignedDistanceField& field, int threads)
{
  const auto length = static_cast<std::size_t> (field.grid.dims.x ());
  std::vector<std::uint8_t> signs (static_cast<std::size_t> (field.grid.dims.y ()) * field.grid.dims.z ());
  parallelFor (0, static_cast<int> (signs.size ()), threads, [&] (int r) {
    const float* row = field.values.data () + r * length;
    int below = 0;
    for (std::size_t i = 0; i < length; ++i)
      below += row[i] < 0.0f;
    signs[r] = static_cast<std::uint8_t> ((below > 0 ? 1 : 0) | (below < static_cast<int> (length) ? 2 : 0));
  });
  return signs;
}

/** \brief Largest depthAt (place) over the places where a field's zero set crosses edges of its grid; 0 if all are
 * outside. */
template <typename DepthAt>
double
deepest (const SignedDistanceField& field, int threads, DepthAt&& depthAt)
{
  const VoxelGrid& grid = field.grid;
  const std::vector<std::uint8_t> signs = signsOfRows (field, threads);
  std::vector<double> deepest (grid.dims.z (), 0.0);
  parallelFor (0, grid.dims.z (), threads, [&] (int k) {
    const auto edge = [&] (int i, int j, int axis, float here, float there) {
      if ((here < 0.0f) == (there < 0.0f))
        return;
      Eigen::Vector3d at = grid.center (i, j, k);
      at[axis] += grid.voxel_size_m * here / (here - there);
      deepest[k] = std::max (deepest[k], depthAt (at));
    };
    const bool has_above = k + 1 < grid.dims.z ();
    for (int j = 0; j < grid.dims.y (); ++j)
    {
      const std::size_t r = static_cast<std::size_t> (k) * grid.dims.y () + j;
      const int around = signs[r] | (j + 1 < grid.dims.y () ? signs[r + 1] : 0) |
                         (has_above ? signs[r + grid.dims.y ()] : 0);
      if (around != 3)
        continue;
      const float* row = field.values.data () + grid.index (0, j, k);
      const float* next_row = j + 1 < grid.dims.y () ? field.values.data () + grid.index (0, j + 1, k)
                                                     : row; // itself: no crossing
      const float* row_above = has_above ? field.values.data () + grid.index (0, j, k + 1) : row;
      for (int i = 0; i < grid.dims.x (); ++i)
      {
        if (i + 1 < grid.dims.x ())
          edge (i, j, 0, row[i], row[i + 1]);
        edge (i, j, 1, row[i], next_row[i]);
        edge (i, j, 2, row[i], row_above[i]);
      }
    }
  });
  return *std::max_element (deepest.begin (), deepest.end ());
}

double
penetrationOfGivenPlanes (const Scene& scene, const SceneObject& object, const SignedDistanceField& surface)
{
  const std::vector<Eigen::Vector4d> planes = planesAtPoses (*object.input, object.observation->box.center (),
                                                             givenPlanes (scene, *object.input, *object.observation),
                                                             object.T_world_object);
  if (planes.empty ())
    return 0.0;
  return deepest (surface, scene.options.threads, [&] (const Eigen::Vector3d& at) {
    double depth = 0.0;
    for (const Eigen::Vector4d& plane : planes)
      depth = std::max (depth, -plane.head<3> ().dot (at) - plane[3]);
    return depth;
  });
}

/** \brief One object between the passes. */
struct JointObject
{
  SignedDistanceField field; // its shape after the last pass
  SignedDistanceField shown; // the shape that bounds its neighbours
  std::optional<IntersectionConstraint> surroundings;
  std::map<std::size_t, double> beta; // factor of the weight, by neighbour
  double beta_surroundings = 1.0;     // factor of the weight of the surroundings
  bool changed = true;                // whether the energy has changed since the last solve
  SolverSummary solver;
};

/** \brief The objects and everything around them. */
class JointProblem
{
public:
  JointProblem (const Scene& scene, const std::vector<SceneObject>& objects,
                const std::vector<SignedDistanceField::ConstPtr>& background, const std::vector<Obstacle>& obstacles,
                std::vector<BodyEnergy>& energies, CompletionLog& log)
      : scene_ (scene)
      , objects_ (objects)
      , background_ (background)
      , obstacles_ (obstacles)
      , energies_ (energies)
      , log_ (log)
      , joint_ (objects.size ())
      , neighbours_ (neighboursOf (objects))
      , alive_ (aliveObjects (objects, log))
  {
    for (std::size_t o = 0; o < objects.size (); ++o)
      if (alive_[o]) // in the first pass neighbours are their data alone
        joint_[o].shown = measuredField (energies[o]);
  }

  /** \brief Passes over all objects until none is deeper in another body than allowed. */
  void solve (Resolution resolution, int min_passes)
  {
    const bool repeat = scene_.options.use_intersection && scene_.options.intersect_solved;
    const int passes = repeat ? scene_.options.max_passes : 1;
    for (int pass = 0; pass < passes; ++pass)
    {
      solvePass (resolution, pass);
      if (pass + 1 < min_passes || pass + 1 == passes)
        continue;
      if (!log_.timed ("constraints", [&] { return growWeightsWherePenetrating (resolution); }))
        break;
    }
  }

  std::vector<SolverSummary> summaries () const
  {
    std::vector<SolverSummary> summaries;
    for (const JointObject& object : joint_)
      summaries.push_back (object.solver);
    return summaries;
  }

private:
  std::vector<Eigen::Isometry3d> relativePoses (std::size_t of, std::size_t to) const
  {
    return cosection::relativePoses (*objects_[of].input, objects_[of].grid (), objects_[to].input);
  }

  /** \brief Equation (5) for everything that is not an object: planes, the background, obstacles. */
  IntersectionConstraint surroundingsOf (std::size_t o) const
  {
    const SceneObject& object = objects_[o];
    const CoSectionOptions& options = scene_.options;
    const double beta = options.beta_inter;
    IntersectionConstraint constraint (object.grid (), options.max_bound_vox, options.threads);
    for (const Eigen::Vector4d& plane : object.planes ())
      constraint.addHalfSpace (plane, energies_[o].free_space, beta);
    for (const SignedDistanceField::ConstPtr& body : background_)
      constraint.addBody (*body, object.T_world_object, beta);
    for (const Obstacle& obstacle : obstacles_)
    {
      std::vector<Eigen::Isometry3d> T_field_object;
      for (const Eigen::Isometry3d& T_field_world : obstacle.T_field_world)
        for (const Eigen::Isometry3d& T_world_object : object.T_world_object)
          T_field_object.push_back (T_field_world * T_world_object);
      constraint.addBody (*obstacle.field, T_field_object, beta);
    }
    return constraint;
  }

  /** \brief Equation (4) for one object: the largest depth over all bodies. */
  std::vector<LowerBound> boundsOf (std::size_t o)
  {
    const CoSectionOptions& options = scene_.options;
    if (!options.use_intersection || options.beta_inter <= 0.0)
      return {};
    JointObject& object = joint_[o];
    if (!object.surroundings)
      object.surroundings = surroundingsOf (o);
    IntersectionConstraint constraint = *object.surroundings;
    constraint.scaleWeights (object.beta_surroundings);
    for (const std::size_t p : neighbours_[o])
    {
      if (!alive_[p])
        continue;
      const auto grown = object.beta.find (p);
      const double beta = options.beta_inter * (grown == object.beta.end () ? 1.0 : grown->second);
      constraint.addBody (joint_[p].shown, relativePoses (o, p), beta);
    }
    return constraint.bounds ();
  }

  void solvePass (Resolution resolution, int pass)
  {
    std::vector<std::vector<LowerBound>> bounds (objects_.size ());
    const int threads = scene_.options.threads;
    const auto forEach = [&] (const auto& f) {
      alive_ = aliveObjects (objects_, log_);
      forEachObjectAtOnce (objects_, threads, log_, f);
    };
    log_.timed ("constraints", [&] { forEach ([&] (std::size_t o) { bounds[o] = boundsOf (o); }); });
    const std::size_t all = scene_.objects.size ();
    const PassProgress& progress = resolution == Resolution::Half ? half_progress : full_progress;
    const double begin = pass == 0 ? progress.begin : progress.first;
    const double end = pass == 0 ? progress.first : progress.end;
    const double share = (end - begin) / static_cast<double> (all) /
                         (pass == 0 ? 1 : std::max (1, scene_.options.max_passes - 1));
    const auto doneBefore = [&] (std::size_t objects) {
      return begin + share * static_cast<double> (std::max (0, pass - 1) * all + objects);
    };
    const auto solveOne = [&] (std::size_t o, bool is_alone) {
      std::vector<LowerBound>& intersection = energies_[o].problem.intersection;
      joint_[o].changed |= bounds[o] != intersection;
      intersection = std::move (bounds[o]);
      const BodySolution& solution = objects_[o].body->solution;
      if ((resolution == Resolution::Half && solution.has (Resolution::Full)) ||
          (!joint_[o].changed && solution.has (resolution)))
        return;
      solveObject (o, resolution, [&, o, is_alone] (const std::string&, double f) {
        if (is_alone)
          log_.report (nameOf (o), doneBefore (objects_[o].index) + share * f);
        return true;
      });
    };
    log_.timed ("solve", [&] {
      forEachObjectAtOnce (objects_, threads, log_, solveOne, [&] (std::size_t end) {
        log_.report (nameOf (end - 1), doneBefore (objects_[end - 1].index + 1));
      });
    });
    if (scene_.options.intersect_solved)
      forEach ([&] (std::size_t o) { showSolution (o); });
  }

  std::string nameOf (std::size_t o) const { return "object " + std::to_string (objects_[o].input->id); }

  void solveObject (std::size_t o, Resolution resolution, const ProgressCallback& progress)
  {
    JointObject& object = joint_[o];
    const int before = object.solver.iterations;
    object.changed = false;
    object.solver = cosection::solve (energies_[o], resolution, objects_[o].body->solution, progress);
    object.solver.iterations += before;
  }

  /** \brief Update the shape that bounds an object's neighbours after a pass. */
  void showSolution (std::size_t o)
  {
    JointObject& object = joint_[o];
    const bool first = object.field.values.empty (); // shown are measurements so far
    object.field = solvedField (energies_[o], objects_[o].body->solution);
    // Bounds from the mean of the last two solutions converge where two bodies would give way and spread in turn.
    if (first)
      object.shown = object.field;
    else
      for (std::size_t n = 0; n < object.field.values.size (); ++n)
        object.shown.values[n] = 0.5f * (object.shown.values[n] + object.field.values[n]);
  }

  bool growWeightsWherePenetrating (Resolution resolution)
  {
    const double allowed_voxels = penetration_voxels * (resolution == Resolution::Half ? 2.0 : 1.0);
    bool any = false;
    const auto grow = [&] (double& beta) {
      if (beta >= max_weight_growth)
        return;
      beta *= weight_growth;
      any = true;
    };
    double coarsest = 0.0; // voxels of the surroundings
    for (const SignedDistanceField::ConstPtr& body : background_)
      coarsest = std::max (coarsest, body->grid.voxel_size_m);
    for (const Obstacle& obstacle : obstacles_)
      coarsest = std::max (coarsest, obstacle.field->grid.voxel_size_m);
    alive_ = aliveObjects (objects_, log_);
    for (std::size_t o = 0; o < objects_.size (); ++o)
    {
      if (!alive_[o])
        continue;
      const double h = objects_[o].grid ().voxel_size_m;
      const double depth = penetrationOfSurroundings (scene_, objects_[o], joint_[o].field, background_, obstacles_);
      if (depth > allowed_voxels * std::clamp (coarsest, h, coarse_voxels * h))
        grow (joint_[o].beta_surroundings);
      for (const std::size_t p : neighbours_[o])
      {
        if (!alive_[p])
          continue;
        const SignedDistanceField &field = joint_[o].field, &other = joint_[p].field;
        const double allowed = allowed_voxels * std::max (field.grid.voxel_size_m, other.grid.voxel_size_m);
        if (penetration (field, other, relativePoses (o, p), scene_.options.threads) > allowed)
          grow (joint_[o].beta.try_emplace (p, 1.0).first->second);
      }
    }
    return any;
  }

  const Scene& scene_;
  const std::vector<SceneObject>& objects_;
  const std::vector<SignedDistanceField::ConstPtr>& background_;
  const std::vector<Obstacle>& obstacles_;
  std::vector<BodyEnergy>& energies_;
  CompletionLog& log_;
  std::vector<JointObject> joint_;
  std::vector<std::vector<std::size_t>> neighbours_;
  std::vector<std::uint8_t> alive_; // before the calls for all objects that are being made
};

} // namespace

double
penetration (const SignedDistanceField& surface, const SignedDistanceField& body,
             const std::vector<Eigen::Isometry3d>& T_body_object, int threads)
{
  std::vector<Eigen::Isometry3d> near;
  std::copy_if (T_body_object.begin (), T_body_object.end (), std::back_inserter (near),
                [&] (const Eigen::Isometry3d& T) { return !coveredVoxels (surface.grid, T, body.grid).isEmpty (); });
  if (near.empty ())
    return 0.0;
  return deepest (surface, threads, [&] (const Eigen::Vector3d& at) {
    double depth = 0.0;
    for (const Eigen::Isometry3d& T : near)
      if (const auto u = body.sampleInside (body.grid.toVoxel (T * at)))
        depth = std::max (depth, static_cast<double> (-*u));
    return depth;
  });
}

double
penetrationOfSurroundings (const Scene& scene, const SceneObject& object, const SignedDistanceField& surface,
                           const std::vector<SignedDistanceField::ConstPtr>& background,
                           const std::vector<Obstacle>& obstacles)
{
  const int threads = scene.options.threads;
  double deepest = penetrationOfGivenPlanes (scene, object, surface);
  for (const SignedDistanceField::ConstPtr& body : background)
    deepest = std::max (deepest, penetration (surface, *body, object.T_world_object, threads));
  for (const Obstacle& obstacle : obstacles)
    for (const Eigen::Isometry3d& T_field_world : obstacle.T_field_world)
      for (const Eigen::Isometry3d& T_world_object : object.T_world_object)
        deepest = std::max (deepest, penetration (surface, *obstacle.field, {T_field_world * T_world_object}, threads));
  return deepest;
}

std::vector<SolverSummary>
solveJointly (const Scene& scene, const std::vector<SceneObject>& objects,
              const std::vector<SignedDistanceField::ConstPtr>& background, const std::vector<Obstacle>& obstacles,
              std::vector<BodyEnergy>& energies, CompletionLog& log)
{
  JointProblem problem (scene, objects, background, obstacles, energies, log);
  // The very first pass bounds objects by the data of their neighbours alone, so a second pass must follow.
  const int needed = scene.objects.size () > 1 ? 2 : 1;
  const bool half_first = scene.options.solver.type == SolverType::Multigrid;
  if (half_first)
    problem.solve (Resolution::Half, needed);
  problem.solve (Resolution::Full, half_first ? 1 : needed);
  return problem.summaries ();
}

} // namespace pcl::cosection
