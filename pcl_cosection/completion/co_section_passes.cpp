// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "co_section_run.h"

#include "pcl_cosection/common/parallel.h"

#include <algorithm>
#include <cmath>
#include <string>

// The part of a run in which the objects constrain each other.

namespace pcl::cosection
{

namespace
{

constexpr double penetration_voxels = 0.5; // more is resolved by growing weights
constexpr double coarse_voxels = 2.0; // no more is allowed however coarse the surroundings are, voxels of the object
constexpr double weight_growth = 4.0;
constexpr double max_weight_growth = 1024.0;

/** \brief Progress when the passes of one resolution begin, when the first of them is done, and when all are. */
struct PassProgress
{
  double begin;
  double first;
  double end;
};

constexpr PassProgress half_progress{0.3, 0.45, 0.5};
constexpr PassProgress full_progress{0.5, 0.8, 0.95};

} // namespace

IntersectionConstraint
CoSectionRun::surroundings (const Object& object) const
{
  const double beta = scene_.options.beta_inter;
  IntersectionConstraint constraint (object.volume ().grid (), scene_.options.max_bound_vox, scene_.options.threads);
  const std::vector<Eigen::Isometry3d> poses = relativePoses (object, nullptr);
  for (const Eigen::Vector4d& plane : planesAt (object, object.planes, poses))
    constraint.addHalfSpace (plane, object.volume ().freeSpace (), beta);
  for (const SignedDistanceField::ConstPtr& body : background_)
    constraint.addBody (*body, poses, beta);
  for (const Obstacle& body : bodies_)
  {
    std::vector<Eigen::Isometry3d> T_field_object;
    for (const Eigen::Isometry3d& T_field_world : body.T_field_world)
      for (const Eigen::Isometry3d& T_world_object : poses)
        T_field_object.push_back (T_field_world * T_world_object);
    constraint.addBody (*body.field, T_field_object, beta);
  }
  return constraint;
}

std::vector<LowerBound>
CoSectionRun::bounds (Object& object) const
{
  const CoSectionOptions& options = scene_.options;
  if (!options.use_intersection || options.beta_inter <= 0.0)
    return {};
  if (!object.surroundings)
    object.surroundings = std::make_unique<IntersectionConstraint> (surroundings (object));
  IntersectionConstraint constraint = *object.surroundings;
  constraint.scaleWeights (object.beta_surroundings);
  for (std::size_t p = 0; p < objects_.size (); ++p)
  {
    const Object& other = objects_[p];
    if (&other == &object || !other.alive ())
      continue;
    const auto grown = object.beta.find (p);
    const double beta = options.beta_inter * (grown == object.beta.end () ? 1.0 : grown->second);
    constraint.addBody (other.told, relativePoses (object, &other), beta);
  }
  return constraint.bounds ();
}

void
CoSectionRun::solve (Object& object, Resolution resolution, double begin, double share)
{
  timed ("solve", [&] {
    const int before = object.result->solver.iterations;
    object.result->solver = object.volume ().solve (resolution, [&] (const std::string&, double f) {
      report ("object " + std::to_string (object.input->id), begin + share * f);
      return true;
    });
    object.result->solver.iterations += before;
  });
}

void
CoSectionRun::solvePass (Resolution resolution, int pass)
{
  // Simultaneous: all bounds are taken from the fields of the pass before.
  std::vector<std::vector<LowerBound>> all (objects_.size ());
  timed ("constraints", [&] {
    for (std::size_t o = 0; o < objects_.size (); ++o)
      if (objects_[o].alive ())
        guarded (objects_[o], [&] { all[o] = bounds (objects_[o]); });
  });
  const PassProgress& progress = resolution == Resolution::Half ? half_progress : full_progress;
  const double begin = pass == 0 ? progress.begin : progress.first;
  const double end = pass == 0 ? progress.first : progress.end;
  const double share = (end - begin) / static_cast<double> (objects_.size ()) /
                       (pass == 0 ? 1 : std::max (1, scene_.options.max_passes - 1));
  for (std::size_t o = 0; o < objects_.size (); ++o)
  {
    Object& object = objects_[o];
    if (!object.alive ())
      continue;
    guarded (object, [&] {
      ShapeVolume& volume = object.volume ();
      volume.setIntersection (std::move (all[o]));
      if ((resolution == Resolution::Half && volume.solved (Resolution::Full)) ||
          (!volume.changed () && volume.solved (resolution)))
        return;
      const double done = static_cast<double> (std::max (0, pass - 1) * objects_.size () + o);
      solve (object, resolution, begin + share * done, share);
    });
  }
  if (!scene_.options.intersect_solved)
    return;
  for (Object& object : objects_)
  {
    if (!object.alive ())
      continue;
    guarded (object, [&] {
      const bool first = object.field.values.empty (); // what was told until now are measurements
      object.field = object.volume ().solvedField ();
      // Two bodies that give way and spread by turns settle when each answers the mean of the other's last two.
      if (first)
        object.told = object.field;
      else
        for (std::size_t n = 0; n < object.field.values.size (); ++n)
          object.told.values[n] = 0.5f * (object.told.values[n] + object.field.values[n]);
    });
  }
}

template <typename DepthAt>
double
CoSectionRun::deepest (const Object& object, DepthAt&& depthAt) const
{
  const SignedDistanceField& own = object.field;
  const VoxelGrid& grid = own.grid;
  std::vector<double> deepest (grid.dims.z (), 0.0);
  parallelFor (0, grid.dims.z (), scene_.options.threads, [&] (int k) {
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
      const float* row = own.values.data () + grid.index (0, j, k);
      const float* next_row = j + 1 < grid.dims.y () ? own.values.data () + grid.index (0, j + 1, k)
                                                     : row; // itself: no crossing
      const float* row_above = has_above ? own.values.data () + grid.index (0, j, k + 1) : row;
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
CoSectionRun::penetration (const Object& object, const SignedDistanceField& body,
                           const std::vector<Eigen::Isometry3d>& poses) const
{
  return deepest (object, [&] (const Eigen::Vector3d& at) {
    double depth = 0.0;
    for (const Eigen::Isometry3d& T : poses)
      if (const auto u = body.sampleInside (body.grid.toVoxel (T * at)))
        depth = std::max (depth, static_cast<double> (-*u));
    return depth;
  });
}

double
CoSectionRun::penetrationOfGivenPlanes (const Object& object) const
{
  std::vector<Eigen::Vector4d> given;
  for (const Eigen::Vector4d& plane : scene_.planes)
    given.push_back (towards (object, plane));
  const std::vector<Eigen::Vector4d> planes = planesAt (object, given, relativePoses (object, nullptr));
  if (planes.empty ())
    return 0.0;
  return deepest (object, [&] (const Eigen::Vector3d& at) {
    double depth = 0.0;
    for (const Eigen::Vector4d& plane : planes)
      depth = std::max (depth, -plane.head<3> ().dot (at) - plane[3]);
    return depth;
  });
}

double
CoSectionRun::penetrationOfSurroundings (const Object& object) const
{
  double deepest = penetrationOfGivenPlanes (object);
  const std::vector<Eigen::Isometry3d> poses = relativePoses (object, nullptr);
  for (const SignedDistanceField::ConstPtr& body : background_)
    deepest = std::max (deepest, penetration (object, *body, poses));
  for (const Obstacle& body : bodies_)
    for (const Eigen::Isometry3d& T_field_world : body.T_field_world)
      for (const Eigen::Isometry3d& T_world_object : poses)
        deepest = std::max (deepest, penetration (object, *body.field, {T_field_world * T_world_object}));
  return deepest;
}

double
CoSectionRun::penetration (const Object& object) const
{
  double deepest = penetrationOfSurroundings (object);
  for (const Object& other : objects_)
    if (&other != &object && other.alive ())
      deepest = std::max (deepest, penetration (object, other.field, relativePoses (object, &other)));
  return deepest;
}

bool
CoSectionRun::growWeightsWherePenetrating (Resolution resolution)
{
  const double allowed_voxels = penetration_voxels * (resolution == Resolution::Half ? 2.0 : 1.0);
  bool any = false;
  const auto grow = [&] (double& beta) {
    if (beta >= max_weight_growth)
      return;
    beta *= weight_growth;
    any = true;
  };
  double coarsest = 0.0; // of the surroundings
  for (const SignedDistanceField::ConstPtr& body : background_)
    coarsest = std::max (coarsest, body->grid.voxel_size_m);
  for (const Obstacle& body : bodies_)
    coarsest = std::max (coarsest, body.field->grid.voxel_size_m);
  for (Object& object : objects_)
  {
    if (!object.alive ())
      continue;
    const double h = object.volume ().grid ().voxel_size_m;
    if (penetrationOfSurroundings (object) > allowed_voxels * std::clamp (coarsest, h, coarse_voxels * h))
      grow (object.beta_surroundings);
  }
  for (Object& object : objects_)
    for (std::size_t p = 0; object.alive () && p < objects_.size (); ++p)
    {
      const Object& other = objects_[p];
      if (&other == &object || !other.alive ())
        continue;
      const double allowed = allowed_voxels * std::max (object.field.grid.voxel_size_m, other.field.grid.voxel_size_m);
      if (penetration (object, other.field, relativePoses (object, &other)) <= allowed)
        continue;
      grow (object.beta.try_emplace (p, 1.0).first->second);
    }
  return any;
}

void
CoSectionRun::solveObjects (Resolution resolution, int min_passes)
{
  const bool repeat = scene_.options.use_intersection && scene_.options.intersect_solved;
  const int passes = repeat ? scene_.options.max_passes : 1;
  for (int pass = 0; pass < passes; ++pass)
  {
    solvePass (resolution, pass);
    if (pass + 1 < min_passes || pass + 1 == passes)
      continue;
    bool again = false;
    timed ("constraints", [&] { again = growWeightsWherePenetrating (resolution); });
    if (!again)
      break;
  }
}

void
CoSectionRun::solveObjects ()
{
  // The first pass of all sees neighbours through their data alone, so it is not the last.
  const int needed = objects_.size () > 1 ? 2 : 1;
  const bool half_first = scene_.options.solver.type == SolverType::Multigrid;
  if (half_first)
    solveObjects (Resolution::Half, needed);
  solveObjects (Resolution::Full, half_first ? 1 : needed);
}

} // namespace pcl::cosection
