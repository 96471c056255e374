// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// pcl_cosection_segment with a network, and with parts of the image left out.

#include "segmentation/onnx_messages.h"
#include "segmentation/spot_network.h"
#include "tool_run.h"

#include "pcl_cosection/io/image_io.h"

#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <filesystem>
#include <limits>

namespace fs = std::filesystem;
using namespace pcl::cosection;
using test::SpotNetwork;

namespace {

class SegmentNetwork : public ToolTest
{
protected:
  using Cloud = pcl::PointCloud<pcl::PointXYZRGBL>;

  /** \brief A red spot of 6 x 4 pixels from (8, 6) on, and a network that finds such. */
  SegmentNetwork () : ToolTest (PCL_COSECTION_SEGMENT)
  {
    write ("spot.onnx",
           affineOnnx (SpotNetwork::width, SpotNetwork::height, SpotNetwork{NetworkOutputForm::Prototypes}.outputs ()));
    write ("names", "person\ntable\ncup\n");
    const Picture picture = test::spotPicture (8, 6);
    for (int v = 0; v < picture.height; ++v)
      for (int u = 0; u < picture.width; ++u)
      {
        pcl::PointXYZRGBL& p = cloud_ (u, v);
        p.getVector3fMap () = Eigen::Vector3f (0.01f * u, 0.01f * v, 1.0f);
        p.r = picture.at (u, v)[0];
        p.label = 65535; // is not looked at
      }
    pcl::io::savePCDFileBinary (path ("in.pcd"), cloud_);
  }

  static std::vector<std::string> arguments (const std::vector<std::string>& more = {})
  {
    std::vector<std::string> all = {"in.pcd",  "out.pcd",   "--method",     "mask-rcnn",
                                    "--model", "spot.onnx", "--input-size", "24,16"};
    all.insert (all.end (), more.begin (), more.end ());
    return (all);
  }

  /** \brief How often each label is in what comes out. */
  std::map<std::uint32_t, std::size_t> labels (const std::vector<std::string>& words)
  {
    EXPECT_EQ (run (words), 0) << errors_;
    EXPECT_EQ (errors_, "");
    Cloud out;
    EXPECT_EQ (pcl::io::loadPCDFile (path ("out.pcd"), out), 0);
    std::map<std::uint32_t, std::size_t> counts;
    for (const auto& p : out)
      ++counts[p.label];
    return (counts);
  }

  Cloud cloud_{SpotNetwork::width, SpotNetwork::height};
};

using Counts = std::map<std::uint32_t, std::size_t>;
constexpr std::size_t spot = 24, rest = 24 * 16 - spot;

} // namespace

TEST_F (SegmentNetwork, LabelsWhatTheNetworkFinds)
{
  EXPECT_EQ (labels (arguments ({"--class-names", "names", "--classes", "cup", "--json", "s.json", "--quiet"})),
             (Counts{{0, rest}, {1, spot}}));
  const nlohmann::json summary = json ("s.json");
  ASSERT_EQ (summary["objects"].size (), 1u);
  EXPECT_EQ (summary["objects"][0]["label"], 1);
  EXPECT_EQ (summary["objects"][0]["points"], spot);
  EXPECT_EQ (summary["objects"][0]["class"], "cup");
  EXPECT_EQ (summary["objects"][0]["class_id"], 2);
  EXPECT_EQ (summary["objects"][0]["score"], 0.9);
  EXPECT_EQ (summary["parameters"]["method"], "mask-rcnn");
  EXPECT_EQ (summary["ignored_points"], 0);
}

TEST_F (SegmentNetwork, ClassesHaveRoles)
{
  EXPECT_EQ (labels (arguments ()), (Counts{{0, rest}, {1, spot}}));
  EXPECT_EQ (labels (arguments ({"--class-names", "names", "--classes", "person,table"})), (Counts{{0, rest + spot}}));
  EXPECT_EQ (labels (arguments ({"--static-classes", "1,2"})), (Counts{{0, rest + spot}}));
  EXPECT_EQ (labels (arguments ({"--class-names", "names", "--ignore", "cup"})), (Counts{{0, rest}, {65535, spot}}));
  EXPECT_EQ (labels (arguments ({"--score", "0.95"})), (Counts{{0, rest + spot}}));
}

