// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/image.h>
#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/evaluation/run_evaluation.h>

#include <map>
#include <string>
#include <vector>

/** \brief A picture of a scene's objects: a column for each method, the truth first, and a row for each object, seen
 * from the side that the cameras saw least; orange is inferred, blue bounded by free space, green by other bodies. */
class PictureRows
{
public:
  /** \param[in] truth objects with meshes and poses, and the camera's */
  explicit PictureRows (const pcl::cosection::SceneRecord& truth);

  void add (const std::string& method, const std::map<int, pcl::cosection::TriangleMesh>& meshes);

  pcl::cosection::Picture picture () const;

private:
  struct Row
  {
    pcl::cosection::PinholeCamera camera;
    Eigen::Isometry3d T_object_camera;
    std::vector<pcl::cosection::Picture> panels;
  };

  std::map<int, Row> rows_;
};
