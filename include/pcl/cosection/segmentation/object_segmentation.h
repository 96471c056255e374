// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/export.h>

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace pcl::cosection
{

/** \brief Parameters of segmentObjects (). */
struct PCL_COSECTION_EXPORT ObjectSegmentationOptions
{
  double max_object_size_m = 0.5;    ///< what is longer is furniture or room
  double min_object_size_m = 0.02;   ///< what is shorter is no object
  double min_support_area_m2 = 0.03; ///< the largest plane must have so much surface in view to carry objects
  double concave_angle_rad = 0.45;   ///< a crease that is concave by more than this separates two objects
  int threads = 0;                   ///< 0: all

  /** \brief \throws InvalidArgument naming the first parameter outside its domain. */
  void validate () const;
};

/** \brief What segmentObjects () finds. */
struct PCL_COSECTION_EXPORT ObjectSegmentation
{
  std::vector<std::uint32_t> labels;           ///< one per point: 0 background or no reading, 1 ... objects
  std::vector<std::uint8_t> too_long;          ///< one per point: 1 would be part of an object, but that is too long
  std::uint32_t objects = 0;                   ///< number of them, larger ones in the image first
  std::vector<Eigen::Vector4f> support_planes; ///< (n, d), n.x + d = 0, unit n towards the sensor; best seen first
};

/** \brief Finds the objects of a scene in one organised cloud by their geometry alone.
 *
 * Planes are taken for the room and its furniture as far as they are longer than an object, or enclosed: what is seen
 * beside them rises before them, as it does around the back of a shelf's compartment, while the face of an object ends
 * freely. What stands in front of them is divided into small patches of one orientation; neighbouring patches belong
 * together where they meet smoothly or at a convex edge, and apart where they meet at a concave one (S. C. Stein,
 * M. Schoeler, J. Papon, F. Woergoetter, "Object Partitioning using Local Convexity", CVPR 2014). The evidence of all
 * edges is weighed by greedy additive edge contraction (M. Keuper et al., "Efficient Decomposition of Image and Mesh
 * Graphs by Lifted Multicuts", ICCV 2015), so that a few wrong edges do not join two objects. Pieces of one surface
 * that something in front divides, and the inside of hollow things, are put together again.
 *
 * \param[in] points width * height points, row by row, in the sensor's frame (sensor at the origin), metres; not
 * finite: no reading
 * \throws InvalidArgument if the sizes do not agree or an option is outside its domain
 * \throws DegenerateInput if there are no readings, or no plane in view that objects could stand on
 *
 * The result does not depend on the number of threads.
 * \code
 * const auto scene = segmentObjects (points, 640, 480);
 * \endcode */
PCL_COSECTION_EXPORT ObjectSegmentation segmentObjects (const std::vector<Eigen::Vector3f>& points, int width,
                                                        int height, const ObjectSegmentationOptions& options = {});

} // namespace pcl::cosection