TEST_F (SegmentNetwork, PartsOfTheImageAreLeftOut)
{
  EXPECT_EQ (labels (arguments ({"--ignore-region", "0,0,24,7"})),
             (Counts{{0, rest - 24 * 7 + 6}, {1, spot - 6}, {65535, 24 * 7}}));
  Image<std::uint16_t> mask (SpotNetwork::width, SpotNetwork::height, 0);
  mask.at (9, 7) = 300;
  mask.at (0, 15) = 1;
  saveMaskImage (mask, path ("mask.png"), true);
  EXPECT_EQ (
      labels (arguments ({"--ignore-mask", "mask.png", "--ignore-region", "1,1,1,1", "--ignore-region", "2,1,1,1"})),
      (Counts{{0, rest - 3}, {1, spot - 1}, {65535, 4}}));
}

TEST_F (SegmentNetwork, IgnoredPointsAreNotCompleted)
{
  for (auto& p : cloud_)
    p.r = 0;
  cloud_ (0, 0).r = 1; // not all black; nothing is found
  pcl::io::savePCDFileBinary (path ("in.pcd"), cloud_);
  labels (arguments ({"--ignore-region", "0,0,24,16"}));
  EXPECT_EQ (run ({"out.pcd", "meshes"}, {}, PCL_COSECTION_TOOL), 1); // nothing is left
  EXPECT_FALSE (fs::exists (path ("meshes/object_65535.ply")));
}

TEST_F (SegmentNetwork, WrongUsageIsOneLine)
{
  EXPECT_NE (failure ({"in.pcd", "out.pcd", "--method", "mask-rcnn"}, 2).find ("--model"), std::string::npos);
  EXPECT_NE (failure ({"in.pcd", "out.pcd", "--method", "magic"}, 2).find ("geometric"), std::string::npos);
  EXPECT_NE (failure ({"in.pcd", "out.pcd", "--model", "spot.onnx"}, 2).find ("--method mask-rcnn"), std::string::npos);
  EXPECT_NE (failure (arguments ({"--concave-angle", "0.3"}), 2).find ("--method geometric"), std::string::npos);
  EXPECT_NE (failure ({"in.pcd", "out.pcd", "--method", "mask-rcnn", "--model", "spot.pt"}, 2).find (".onnx"),
             std::string::npos);
  EXPECT_NE (failure (arguments ({"--class-names", "names", "--classes", "cups"}), 2).find ("did you mean cup?"),
             std::string::npos);
  EXPECT_NE (failure (arguments ({"--classes", "cup"}), 2).find ("--class-names"), std::string::npos);
  EXPECT_NE (
      failure (arguments ({"--class-names", "names", "--classes", "cup", "--ignore", "cup"}), 2).find ("\"cup\""),
      std::string::npos);
  EXPECT_NE (failure (arguments ({"--score", "2"}), 2).find ("--score"), std::string::npos);
  EXPECT_NE (failure (arguments ({"--input-mean", "1,2"}), 2).find ("--input-mean"), std::string::npos);
  EXPECT_NE (failure ({"in.pcd", "out.pcd", "--ignore-region", "1,2,3"}, 2).find ("--ignore-region"),
             std::string::npos);
  EXPECT_NE (failure ({"in.pcd", "out.pcd", "--ignore-region", "1,2,3,-4"}, 2).find ("--ignore-region"),
             std::string::npos);
  EXPECT_NE (failure ({"in.pcd", "out.pcd", "--ignore-region", "23,0,2,4"}, 2).find ("24 x 16"), std::string::npos);
}

