// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "co_section_run.h"

#include <pcl/cosection/common/parallel.h>

#include <algorithm>
#include <cmath>
#include <string>

// The part of a run in which the objects constrain each other.

namespace pcl
{
namespace cosection
{

namespace
{

constexpr double penetration_voxels = 0.5; // more is resolved by growing weights
constexpr double weight_growth = 4.0;
constexpr double max_weight_growth = 1024.0;

// Progress when the background, the first pass and all passes are done.
constexpr double background_fraction = 0.3;
constexpr double first_pass_fraction = 0.8;
constexpr double passes_fraction = 0.95;

} // namespace

IntersectionConstraint
CoSectionRun::surroundings (const Object& object) const
{
  const double beta = scene_.options.beta_inter;
  IntersectionConstraint constraint (object.volume->grid (), scene_.options.max_bound_vox, scene_.options.threads);
  for (const Eigen::Isometry3d& T_world_object : relativePoses (object, nullptr))
  {
    for (const Eigen::Vector4d& plane : object.planes)
      constraint.addHalfSpace (transformPlane (plane, T_world_object), object.volume->freeSpace (), beta);
    for (const SignedDistanceField& body : background_)
      constraint.addBody (body, T_world_object, beta);
    for (const Obstacle& body : scene_.bodies)
      for (const Eigen::Isometry3d& T_field_world : body.T_field_world)
        constraint.addBody (*body.field, T_field_world * T_world_object, beta);
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
    for (const Eigen::Isometry3d& T : relativePoses (object, &other))
      constraint.addBody (other.field, T, beta);
  }
  return constraint.bounds ();
}

void
CoSectionRun::solve (Object& object, double begin, double share)
{
  timed ("solve", [&] {
    const int before = object.result->solver.iterations;
    object.result->solver = object.volume->solve ([&] (const std::string&, double f) {
      report ("object " + std::to_string (object.input->id), begin + share * f);
      return true;
    });
    object.result->solver.iterations += before;
  });
}

void
CoSectionRun::solvePass (int pass)
{
  // Simultaneous: all bounds are taken from the fields of the pass before.
  std::vector<std::vector<LowerBound>> all (objects_.size ());
  timed ("constraints", [&] {
    for (std::size_t o = 0; o < objects_.size (); ++o)
      if (objects_[o].alive ())
        guarded (objects_[o], [&] { all[o] = bounds (objects_[o]); });
  });
  const double begin = pass == 0 ? background_fraction : first_pass_fraction;
  const double end = pass == 0 ? first_pass_fraction : passes_fraction;
  const double share = (end - begin) / static_cast<double> (objects_.size ()) /
                       (pass == 0 ? 1 : std::max (1, scene_.options.max_passes - 1));
  for (std::size_t o = 0; o < objects_.size (); ++o)
  {
    Object& object = objects_[o];
    if (!object.alive ())
      continue;
    guarded (object, [&] {
      if (!object.volume->setIntersection (std::move (all[o])) && object.volume->solved ())
        return;
      const double done = static_cast<double> (std::max (0, pass - 1) * objects_.size () + o);
      solve (object, begin + share * done, share);
    });
  }
  if (!scene_.options.intersect_solved)
    return;
  for (Object& object : objects_)
  {
    if (!object.alive ())
      continue;
    SignedDistanceField field = object.volume->solvedField ();
    // Two bodies that give way and spread by turns settle when each answers the mean of the other's last two.
    if (pass > 0)
      for (std::size_t n = 0; n < field.values.size (); ++n)
        field.values[n] = 0.5f * (field.values[n] + object.field.values[n]);
    object.field = std::move (field);
  }
}

double
CoSectionRun::penetration (const Object& object, const SignedDistanceField& body,
                           const std::vector<Eigen::Isometry3d>& poses) const
{
  // Deepest voxel within half a voxel of the object's surface.
  const SignedDistanceField& own = object.field;
  const VoxelGrid& grid = own.grid;
  const auto near = static_cast<float> (0.5 * grid.voxel_size_m);
  std::vector<double> deepest (grid.dims.z (), 0.0);
  parallelFor (0, grid.dims.z (), scene_.options.threads, [&] (int k) {
    for (int j = 0; j < grid.dims.y (); ++j)
      for (int i = 0; i < grid.dims.x (); ++i)
        if (std::abs (own.values[grid.index (i, j, k)]) <= near)
          for (const Eigen::Isometry3d& T : poses)
          {
            const auto u = body.sampleSupported (T * grid.center (i, j, k));
            if (u)
              deepest[k] = std::max (deepest[k], static_cast<double> (-*u));
          }
  });
  return *std::max_element (deepest.begin (), deepest.end ());
}

double
CoSectionRun::penetrationOfSurroundings (const Object& object) const
{
  double deepest = 0.0;
  const std::vector<Eigen::Isometry3d> poses = relativePoses (object, nullptr);
  for (const SignedDistanceField& body : background_)
    deepest = std::max (deepest, penetration (object, body, poses));
  for (const Obstacle& body : scene_.bodies)
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
CoSectionRun::growWeightsWherePenetrating ()
{
  bool any = false;
  const auto grow = [&] (double& beta) {
    if (beta >= max_weight_growth)
      return;
    beta *= weight_growth;
    any = true;
  };
  double coarsest = 0.0; // of the surroundings
  for (const SignedDistanceField& body : background_)
    coarsest = std::max (coarsest, body.grid.voxel_size_m);
  for (const Obstacle& body : scene_.bodies)
    coarsest = std::max (coarsest, body.field->grid.voxel_size_m);
  for (Object& object : objects_)
    if (object.alive () && penetrationOfSurroundings (object) >
                               penetration_voxels * std::max (coarsest, object.volume->grid ().voxel_size_m))
      grow (object.beta_surroundings);
  for (Object& object : objects_)
    for (std::size_t p = 0; object.alive () && p < objects_.size (); ++p)
    {
      const Object& other = objects_[p];
      if (&other == &object || !other.alive ())
        continue;
      const double allowed =
          penetration_voxels * std::max (object.field.grid.voxel_size_m, other.field.grid.voxel_size_m);
      if (penetration (object, other.field, relativePoses (object, &other)) <= allowed)
        continue;
      grow (object.beta.try_emplace (p, 1.0).first->second);
    }
  return any;
}

void
CoSectionRun::solveObjects ()
{
  const bool repeat = scene_.options.use_intersection && scene_.options.intersect_solved;
  const int passes = repeat ? scene_.options.max_passes : 1;
  const int needed = objects_.size () > 1 ? 2 : 1; // the first pass sees neighbours through their data alone
  for (int pass = 0; pass < passes; ++pass)
  {
    solvePass (pass);
    if (pass + 1 >= needed && pass + 1 < passes && !growWeightsWherePenetrating ())
      break;
  }
}

} // namespace cosection
} // namespace pcl
