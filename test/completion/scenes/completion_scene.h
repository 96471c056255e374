// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "completion/analytic_scene.h"

#include <pcl/cosection/surface/co_section.h>

#include <string>

namespace pcl::cosection::test {

enum class Shape
{
  Sphere,
  Box,
  Torus, ///< lying flat
  Cup,
};

std::string nameOf (Shape shape);

/** \brief The voxel size of most tests on tableScene (). */
constexpr double voxel_m = 0.005;

/** \brief The shape on the table z = 0, about 12 cm large. */
Distance onTable (Shape shape);

/** \brief Table (0) and the shape (1). */
AnalyticScene tableScene (Shape shape);

/** \brief The table of tableScene (). */
inline const Eigen::Vector4d table_plane (0.0, 0.0, 1.0, 0.0);

/** \brief A camera for the object of tableScene (), and poses from which it sees the object. */
PinholeCamera tableCamera ();
Eigen::Isometry3d fromAbove ();
Eigen::Isometry3d fromTheFront ();

/** \brief Options with one thread and the given voxel size. */
CoSectionOptions optionsFor (double voxel_size_m);

Eigen::Isometry3d motion (double angle_rad, const Eigen::Vector3d& axis, const Eigen::Vector3d& translation_m);

/** \brief Mean distance, in voxels and the larger of both directions, between completing and moving a scene, and
 * moving and completing it; distances of more than four voxels count as four. */
double effectOfMotion (Shape shape, double voxel_size_m, const Eigen::Isometry3d& T);

/** \brief Complete everything seen in a view: label 0 is the background, others are objects. */
SceneResult complete (const RenderedView& seen, const CoSectionOptions& options);

struct FieldDifference
{
  double rms_vox = 0.0;   ///< root mean square, voxels of the first field
  std::size_t voxels = 0; ///< that were compared
};

/** \brief How two fields differ where either is within two voxels of its surface; the second may have another grid.
 * \param[in] near_data only where the first is evidence */
FieldDifference differenceNearSurface (const SignedDistanceField& a, const SignedDistanceField& b,
                                       bool near_data = false);

} // namespace pcl::cosection::test
