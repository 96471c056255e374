// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/export.h>
#include <pcl/cosection/simulation/depth_noise.h>
#include <pcl/cosection/simulation/keyed_motion.h>
#include <pcl/cosection/simulation/shape.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace pcl::cosection
{

/** \brief A shape as a part of a body. */
struct PCL_COSECTION_EXPORT BodyPart
{
  Shape::ConstPtr shape;
  Eigen::Isometry3d T_body_part = Eigen::Isometry3d::Identity ();
  TriangleMesh::Colour colour{180, 180, 180};
  std::string file{}; ///< of a mesh; empty: the shape comes from none
};

/** \brief A rigid thing of a scene. */
struct PCL_COSECTION_EXPORT SceneBody
{
  std::string name; ///< part of file names; of the background: room or background
  int id = 0;       ///< in the masks; 0: the background
  std::vector<BodyPart> parts;
  KeyedMotion motion;          ///< T_world_body
  double pattern_size_m = 0.0; ///< period of the pattern on its surface; 0: plain

  /** \brief Signed distance of \a p (body frame) to the union of the parts, metres: exact outside and on the surface;
   * inside, no more than the true depth. */
  double distance (const Eigen::Vector3d& p) const;

  /** \brief Whether distance () says on which side \a p is. */
  bool isSupported (const Eigen::Vector3d& p) const;

  /** \brief The surface, body frame: of one part, its triangles; of several, that of their union, without what is
   * inside; of the background, all parts as they are. */
  TriangleMesh surface (double chord_m) const;
};

/** \brief How depth is stored. */
enum class DepthFormat
{
  Png, ///< 16 bit, whole units
  Exr, ///< 32-bit floating point, metres
};

/** \brief Everything that determines a simulated sequence. */
struct PCL_COSECTION_EXPORT SimulatedScene
{
  PinholeCamera camera{640, 480, 525.0, 525.0, 319.5, 239.5};
  KeyedMotion camera_motion; ///< T_world_camera
  int frames = 1;
  double rate = 30.0; ///< frames per second
  std::uint64_t seed = 1;
  std::optional<DepthNoise> noise;
  DepthFormat depth_format = DepthFormat::Png;
  double depth_scale = 1000.0;   ///< units of a PNG per metre
  bool exact_depth = false;      ///< also without noise
  int views_every = 0;           ///< frames from one point cloud to the next; 0: none
  std::vector<SceneBody> bodies; ///< the background is the first
  std::string spec;              ///< what it was read from, if anything

  double timeOf (int frame) const { return frame / rate; }

  /** \brief \throws InvalidArgument naming what is not right: no frames, two bodies with one id or name ... */
  void validate () const;
};

} // namespace pcl::cosection
