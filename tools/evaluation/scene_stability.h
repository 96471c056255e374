// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/error.h>

#include <optional>
#include <string>
#include <vector>

/** \brief How far a free body of a simulated scene is from where it began. */
struct BodyDrift
{
  std::string name;
  double drift_m = 0.0;         ///< of its centre of mass, at the end
  double turn_rad = 0.0;        ///< angle of its rotation, at the end
  double largest_drift_m = 0.0; ///< at any time
  double largest_turn_rad = 0.0;
  bool flew_away = false; ///< it was once farther off than ten times the extent of the scene

  /** \brief Whether it is at the end where it began, but for a tolerance. */
  bool stayed (double max_drift_m, double max_turn_rad) const
  {
    return (!flew_away && drift_m <= max_drift_m && turn_rad <= max_turn_rad);
  }
};

/** \brief Two bodies that overlap. */
struct BodyContact
{
  double depth_m = 0.0;
  std::string first, second; ///< a body that never moves and has no name of its own: the name of its geom
};

/** \brief What became of a scene. */
struct SceneStability
{
  std::vector<BodyDrift> bodies;              ///< those with a free joint, in the order of the file
  std::optional<BodyContact> deepest_contact; ///< before the first step; nothing if no bodies overlap
  double extent_m = 0.0;                      ///< diagonal of the box around all but planes, before the first step
  double time_step_s = 0.0;                   ///< as the file has it
  double duration_s = 0.0;                    ///< that was simulated: whole steps
  std::vector<std::string> warnings;          ///< of MuJoCo about the file, one line each
};

/** \brief Whether this build has MuJoCo. */
bool canSimulate ();

/** \brief Load a scene in MuJoCo's format and let it move. MuJoCo runs in a process of its own, which ends alone if
 * MuJoCo ends its process or crashes.
 * \param[in] path of the file
 * \param[in] duration_s how long the bodies move, simulated time
 * \throws pcl::cosection::IoError if the file cannot be read or has no free body, or if the simulation fails, for
 * instance because it becomes unstable: MuJoCo would go on from the beginning. \throws pcl::cosection::Cancelled
 * \throws pcl::cosection::Error if this build has no MuJoCo */
SceneStability simulateScene (const std::string& path, double duration_s,
                              const pcl::cosection::ProgressCallback& progress = {});
