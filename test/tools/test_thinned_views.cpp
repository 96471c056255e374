// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// The program with what others made of a view before: thinned by pcl::VoxelGrid, with normals of pcl::NormalEstimation,
// one cluster alone. Readings between things and what is behind them, which a camera has few of, are as many there as
// those of surfaces.

#include "common/temporary_folder.h"
#include "tool_run.h"

#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/io/mesh_io.h>

#include <pcl/features/impl/normal_3d.hpp> // for points with labels
#include <pcl/filters/impl/voxel_grid.hpp>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

using namespace pcl::cosection;

namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZL>;

const std::map<int, std::string> things = {
    {2, "carton"}, {3, "ball"}, {4, "bottle"}}; // those of the scene whose walls are not thin

class ThinnedViews : public testing::Test
{
protected:
  static void SetUpTestSuite ()
  {
    folder_ = std::make_unique<pcl::cosection::test::TemporaryFolder> ();
    ToolRun tool ({"--preset", "table", "--frames", "0:1", "sim"}, folder_->file (""), {}, PCL_COSECTION_SIMULATE);
    ASSERT_EQ (tool.wait (), 0) << tool.errors ();
    pcl::io::loadPCDFile (folder_->file ("sim/views/View0000.pcd"), view_);
  }

  static void TearDownTestSuite ()
  {
    folder_.reset ();
    view_ = Cloud ();
  }

  /** \brief One point of each label per cell; zero: all that have a reading. */
  static Cloud::Ptr thinned (float cell_m)
  {
    std::map<std::uint32_t, Cloud::Ptr> parts;
    for (const auto& p : view_)
      if (std::isfinite (p.x))
      {
        Cloud::Ptr& part = parts[p.label];
        if (!part)
          part = std::make_shared<Cloud> ();
        part->push_back (p);
      }
    auto all = std::make_shared<Cloud> ();
    for (const auto& [label, part] : parts)
    {
      Cloud thin = *part;
      if (cell_m > 0.0f)
      {
        pcl::VoxelGrid<pcl::PointXYZL> grid;
        grid.setInputCloud (part);
        grid.setLeafSize (cell_m, cell_m, cell_m);
        grid.filter (thin);
      }
      for (auto& p : thin)
      {
        p.label = label;
        all->push_back (p);
      }
    }
    all->sensor_origin_ = view_.sensor_origin_;
    all->sensor_orientation_ = view_.sensor_orientation_;
    return all;
  }

  void save (const Cloud::ConstPtr& cloud, bool with_normals) const
  {
    if (!with_normals)
    {
      pcl::io::savePCDFileBinary (folder_->file ("view.pcd"), *cloud);
      return;
    }
    pcl::PointCloud<pcl::PointXYZLNormal> normals;
    pcl::NormalEstimation<pcl::PointXYZL, pcl::PointXYZLNormal> estimation;
    estimation.setInputCloud (cloud);
    estimation.setKSearch (20);
    estimation.setViewPoint (0.0f, 0.0f, 0.0f);
    estimation.compute (normals);
    for (std::size_t i = 0; i < cloud->size (); ++i)
    {
      normals[i].getVector3fMap () = (*cloud)[i].getVector3fMap ();
      normals[i].label = (*cloud)[i].label;
    }
    normals.sensor_origin_ = cloud->sensor_origin_;
    normals.sensor_orientation_ = cloud->sensor_orientation_;
    pcl::io::savePCDFileBinary (folder_->file ("view.pcd"), normals);
  }

  /** \brief Relative error of a mesh's volume. */
  static double volumeError (const std::string& mesh, const std::string& thing)
  {
    const TriangleMesh body = loadMesh (folder_->file (mesh));
    EXPECT_TRUE (computeTopology (body).closed_manifold);
    return computeMassProperties (body).volume_m3 /
               computeMassProperties (loadMesh (folder_->file ("sim/gt-mesh/" + thing + ".ply"))).volume_m3 -
           1.0;
  }

  static std::unique_ptr<pcl::cosection::test::TemporaryFolder> folder_;
  static Cloud view_;
};

std::unique_ptr<pcl::cosection::test::TemporaryFolder> ThinnedViews::folder_;
Cloud ThinnedViews::view_;

} // namespace

TEST_F (ThinnedViews, HaveTheirVolumes)
{
  struct Case
  {
    float cell_m;
    bool with_normals;
    double most; // error
  };
  for (const Case& c : {Case{0.0f, true, 0.05}, Case{0.005f, false, 0.08}, Case{0.005f, true, 0.08},
                        Case{0.01f, false, 0.15}, Case{0.01f, true, 0.15}})
  {
    SCOPED_TRACE (std::to_string (c.cell_m) + (c.with_normals ? " m, with normals" : " m"));
    save (thinned (c.cell_m), c.with_normals);
    ToolRun tool ({"view.pcd", "meshes"}, folder_->file (""));
    ASSERT_EQ (tool.wait (), 0) << tool.errors ();
    for (const auto& [id, name] : things)
      EXPECT_NEAR (volumeError ("meshes/object_" + std::to_string (id) + ".ply", name), 0.0, c.most) << name;
  }
}

TEST_F (ThinnedViews, ClustersAloneHaveTheirVolumes)
{
  for (const float cell_m : {0.005f, 0.01f})
    for (const auto& [id, name] : things)
    {
      SCOPED_TRACE (name + " " + std::to_string (cell_m) + " m");
      const Cloud::Ptr all = thinned (cell_m);
      auto cluster = std::make_shared<Cloud> ();
      for (const auto& p : *all)
        if (static_cast<int> (p.label) == id)
          cluster->push_back (p);
      cluster->sensor_origin_ = all->sensor_origin_;
      cluster->sensor_orientation_ = all->sensor_orientation_;
      save (cluster, false);
      ToolRun tool ({"view.pcd", "mesh.ply"}, folder_->file (""));
      ASSERT_EQ (tool.wait (), 0) << tool.errors ();
      EXPECT_NEAR (volumeError ("mesh.ply", name), 0.0, cell_m > 0.007f ? 0.4 : 0.15);
    }
}
