// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/volume/mesh_distance/mesh_bodies.h"

#include <pcl/cosection/common/triangle_mesh.h>

#include <Eigen/Core>

#include <cstdint>
#include <memory>
#include <vector>

namespace pcl::cosection {

/** \brief How deep points lie in the matter that a mesh bounds, by the rules of sampleSignedDistance (); but a closed
 * part that faces inward and is less than half as long as the whole is a cavity in matter that something else bounds,
 * and says nothing. */
class SolidDepth
{
public:
  /** \param[in] band_m how far behind open parts there is matter; 0: there is none */
  SolidDepth (const TriangleMesh& mesh, double band_m);

  /** \brief Metres to the surface of the body that \a p lies deepest in, or to the open part that it lies behind; 0
   * outside. */
  double at (const Eigen::Vector3d& p) const;

  bool hasBodies () const { return !bodies_.empty (); }

  /** \brief Whether a closed part faces inward, with matter all around it. */
  bool hasRoom () const;

  /** \brief The mesh without its open parts. */
  TriangleMesh closedParts () const;

  /** \brief Whether some of the mesh is open. */
  bool hasSheets () const { return sheets_ != nullptr; }

private:
  struct Body
  {
    std::unique_ptr<SearchableSurface> surface;
    std::vector<std::uint32_t> all;
    bool is_room = false; ///< matter is all around it
  };

  double depthIn (const Body& body, const Eigen::Vector3d& p) const;

  std::vector<Body> bodies_;
  std::unique_ptr<SearchableSurface> sheets_;
  double band_m_;
};

} // namespace pcl::cosection
