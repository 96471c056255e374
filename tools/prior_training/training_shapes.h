// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/triangle_mesh.h>

#include <Eigen/Core>

#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief Random numbers that are the same on all machines. */
class Dice
{
public:
  explicit Dice (std::uint64_t seed) : engine_ (seed) {}

  double uniform (double low = 0.0, double high = 1.0)
  {
    return low + (high - low) * static_cast<double> (engine_ () >> 11) * 0x1p-53;
  }
  double logUniform (double low, double high) { return low * std::pow (high / low, uniform ()); }
  bool chance (double probability) { return uniform () < probability; }
  int below (int count) { return static_cast<int> (uniform () * count); }
  double normal () { return std::sqrt (-2.0 * std::log (1.0 - uniform ())) * std::cos (2.0 * M_PI * uniform ()); }
  std::uint64_t seed () { return engine_ (); }

private:
  std::mt19937_64 engine_;
};

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
TriangleMesh randomBody (Dice& dice);

/** \brief All meshes that a folder and its folders have, as training shapes with at most 6000 triangles; files whose
 * names contain one of \a excluded are left out. */
std::vector<TrainingShape> loadTrainingShapes (const std::vector<std::string>& folders,
                                               const std::vector<std::string>& excluded);

} // namespace pcl::cosection
