// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene_files.h"
#include "tool_run.h"

#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/io/mesh_io.h>

#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <string>
#include <vector>

constexpr double ball_m3 = 4.0 / 3.0 * M_PI * 0.001; ///< of writeSphere ()

class AnyCloud : public ToolTest
{
protected:
  nlohmann::json summary () const { return (json ("s.json")); }

  double volume (const std::string& name) const
  {
    const pcl::cosection::TriangleMesh mesh = pcl::cosection::loadMesh (path (name));
    EXPECT_TRUE (computeTopology (mesh).closed_manifold) << name;
    return (computeMassProperties (mesh).volume_m3);
  }

  Eigen::Vector3d centroid (const std::string& name) const
  {
    return (computeMassProperties (pcl::cosection::loadMesh (path (name))).centroid_m);
  }

  /** \brief Every second point of the ball, moved by \a T. */
  void writeHalf (const std::string& name, std::size_t first, const Eigen::Isometry3f& T) const
  {
    writeSphere (path ("whole.pcd"), 4000);
    pcl::PointCloud<pcl::PointNormal> whole, half;
    pcl::io::loadPCDFile (path ("whole.pcd"), whole);
    for (std::size_t i = first; i < whole.size (); i += 2)
    {
      half.push_back (whole[i]);
      half.back ().getVector3fMap () = T * whole[i].getVector3fMap ();
      half.back ().getNormalVector3fMap () = T.linear () * whole[i].getNormalVector3fMap ();
    }
    pcl::io::savePCDFileBinary (path (name), half);
  }
};
