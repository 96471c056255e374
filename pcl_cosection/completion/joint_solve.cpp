// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "joint_solve.h"

#include "penetration.h"

#include <algorithm>
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
  {
    for (std::size_t o = 0; o < objects.size (); ++o)
      if (alive (o)) // in the first pass neighbours are their data alone
        joint_[o].shown = measuredField (energies[o]);
  }

  /** \brief Passes over all objects until none is deeper in another body than allowed. */
  void solve (Resolution resolution, int min_passes);

  std::vector<SolverSummary> summaries () const;

private:
  bool alive (std::size_t o) const { return !log_.failed (objects_[o].index); }

  std::vector<Eigen::Isometry3d> relativePoses (std::size_t of, std::size_t to) const
  {
    return cosection::relativePoses (*objects_[of].input, objects_[of].grid (), objects_[to].input);
  }

  std::vector<LowerBound> boundsOf (std::size_t o);
  void solvePass (Resolution resolution, int pass);
  void solveObject (std::size_t o, Resolution resolution, double begin, double share);
  /** \brief Update the shapes that bound neighbours after a pass. */
  void showSolutions ();
  bool growWeightsWherePenetrating (Resolution resolution);
  double coarsestSurroundings () const;

  const Scene& scene_;
  const std::vector<SceneObject>& objects_;
  const std::vector<SignedDistanceField::ConstPtr>& background_;
  const std::vector<Obstacle>& obstacles_;
  std::vector<BodyEnergy>& energies_;
  CompletionLog& log_;
  std::vector<JointObject> joint_;
};

/** \brief Equation (4) for one object: the largest depth over all bodies. */
std::vector<LowerBound>
JointProblem::boundsOf (std::size_t o)
{
  const CoSectionOptions& options = scene_.options;
  if (!options.use_intersection || options.beta_inter <= 0.0)
    return {};
  JointObject& object = joint_[o];
  if (!object.surroundings)
    object.surroundings = surroundingsConstraint (objects_[o], energies_[o], background_, obstacles_, options);
  IntersectionConstraint constraint = *object.surroundings;
  constraint.scaleWeights (object.beta_surroundings);
  for (std::size_t p = 0; p < objects_.size (); ++p)
  {
    if (p == o || !alive (p))
      continue;
    const auto grown = object.beta.find (p);
    const double beta = options.beta_inter * (grown == object.beta.end () ? 1.0 : grown->second);
    constraint.addBody (joint_[p].shown, relativePoses (o, p), beta);
  }
  return constraint.bounds ();
}

void
JointProblem::solveObject (std::size_t o, Resolution resolution, double begin, double share)
{
  log_.timed ("solve", [&] {
    JointObject& object = joint_[o];
    const int before = object.solver.iterations;
    object.changed = false;
    object.solver = cosection::solve (
        energies_[o], resolution, objects_[o].body->solution, [&] (const std::string&, double f) {
          log_.report ("object " + std::to_string (objects_[o].input->id), begin + share * f);
          return true;
        });
    object.solver.iterations += before;
  });
}

void
JointProblem::solvePass (Resolution resolution, int pass)
{
  std::vector<std::vector<LowerBound>> bounds (objects_.size ());
  log_.timed ("constraints", [&] {
    for (std::size_t o = 0; o < objects_.size (); ++o)
      if (alive (o))
        log_.guard (objects_[o].index, [&] { bounds[o] = boundsOf (o); });
  });
  const std::size_t all = scene_.objects.size ();
  const PassProgress& progress = resolution == Resolution::Half ? half_progress : full_progress;
  const double begin = pass == 0 ? progress.begin : progress.first;
  const double end = pass == 0 ? progress.first : progress.end;
  const double share = (end - begin) / static_cast<double> (all) /
                       (pass == 0 ? 1 : std::max (1, scene_.options.max_passes - 1));
  for (std::size_t o = 0; o < objects_.size (); ++o)
  {
    if (!alive (o))
      continue;
    log_.guard (objects_[o].index, [&] {
      std::vector<LowerBound>& intersection = energies_[o].problem.intersection;
      joint_[o].changed |= bounds[o] != intersection;
      intersection = std::move (bounds[o]);
      const BodySolution& solution = objects_[o].body->solution;
      if ((resolution == Resolution::Half && solution.has (Resolution::Full)) ||
          (!joint_[o].changed && solution.has (resolution)))
        return;
      const double done = static_cast<double> (std::max (0, pass - 1) * all + objects_[o].index);
      solveObject (o, resolution, begin + share * done, share);
    });
  }
  if (scene_.options.intersect_solved)
    showSolutions ();
}

void
JointProblem::showSolutions ()
{
  for (std::size_t o = 0; o < objects_.size (); ++o)
    if (alive (o))
      log_.guard (objects_[o].index, [&] {
        JointObject& object = joint_[o];
        const bool first = object.field.values.empty (); // shown are measurements so far
        object.field = solvedField (energies_[o], objects_[o].body->solution);
        // Bounds from the mean of the last two solutions converge where two bodies would give way and spread in turn.
        if (first)
          object.shown = object.field;
        else
          for (std::size_t n = 0; n < object.field.values.size (); ++n)
            object.shown.values[n] = 0.5f * (object.shown.values[n] + object.field.values[n]);
      });
}

double
JointProblem::coarsestSurroundings () const
{
  double coarsest = 0.0;
  for (const SignedDistanceField::ConstPtr& body : background_)
    coarsest = std::max (coarsest, body->grid.voxel_size_m);
  for (const Obstacle& obstacle : obstacles_)
    coarsest = std::max (coarsest, obstacle.field->grid.voxel_size_m);
  return coarsest;
}

bool
JointProblem::growWeightsWherePenetrating (Resolution resolution)
{
  const double allowed_voxels = penetration_voxels * (resolution == Resolution::Half ? 2.0 : 1.0);
  bool any = false;
  const auto grow = [&] (double& beta) {
    if (beta >= max_weight_growth)
      return;
    beta *= weight_growth;
    any = true;
  };
  const double coarsest = coarsestSurroundings ();
  for (std::size_t o = 0; o < objects_.size (); ++o)
  {
    if (!alive (o))
      continue;
    const double h = objects_[o].grid ().voxel_size_m;
    const double depth = penetrationOfSurroundings (scene_, objects_[o], joint_[o].field, background_, obstacles_);
    if (depth > allowed_voxels * std::clamp (coarsest, h, coarse_voxels * h))
      grow (joint_[o].beta_surroundings);
  }
  for (std::size_t o = 0; o < objects_.size (); ++o)
    for (std::size_t p = 0; p < objects_.size (); ++p)
    {
      if (p == o || !alive (o) || !alive (p))
        continue;
      const SignedDistanceField &field = joint_[o].field, &other = joint_[p].field;
      const double allowed = allowed_voxels * std::max (field.grid.voxel_size_m, other.grid.voxel_size_m);
      if (penetration (field, other, relativePoses (o, p), scene_.options.threads) > allowed)
        grow (joint_[o].beta.try_emplace (p, 1.0).first->second);
    }
  return any;
}

void
JointProblem::solve (Resolution resolution, int min_passes)
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

std::vector<SolverSummary>
JointProblem::summaries () const
{
  std::vector<SolverSummary> summaries;
  for (const JointObject& object : joint_)
    summaries.push_back (object.solver);
  return summaries;
}

} // namespace

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