TEST_F (SegmentNetwork, DamagedNetworksAreOneLine)
{
  const auto graph = [] (std::int64_t group, const test::TensorShape& kernel) {
    test::OnnxGraph made;
    made.input ("image", {1, 3, SpotNetwork::height, SpotNetwork::width}).weights ("kernel", kernel);
    made.node ("Conv", {"image", "kernel"}, {"out"},
               {test::OnnxGraph::attribute ("group", group), test::OnnxGraph::attribute ("kernel_shape", {3, 3})});
    return (made.output ("out", {1, 2, 14, 22}));
  };
  write ("spot.onnx", graph (1, {2, 3, 3, 3}).tensor ("short", {1, 3, 4096, 4096}, 1, std::string (64, '\0')).bytes ());
  EXPECT_NE (failure (arguments (), 1).find ("spot.onnx: OpenCV cannot read it as a network: tensor \"short\""),
             std::string::npos);
  write ("spot.onnx", graph (0, {2, 3, 3, 3}).bytes ());
  EXPECT_NE (failure (arguments (), 1).find ("group of 0"), std::string::npos);
  write ("spot.onnx", graph (1, {0, 3, 3, 3}).bytes ()); // OpenCV 4.6 crashes
  EXPECT_NE (failure (arguments (), 1).find ("spot.onnx: OpenCV cannot read it as a network: "), std::string::npos);
  write ("spot.onnx", graph (2, {2, 3, 3, 3}).bytes ()); // does not divide the channels
  EXPECT_NE (failure (arguments (), 1).find ("spot.onnx: "), std::string::npos);
}

TEST_F (SegmentNetwork, BadInputIsOneLine)
{
  const std::string model = test::readFile (path ("spot.onnx"));
  write ("cut.onnx", model.substr (0, model.size () / 2));
  write ("any_size.onnx", affineOnnx (SpotNetwork::width, SpotNetwork::height,
                                      SpotNetwork{NetworkOutputForm::Prototypes}.outputs (), false));
  EXPECT_NE (failure ({"in.pcd", "out.pcd", "--method", "mask-rcnn", "--model", "absent.onnx"}, 1).find ("absent.onnx"),
             std::string::npos);
  EXPECT_NE (failure ({"in.pcd", "out.pcd", "--method", "mask-rcnn", "--model", "cut.onnx"}, 1).find ("cut.onnx"),
             std::string::npos);
  EXPECT_NE (failure ({"in.pcd", "out.pcd", "--method", "mask-rcnn", "--model", "any_size.onnx"}, 1).find ("640 x 640"),
             std::string::npos);
  EXPECT_NE (failure (arguments ({"--class-names", "absent"}), 1).find ("absent"), std::string::npos);
  write ("two", "cup\nbottle\n");
  EXPECT_NE (failure (arguments ({"--class-names", "two"}), 1).find ("3 classes"), std::string::npos);
  EXPECT_NE (failure (arguments ({"--ignore-mask", "absent.png"}), 1).find ("absent.png"), std::string::npos);
  saveMaskImage (Image<std::uint16_t> (3, 3, 1), path ("small.png"));
  EXPECT_NE (failure (arguments ({"--ignore-mask", "small.png"}), 1).find ("3 x 3"), std::string::npos);

  pcl::PointCloud<pcl::PointXYZ> colourless;
  pcl::copyPointCloud (cloud_, colourless);
  pcl::io::savePCDFileBinary (path ("in.pcd"), colourless);
  EXPECT_NE (failure (arguments (), 1).find ("in.pcd: has no colours"), std::string::npos);
  Cloud changed = cloud_;
  for (auto& p : changed)
    p.r = 0;
  pcl::io::savePCDFileBinary (path ("in.pcd"), changed);
  EXPECT_NE (failure (arguments (), 1).find ("in.pcd: all of it is black"), std::string::npos);
  changed = cloud_;
  changed.width *= changed.height;
  changed.height = 1;
  pcl::io::savePCDFileBinary (path ("in.pcd"), changed);
  EXPECT_NE (failure (arguments (), 1).find ("in.pcd: is not organised"), std::string::npos);
}
