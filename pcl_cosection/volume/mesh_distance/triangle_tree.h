// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/triangle_mesh.h>

#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace pcl::cosection {

/** \brief The nearest point of a mesh. */
struct NearestPoint
{
  /** \brief What of its triangle the point is: Vertex + n is corner n, Edge + n the side from corner n to
   * n + 1. */
  enum Feature : std::uint8_t
  {
    Vertex = 0,
    Edge = 3,
    Face = 6,
  };

  double squared_m2 = std::numeric_limits<double>::infinity ();
  std::uint32_t triangle = 0;
  std::uint8_t feature = Face;
  Eigen::Vector3d offset_m = Eigen::Vector3d::Zero (); ///< from the nearest point to the query
};

/** \brief A bounding volume hierarchy that finds the nearest point of a mesh. */
class PCL_COSECTION_EXPORT TriangleTree
{
public:
  /** \brief \a mesh must have triangles, none of them without area. */
  explicit TriangleTree (const TriangleMesh& mesh);

  /** \brief The nearest point to \a p within \a bound_m, of equally near ones that of the lowest triangle;
   * none (squared_m2 infinite) if there is no such point.
   * \param[in] hint a triangle that is probably near, to save time */
  NearestPoint nearest (const Eigen::Vector3d& p, double bound_m = std::numeric_limits<double>::infinity (),
                        std::uint32_t hint = 0) const;

private:
  struct Face
  {
    std::array<Eigen::Vector3d, 3> corners;
    std::array<Eigen::Vector3d, 3> outward; ///< unit, in the face's plane, across the side from corner n to n + 1
    Eigen::Vector3d normal;
    std::uint32_t triangle;
  };

  /** \brief A leaf has the faces [first, first + count), another node its children at first and first + 1. */
  struct Node
  {
    Eigen::Vector3f low, high;
    std::uint32_t first = 0;
    std::uint32_t count = 0;
  };

  void build (std::uint32_t node, std::uint32_t first, std::uint32_t last);

  static void compare (const Face& face, const Eigen::Vector3d& p, NearestPoint& nearest);

  std::vector<Face> faces_;
  std::vector<std::uint32_t> place_; // of each triangle in faces_
  std::vector<Node> nodes_;
};

} // namespace pcl::cosection
