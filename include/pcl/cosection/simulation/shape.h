// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/triangle_mesh.h>

#include <Eigen/Geometry>

#include <memory>
#include <vector>

namespace pcl::cosection
{

/** \brief A body of known shape, metres, in its own frame. */
class PCL_COSECTION_EXPORT Shape
{
public:
  using ConstPtr = std::shared_ptr<const Shape>;

  virtual ~Shape ();

  /** \brief Signed distance of \a p to the surface, metres, negative inside. */
  virtual double distance (const Eigen::Vector3d& p) const = 0;

  /** \brief Whether distance () is computed from a formula, to rounding errors; else the shape is its mesh, and the
   * distance is interpolated in a grid, up to an eighth of its size and with the right sign beyond. */
  virtual bool isAnalytic () const = 0;

  /** \brief Where distance () says which side of the surface a point is on. */
  virtual bool isSupported (const Eigen::Vector3d& p) const;

  /** \brief The surface as triangles: vertices on the surface, no farther from it than \a chord_m between them; closed
   * unless the shape is infinite or an open mesh. */
  virtual TriangleMesh tessellate (double chord_m) const = 0;
};

/** \brief A polygon in a plane, counter-clockwise or clockwise, not closed by a repeated point, metres. */
using Polygon2d = std::vector<Eigen::Vector2d>;

/** \brief All lengths are metres; \throws InvalidArgument if one is not positive and finite. */
PCL_COSECTION_EXPORT Shape::ConstPtr makeSphere (double radius);

/** \brief Centred at the origin; edges and corners rounded by \a rounding, within the given size. */
PCL_COSECTION_EXPORT Shape::ConstPtr makeBox (const Eigen::Vector3d& size, double rounding = 0.0);

/** \brief The inside of a box, centred at the origin: matter is outside of it. */
PCL_COSECTION_EXPORT Shape::ConstPtr makeRoom (const Eigen::Vector3d& size);

/** \brief About z, from z = 0 to \a height. */
PCL_COSECTION_EXPORT Shape::ConstPtr makeCylinder (double radius, double height);

/** \brief About z from z = 0, where it has \a bottom_radius, to \a height; one radius may be zero. */
PCL_COSECTION_EXPORT Shape::ConstPtr makeCone (double bottom_radius, double top_radius, double height);

/** \brief Everything within \a radius of the segment from the origin to (0, 0, length). */
PCL_COSECTION_EXPORT Shape::ConstPtr makeCapsule (double radius, double length);

/** \brief About z in the plane z = 0; \a radius of the centre line, \a tube_radius around it. */
PCL_COSECTION_EXPORT Shape::ConstPtr makeTorus (double radius, double tube_radius);

/** \brief A profile (distance from the axis, z) turned about z: cups, bottles, bowls, vases.
 * \throws InvalidArgument if it has less than three points, a negative distance, crosses itself or has no area */
PCL_COSECTION_EXPORT Shape::ConstPtr makeRevolution (const Polygon2d& profile);

/** \brief An outline (x, y) from z = 0 to \a height. \throws InvalidArgument as makeRevolution () */
PCL_COSECTION_EXPORT Shape::ConstPtr makeExtrusion (const Polygon2d& outline, double height);

/** \brief Matter below the plane z = 0; its mesh is a square of \a extent. */
PCL_COSECTION_EXPORT Shape::ConstPtr makeHalfSpace (double extent);

/** \brief A mesh, multiplied by \a scale. If parts of it are open, what is inside is known near its triangles only.
 * \throws InvalidArgument if it has no triangles, or is not finite */
PCL_COSECTION_EXPORT Shape::ConstPtr makeMeshShape (TriangleMesh mesh, double scale = 1.0);

} // namespace pcl::cosection
