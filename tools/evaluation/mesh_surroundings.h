// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "evaluation_output.h"
#include "mesh_command.h"

#include "pcl_cosection/evaluation/free_space_violation.h"

#include <optional>
#include <string>
#include <vector>

/** \brief How a reconstruction fits into what is around it. */
struct Surroundings
{
  struct Obstacle
  {
    std::string file;
    bool is_open = false;
    double depth_m = 0.0;
    std::optional<double> volume_m3;
  };

  std::vector<Obstacle> obstacles;
  std::optional<pcl::cosection::FreeSpaceViolation> free_space;

  /** \brief The deepest of all obstacles. */
  double penetration_m () const;
};

/** \brief Read obstacles and views, and measure them.
 * \param[in] origin of the reconstruction \throws pcl::cosection::Error */
Surroundings measureSurroundings (const MeshSettings& settings, const Eigen::Vector3d& origin,
                                  const pcl::cosection::TriangleMesh& reconstruction,
                                  std::vector<std::string>& warnings);

void print (const Surroundings& surroundings, Terminal& terminal);

/** \brief Set penetration_m and so on of \a json. */
void addSurroundings (const Surroundings& surroundings, Json& json);
