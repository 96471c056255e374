// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/triangle_mesh.h>

#include <cstdint>
#include <vector>

namespace pcl::cosection {

/** \brief What the rasteriser writes for each pixel; row by row, width * height entries. */
struct PCL_COSECTION_EXPORT RasterImage
{
  int width = 0;            ///< pixels
  int height = 0;           ///< pixels
  std::vector<float> depth; ///< metres along the optical axis; NaN: nothing hit
  std::vector<Eigen::Vector3f>
      normals;                   ///< sensor frame, unit, towards the camera's side of the triangle; zero: nothing
  std::vector<std::int32_t> ids; ///< id given to draw (); -1: nothing
  std::vector<std::array<std::uint8_t, 3>> colours; ///< unshaded surface colour; zero: nothing
};

/** \brief A z-buffer rasteriser for triangle meshes and points: depth, normals, ids and surface
 * colours of a scene as a pinhole camera sees it, without a display or a GPU.
 *
 * Depth is perspective-correct and sampled at pixel centres; triangles are clipped at \a near_m.
 * \code
 * Rasterizer rasterizer (camera, T_world_camera);
 * rasterizer.draw (mesh, 1);
 * writePng (shade (rasterizer.image (), camera), "picture.png");
 * \endcode */
class PCL_COSECTION_EXPORT Rasterizer
{
public:
  /** \brief An empty image. \throws InvalidArgument if the camera is not valid. */
  Rasterizer (const PinholeCamera& camera, const Eigen::Isometry3d& T_world_camera, double near_m = 0.01);

  /** \brief Draw a mesh whose vertices are in the frame of \a T_world_mesh. Colours come from the
   * mesh, else \a colour. Smooth normals if the mesh has normals, else flat. */
  void draw (const TriangleMesh& mesh, int id, const Eigen::Isometry3d& T_world_mesh = Eigen::Isometry3d::Identity (),
             const std::array<std::uint8_t, 3>& colour = {200, 200, 200});

  /** \brief Draw points as squares of \a size_px pixels; their normal faces the camera.
   * \param[in] points metres, world frame
   * \param[in] colours empty, or one per point
   * \param[in] id written where a point is seen
   * \param[in] size_px edge of the squares */
  void drawPoints (const std::vector<Eigen::Vector3f>& points, const std::vector<std::array<std::uint8_t, 3>>& colours,
                   int id, int size_px = 2);

  /** \brief What was drawn so far. */
  const RasterImage& image () const { return image_; }

private:
  PinholeCamera camera_;
  Eigen::Isometry3d T_camera_world_;
  double near_m_;
  RasterImage image_;
};

} // namespace pcl::cosection
