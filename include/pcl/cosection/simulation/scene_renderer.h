// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/image.h>
#include <pcl/cosection/simulation/simulated_scene.h>

#include <vector>

namespace pcl::cosection {

/** \brief A scene as the camera sees it at a time. */
struct PCL_COSECTION_EXPORT SimulatedFrame
{
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity (); ///< pose of the camera, metres
  Picture colour;                                                    ///< what the camera sees, shaded
  Image<float> depth;                   ///< metres along the optical axis, without noise; NaN: nothing
  Image<std::uint16_t> mask;            ///< id of the body; 0: the background, or nothing
  std::vector<Eigen::Vector3f> normals; ///< unit, sensor frame, one per pixel; zero: nothing
};

/** \brief Renders a scene: what the camera sees is found by a rasteriser, analytic shapes are then met where their
 * signed distance is zero, to less than 0.01 mm along the ray. Several threads may render with one renderer.
 *
 * \code
 * const SceneRenderer renderer (loadSceneSpec ("scene.json"));
 * const SimulatedFrame frame = renderer.render (0.0); // depth, colour, mask, normals
 * \endcode */
class PCL_COSECTION_EXPORT SceneRenderer
{
public:
  /** \brief Prepare the parts. \throws InvalidArgument as SimulatedScene::validate () */
  explicit SceneRenderer (const SimulatedScene& scene);
  SceneRenderer (const SceneRenderer&) = delete;
  SceneRenderer& operator= (const SceneRenderer&) = delete;

  /** \brief What the camera sees at \a time, seconds; runs on the calling thread. */
  SimulatedFrame render (double time) const;

private:
  struct DrawnPart
  {
    const BodyPart* part;
    std::size_t body;  // its number in the scene
    TriangleMesh mesh; // part frame
  };

  /** \brief The depth along the ray through a pixel where the part's distance is zero, near \a z. */
  double refined (const Shape& shape, const Eigen::Vector3d& origin, const Eigen::Vector3d& ray, double z) const;

  SimulatedScene scene_;
  std::vector<DrawnPart> parts_;
};

} // namespace pcl::cosection
