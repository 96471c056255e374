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

} // namespace

std::vector<LowerBound>
CoSectionRun::bounds (const Object& object) const
{
  const CoSectionOptions& options = scene_.options;
  IntersectionConstraint constraint (object.volume->grid (), options.max_bound_vox, options.threads);
  if (!options.use_intersection || options.beta_inter <= 0.0)
    return {};
  for (const Eigen::Isometry3d& T_world_object : relativePoses (object, nullptr))
  {
    for (const Eigen::Vector4d& plane : object.planes)
      constraint.addHalfSpace (transformPlane (plane, T_world_object), object.volume->freeSpace (), options.beta_inter);
    for (const SignedDistanceField& body : background_)
      constraint.addBody (body, T_world_object, options.beta_inter);
    for (const Obstacle& body : scene_.bodies)
      for (const Eigen::Isometry3d& T_field_world : body.T_field_world)
        constraint.addBody (*body.field, T_field_world * T_world_object, options.beta_inter);
  }
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
CoSectionRun::solvePass (int pass)
{
  // Simultaneous: all bounds are taken from the fields of the pass before.
  std::vector<std::vector<LowerBound>> all (objects_.size ());
  timed ("constraints", [&] {
    for (std::size_t o = 0; o < objects_.size (); ++o)
      if (objects_[o].alive ())
        guarded (objects_[o], [&] { all[o] = bounds (objects_[o]); });
  });
  for (std::size_t o = 0; o < objects_.size (); ++o)
  {
    Object& object = objects_[o];
    if (!object.alive ())
      continue;
    const auto fraction = [&] (double f) {
      const double done = (static_cast<double> (o) + f) / static_cast<double> (objects_.size ());
      return pass == 0 ? 0.3 + 0.5 * done : 0.8 + 0.15 * (pass - 1 + done) / std::max (1, scene_.options.max_passes - 1);
    };
    guarded (object, [&] {
      if (!object.volume->setIntersection (std::move (all[o])) && object.volume->solved ())
        return;
      timed ("solve", [&] {
        object.result->solver = object.volume->solve ([&] (const std::string&, double f) {
          report ("object " + std::to_string (object.input->id), fraction (f));
          return true;
        });
      });
    });
  }
  if (scene_.options.intersect_solved)
    for (Object& object : objects_)
      if (object.alive ())
        object.field = object.volume->solvedField ();
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
CoSectionRun::penetration (const Object& object) const
{
  double deepest = 0.0;
  for (const SignedDistanceField& body : background_)
    deepest = std::max (deepest, penetration (object, body, relativePoses (object, nullptr)));
  for (const Object& other : objects_)
    if (&other != &object && other.alive ())
      deepest = std::max (deepest, penetration (object, other.field, relativePoses (object, &other)));
  return deepest;
}

bool
CoSectionRun::growWeightsWherePenetrating ()
{
  bool any = false;
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
      double& beta = object.beta.try_emplace (p, 1.0).first->second;
      if (beta < max_weight_growth)
      {
        beta *= weight_growth;
        any = true;
      }
    }
  return any;
}

void
CoSectionRun::solveObjects ()
{
  const bool mutual = scene_.options.use_intersection && scene_.options.intersect_solved && objects_.size () > 1;
  const int passes = mutual ? scene_.options.max_passes : 1;
  for (int pass = 0; pass < passes; ++pass)
  {
    solvePass (pass);
    if (pass > 0 && pass + 1 < passes && !growWeightsWherePenetrating ())
      break;
  }
}

} // namespace cosection
} // namespace pcl
