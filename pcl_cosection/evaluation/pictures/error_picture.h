// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/image.h>
#include <pcl/cosection/common/triangle_mesh.h>

#include <Eigen/Core>

#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief The colour of an error: \a share 0 is blue, then green, yellow and, from 1 on, red. */
PCL_COSECTION_EXPORT TriangleMesh::Colour errorColour (double share);

/** \brief errorColour () of each error over \a error_max_m, which is positive. */
std::vector<TriangleMesh::Colour> errorColours (const std::vector<double>& errors_m, double error_max_m);

/** \brief A round number that is not less: 1, 2, 3, 4, 5, 6 or 8 times a power of ten, metres, at least a millimetre.
 */
double roundErrorUp (double error_m);

/** \brief How to draw errors. */
struct ErrorPictureOptions
{
  int panel_px = 560;                             ///< width and height of each of the four panels
  double error_max_m = 0.01;                      ///< at the red end of the scale
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ (); ///< points up in the picture
  Eigen::Vector3d front = {0.8, -1.0, 0.75};      ///< from the meshes to the first camera; not along \a up
  std::string reconstruction_caption = "Reconstruction: distance to the truth";
  std::string truth_caption = "Truth: distance to the reconstruction";
  int threads = 0; ///< 0: all

  /** \brief \throws InvalidArgument naming the first parameter outside its domain. */
  void validate () const;
};

/** \brief Draw a reconstruction in the colours of its distance to the truth, in the upper row, and the truth in those
 * of its distance to the reconstruction below it; each from two sides, the second turned about \a up, with a scale in
 * millimetres. Distances are exact at each pixel.
 * \throws InvalidArgument, DegenerateInput as requireSurface (), and for options outside their domain */
Picture drawErrorPicture (const TriangleMesh& truth, const TriangleMesh& reconstruction,
                          const ErrorPictureOptions& options = {});

} // namespace pcl::cosection
