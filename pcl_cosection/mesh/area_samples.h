// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/triangle_mesh.h>

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

namespace pcl::cosection {

/** \brief \throws InvalidArgument if a triangle refers to a vertex that does not exist, or to one that is not finite.
 * \throws DegenerateInput if the mesh has no triangles, or none of any area
 * \param[in] name what the message calls the mesh */
PCL_COSECTION_EXPORT void requireSurface (const TriangleMesh& mesh, const char* name = "mesh");

/** \brief The area of a mesh, square metres. */
PCL_COSECTION_EXPORT double surfaceArea (const TriangleMesh& mesh);

/** \brief A place on a mesh. */
struct MeshPlace
{
  std::size_t triangle = 0;        ///< its index
  std::array<double, 3> weights{}; ///< barycentric, of the corners of the triangle
  Eigen::Vector3d position;        ///< metres
};

/** \brief Draws places on a mesh, uniform by area and independent of each other: the same for the same seed everywhere.
 *
 * Triangles by their share of the area, places in them by R. Osada et al., "Shape Distributions", TOG 2002. */
class AreaSampler
{
public:
  /** \param[in] mesh must live as long as the object \param[in] seed of the random numbers
   * \throws InvalidArgument, DegenerateInput as requireSurface () */
  AreaSampler (const TriangleMesh& mesh, std::uint64_t seed, const char* name = "AreaSampler");

  /** \brief The area of the mesh, square metres. */
  double area () const { return up_to_.back (); }

  /** \brief O (log triangles). */
  MeshPlace next ();

private:
  /** \brief In [0, 1). */
  double uniform ();

  const TriangleMesh& mesh_;
  std::vector<double> up_to_; // area of the triangles up to and including each
  std::mt19937_64 generator_;
};

/** \brief Points on a mesh as AreaSampler draws them.
 * \return \a count points, metres, in the frame of the mesh
 * \throws InvalidArgument, DegenerateInput as requireSurface () */
PCL_COSECTION_EXPORT std::vector<Eigen::Vector3d> sampleSurface (const TriangleMesh& mesh, std::size_t count,
                                                                 std::uint64_t seed = 0);

} // namespace pcl::cosection
