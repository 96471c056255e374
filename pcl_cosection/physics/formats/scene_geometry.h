// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/physics/physical_scene.h"

#include <cmath>

namespace pcl::cosection {

/** \brief The rotation of a pose, of the two quaternions the one with w >= 0. */
inline Eigen::Quaterniond
rotationOf (const Eigen::Isometry3d& pose)
{
  Eigen::Quaterniond rotation (pose.linear ());
  rotation.normalize ();
  if (rotation.w () < 0.0)
    rotation.coeffs () = -rotation.coeffs ();
  return rotation;
}

/** \brief w, x, y, z, the order of MuJoCo and USD; Eigen's is x, y, z, w. */
inline Eigen::Vector4d
scalarFirst (const Eigen::Quaterniond& rotation)
{
  return {rotation.w (), rotation.x (), rotation.y (), rotation.z ()};
}

/** \brief The box around all vertices. */
inline Eigen::AlignedBox3f
boundsOf (const TriangleMesh& mesh)
{
  Eigen::AlignedBox3f bounds;
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    bounds.extend (vertex);
  return bounds;
}

/** \brief Edges of the box whose upper face is the plane. */
inline Eigen::Vector3d
boxSize (const PhysicalPlane& plane)
{
  return {2.0 * plane.half_size_m.x (), 2.0 * plane.half_size_m.y (), plane.thickness_m};
}

/** \brief Centre of that box in the plane's frame. */
inline Eigen::Vector3d
boxCentre (const PhysicalPlane& plane)
{
  return {0.0, 0.0, -0.5 * plane.thickness_m};
}

constexpr TriangleMesh::Colour plane_colour{190, 190, 190}; ///< light grey, so that bodies stand out

/** \brief Red, green, blue from 0 to 1, as displays take them (sRGB). */
inline Eigen::Vector3f
displayColour (const TriangleMesh::Colour& colour)
{
  return Eigen::Vector3f (colour[0], colour[1], colour[2]) / 255.0f;
}

/** \brief Red, green, blue from 0 to 1, proportional to the light: what glTF and USD want (IEC 61966-2-1). */
inline Eigen::Vector3f
linearColour (const TriangleMesh::Colour& colour)
{
  return displayColour (colour).unaryExpr (
      [] (float c) { return c <= 0.04045f ? c / 12.92f : std::pow ((c + 0.055f) / 1.055f, 2.4f); });
}

} // namespace pcl::cosection
