// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/triangle_mesh.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief A rigid body: how it looks, what it collides by, and how it moves. */
struct PhysicalBody
{
  std::string name;                                                ///< unique: letters, digits and underscores
  int id = 0;                                                      ///< of the object; 0: static
  Eigen::Isometry3d T_scene_body = Eigen::Isometry3d::Identity (); ///< the axes are those of the scene
  TriangleMesh visual;                                             ///< body frame; may be empty
  TriangleMesh::Colour colour{150, 150, 150};                      ///< the mean of the visual mesh
  std::vector<TriangleMesh> parts;                                 ///< what it collides by, closed, body frame
  bool convex = true;                                              ///< every part is its own convex hull

  double mass_kg = 0.0;                                   ///< 0: static
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero ();    ///< of mass, body frame
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Identity (); ///< about the centre of mass, axes of the body: kg m^2
  double volume_m3 = 0.0;                                 ///< of the estimate

  double parts_volume_m3 = 0.0;      ///< sum of all parts
  double excess_m = 0.0;             ///< how far the parts reach beyond the estimate
  double missing_m = 0.0;            ///< how far the estimate reaches beyond the parts; 0: they contain it
  std::vector<Eigen::Vector3d> feet; ///< corners of the polygon by which it touches that plane, body frame
  int stands_on = -1;                ///< index of the support plane, -1: on no plane
  double centre_shift_m = 0.0;       ///< how far the centre of mass was moved so that the body stands

  bool isStatic () const { return mass_kg <= 0.0; }
};

/** \brief A plane on which bodies stand, as a static body. */
struct PhysicalPlane
{
  std::string name;                                                 ///< as that of a body
  Eigen::Isometry3d T_scene_plane = Eigen::Isometry3d::Identity (); ///< z: the normal, to the side of the bodies
  Eigen::Vector2d half_size_m = Eigen::Vector2d::Ones ();           ///< along x and y, around the origin
  double thickness_m = 0.02;                                        ///< of the matter below it
  bool endless = true; ///< there is nothing behind it: it may be a half-space where a simulator knows these
};

/** \brief What a simulator or a planner loads. */
struct PhysicalScene
{
  std::string name = "scene";
  Eigen::Isometry3d T_result_scene = Eigen::Isometry3d::Identity (); ///< from this scene to the frame of the result
  Eigen::Vector3d gravity{0.0, 0.0, -9.81};                          ///< m/s^2, in the scene
  std::vector<PhysicalBody> bodies;                                  ///< objects first, then static ones
  std::vector<PhysicalPlane> planes;                                 ///< on which they stand
  double contact_tolerance_m = 0.001;                                ///< parts of two bodies may overlap by so much
  std::vector<std::string> warnings;                                 ///< one line each
};

} // namespace pcl::cosection
