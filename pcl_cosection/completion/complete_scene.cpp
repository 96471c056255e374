// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "complete_scene.h"

#include "background/background.h"
#include "energy_terms.h"
#include "finish_objects.h"
#include "joint_solve.h"
#include "observe.h"
#include "place_bodies.h"
#include "surroundings.h"

namespace pcl::cosection {

SceneResult
completeScene (const Scene& scene, CompletionMode mode, UpdateOutput output, const ProgressCallback& progress,
               SceneState& state)
{
  CompletionLog log (scene.objects.size (), progress);
  log.report ("measurements", 0.0);

  // The measurements of each object: its points without outliers, their spacing and noise, occlusion by its views.
  const std::vector<Observation> observations = log.timed ("data_term",
                                                           [&] { return observeObjects (scene, mode, state, log); });

  // Support planes: given ones, and ones fitted to the background.
  const std::vector<SupportPlanes> support = log.timed ("constraints",
                                                        [&] { return findObjectPlanes (scene, observations, log); });

  // A grid for each object, for its obstacles, and for the background.
  const std::vector<SceneObject> objects = log.timed (
      "constraints", [&] { return placeObjects (scene, observations, support, mode, state, log); });
  const std::size_t used_bytes = bytesInUse (scene, state, observations); // without obstacles
  const std::vector<Obstacle> obstacles = log.timed ("constraints",
                                                     [&] { return sampleObstacles (scene, objects, used_bytes, log); });
  BackgroundBodies bodies = log.timed ("constraints", [&] {
    return placeBackground (scene, objects, mode, used_bytes + bytesOf (obstacles), state, log);
  });

  // Sums over points for equation (2), and votes on free space for (3).
  const std::vector<double> contradicted = gatherEvidence (scene, mode, objects, bodies, log);

  // The background first, E_data + E_reg + E_hull: it is a constraint for all objects.
  Background background = solveBackground (scene, objects, mode, output, bodies, log);
  bodies = {}; // a piece of the background is not needed once it is solved

  // The energy of each object, equations (1) to (3), and the priors on its hidden sides.
  std::vector<BodyEnergy> energies = objectEnergies (scene, mode, objects, log);

  // Equations (4) and (5): all objects together, so that they penetrate neither each other nor their surroundings.
  const std::vector<SignedDistanceField::ConstPtr> background_fields = background.fields ();
  const std::vector<SolverSummary> solvers = solveJointly (scene, objects, background_fields, obstacles, energies, log);

  // Zero sets with provenance, confidence and expected errors, inner and outer bounds, penetration.
  std::vector<ObjectResult> finished = log.timed ("mesh", [&] {
    return finishObjects (scene, objects, energies, background_fields, obstacles, output, used_bytes, log);
  });
  log.report ("done", 1.0);
  dropFailed (scene, log, state);
  return sceneResult (scene, observations, support, objects, contradicted, std::move (background), solvers,
                      std::move (finished), log);
}

} // namespace pcl::cosection
