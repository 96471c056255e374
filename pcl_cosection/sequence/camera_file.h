// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>

#include <optional>
#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief What a file says of the camera of a sequence. */
struct CameraFile
{
  PinholeCamera camera;              ///< of size 0 x 0 if the file has none
  std::optional<double> depth_scale; ///< units per metre, if the file tells it
};

/** \brief Names of the files that tell the camera, the first that is there counts. */
const std::vector<std::string>& cameraFileNames ();

/** \brief Read the camera of a sequence:
 * * text of numbers: "fx fy cx cy [width height]", a matrix of 3 x 3 or 4 x 4; lines that begin with # are skipped
 * * Open3D's camera_intrinsic.json: intrinsic_matrix column by column, width, height
 * * librealsense's fx, fy, ppx, ppy, width, height
 * * the BOP benchmark's camera.json (fx, fy, cx, cy, width, height, depth_scale), and its scene_camera.json: cam_K and
 *   depth_scale for each image, which must all be the same
 * * cam_params.json of renderings of Replica: camera with fx, fy, cx, cy, w, h, and scale in units per metre
 * \throws IoError if it cannot be read, or is of no such form */
CameraFile readCameraFile (const std::string& path);

} // namespace pcl::cosection
