// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/simulation/random_numbers.h"
#include <pcl/cosection/common/triangle_mesh.h>

#include <Eigen/Core>

#include <cstdint>
#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief A shape to complete: its box is centred at the origin, and its longest edge is 1. */
class TrainingShape
{
public:
  /** \brief \throws InvalidArgument or DegenerateInput if the mesh has no surface or is flat */
  explicit TrainingShape (TriangleMesh mesh);

  const TriangleMesh& mesh () const { return mesh_; }

  /** \brief The signed distance, negative inside, interpolated. What cannot be seen from outside is inside, so that
   * meshes with holes, with walls inside or with parts that overlap have a distance, too. */
  double distance (const Eigen::Vector3d& p) const;

  /** \brief Compute the distances, which takes a second; distance () needs them. */
  void prepare ();

private:
  TriangleMesh mesh_;
  std::vector<std::int16_t> distances_; // of a grid; units of 1/16000
};

/** \brief A body like those in a household: turned, boxes with round edges, vessels, prisms, with parts added. */
TriangleMesh randomBody (RandomNumbers& random);

/** \brief The meshes of a folder and of the folders in it, as training shapes of about 6000 triangles at most; files
 * whose names contain one of \a excluded are left out. OBJ files have y upwards, as models of furniture do, others z.
 * Names of files that cannot be used go to the standard error.
 * \throws std::filesystem::filesystem_error if there is no such folder */
std::vector<TrainingShape> loadTrainingShapes (const std::string& folder, const std::vector<std::string>& excluded);

} // namespace pcl::cosection
