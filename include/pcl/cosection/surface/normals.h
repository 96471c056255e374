// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/export.h>

#include <Eigen/Core>

#include <cstdint>
#include <functional>
#include <vector>

namespace pcl::cosection {

/** \brief Parameters of computeOrganizedNormals (). */
struct PCL_COSECTION_EXPORT OrganizedNormalsOptions
{
  double radius_m = 0.01;          ///< half width of the window on the surface
  int min_radius_px = 3;           ///< the window is never smaller, pixels
  int max_radius_px = 7;           ///< nor larger, pixels; at most 15
  double min_support = 1.0 / 3.0;  ///< share of the window's pixels that must lie on the fitted plane
  double max_incidence_rad = 1.45; ///< largest angle between the normal and the direction to the sensor
  double working_range_m = 1.0;    ///< of the sensor, for depthNoiseSigma ()
  int threads = 0;                 ///< 0: all

  /** \brief Check all values. \throws InvalidArgument naming the first one outside its domain. */
  void validate () const;
};

/** \brief Normals of an organised cloud in its sensor frame.
 *
 * A plane is fitted to the covariance of the pixels in a square window around each point. Only
 * pixels of the same label count, and only those that the point reaches along rows and columns
 * without a jump in range larger than the sensor's noise (depthNoiseSigma ()) and a surface tilted
 * by 75 degrees explain; pixels far from a first fit are trimmed, and the rest is fitted again.
 * Points without enough support, off the plane of their neighbours (as \e mixed pixels at depth
 * edges are), on something that is no plane, or seen at too flat an angle get no normal.
 *
 * \param[in] points width * height points, row by row, sensor at the origin; not finite: no reading
 * \param[in] width, height pixels
 * \param[in] labels empty, or one per point
 * \param[in] options of the window
 * \return one per point: unit, towards the sensor; NaN where there is no reliable normal
 * \throws InvalidArgument if the sizes do not agree
 *
 * O (width * height * window); the result does not depend on the number of threads.
 * \code
 * const auto normals = computeOrganizedNormals (points, 640, 480, labels);
 * \endcode */
PCL_COSECTION_EXPORT std::vector<Eigen::Vector3f>
computeOrganizedNormals (const std::vector<Eigen::Vector3f>& points, int width, int height,
                         const std::vector<std::uint32_t>& labels = {}, const OrganizedNormalsOptions& options = {});

/** \brief Share in [0, 1] of the directions of space in which the outermost points of a cloud have normals that point
 * outward, weighted by how clearly they do: near 1 for a body or a part of one, near 0 if its normals are flipped,
 * about one half where the points do not determine it, as for a flat piece.
 * \param[in] points metres \param[in] normals one per point; those that are not finite are left out
 * \throws InvalidArgument if there is not one normal per point */
PCL_COSECTION_EXPORT double outwardShare (const std::vector<Eigen::Vector3f>& points,
                                          const std::vector<Eigen::Vector3f>& normals);

/** \brief Turn normals of unknown sign so that neighbours agree, along the minimum spanning tree of the graph of
 * nearest neighbours, whose edges cost most where normals differ most (H. Hoppe, T. DeRose, T. Duchamp, J. McDonald, W.
 * Stuetzle, "Surface Reconstruction from Unorganized Points", SIGGRAPH 1992), also across creases; then each connected
 * piece outward. Neighbours come from pcl::search. O (points log points).
 * \param[in] points metres, finite
 * \param[in,out] normals one per point; those that are not finite stay as they are
 * \param[in] rightShare which share of a piece, points and normals, points to the right side: below 0.5 it is turned
 * \param[in] neighbours edges of the graph from each point
 * \throws InvalidArgument if there is not one normal per point */
PCL_COSECTION_EXPORT void orientConsistently (
    const std::vector<Eigen::Vector3f>& points, std::vector<Eigen::Vector3f>& normals,
    const std::function<double (const std::vector<Eigen::Vector3f>&, const std::vector<Eigen::Vector3f>&)>& rightShare =
        outwardShare,
    int neighbours = 12);

} // namespace pcl::cosection
