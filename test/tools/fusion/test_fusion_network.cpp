// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// pcl_cosection_fusion with a network that finds red and blue things.

#include "fusion_scene.h"
#include "segmentation/onnx_messages.h"
#include "segmentation/spot_network.h"

#include <pcl/cosection/io/mesh_io.h>

#include <nlohmann/json.hpp>

namespace {

class FusionNetwork : public FusionScene
{
protected:
  FusionNetwork ()
  {
    using pcl::cosection::test::affineOnnx;
    using pcl::cosection::test::colourNetwork;
    std::ofstream (file ("net.onnx"), std::ios::binary)
        << affineOnnx (24, 18, colourNetwork (24, 18, {{1, -1, 0}, {-1, 0, 1}}, 0.15f));
    std::ofstream (file ("names")) << "ball\nbox\n";
  }

  static Words withNetwork (Words more = {})
  {
    Words words = {"sim",          "out",      "--segmentation",          "mask-rcnn",
                   "--model",      "net.onnx", "--class-names",           "names",
                   "--input-size", "24,18",    "--background-voxel-size", "0.03"};
    words.insert (words.end (), more.begin (), more.end ());
    return (words);
  }

  /** \brief The objects that there are in the end, as the summary has them. */
  nlohmann::json objects () const
  {
    std::ifstream summary (file ("out/summary.json"));
    return (nlohmann::json::parse (summary)["objects"]);
  }

  /** \brief What they are, sorted. */
  Words classes () const
  {
    Words names;
    for (const auto& object : objects ())
      names.push_back (object.at ("class"));
    std::sort (names.begin (), names.end ());
    return (names);
  }
};

} // namespace

TEST_F (FusionNetwork, FindsTheObjects)
{
  ASSERT_EQ (run (withNetwork ()), 0) << errors_;
  EXPECT_EQ (objects ().size (), 2u);
}

TEST_F (FusionNetwork, SaysWhatTheyAre)
{
  ASSERT_EQ (run (withNetwork ()), 0) << errors_;
  ASSERT_EQ (classes (), (Words{"ball", "box"}));
  for (const auto& object : objects ())
  {
    const std::string name = object["class"];
    EXPECT_EQ (object["class_id"], name == "ball" ? 0 : 1);
    EXPECT_EQ (object["score"], 0.9);
    EXPECT_NE (output_.find ("object " + object["id"].dump () + ": " + name + ", score 0.9, " +
                             object["vertices"].dump () + " vertices"),
               std::string::npos)
        << output_;
    // The ball is red, the box is not.
    const pcl::cosection::TriangleMesh mesh = pcl::cosection::loadPlyMesh (
        file ("out/mesh/object_" + object["id"].dump () + ".ply"));
    ASSERT_EQ (mesh.colours.size (), mesh.vertices.size ());
    const auto red = std::count_if (mesh.colours.begin (), mesh.colours.end (),
                                    [] (const auto& c) { return (c[0] > c[2] + 30); });
    EXPECT_EQ (2 * red > static_cast<std::ptrdiff_t> (mesh.colours.size ()), name == "ball");
  }
}

TEST_F (FusionNetwork, AClassWithoutANameIsANumber)
{
  Words words = withNetwork ({"--classes", "1"});
  words.erase (words.begin () + 6, words.begin () + 8);
  ASSERT_EQ (run (words), 0) << errors_;
  EXPECT_EQ (classes (), (Words{"1"}));
  EXPECT_NE (output_.find (": class 1, score 0.9, "), std::string::npos) << output_;
}

TEST_F (FusionNetwork, OfMasksNoClassIsKnown)
{
  ASSERT_EQ (run ({"sim", "out", "--masks", "sim/mask", "--background-voxel-size", "0.03"}), 0) << errors_;
  ASSERT_EQ (objects ().size (), 2u);
  for (const auto& object : objects ())
    for (const char* key : {"class", "class_id", "score"})
      EXPECT_FALSE (object.contains (key)) << key;
  EXPECT_EQ (output_.find ("score"), std::string::npos) << output_;
}

TEST_F (FusionNetwork, ClassesHaveRoles)
{
  ASSERT_EQ (run (withNetwork ({"--classes", "ball"})), 0) << errors_;
  EXPECT_EQ (classes (), Words{"ball"});
  ASSERT_EQ (run (withNetwork ({"--static-classes", "ball", "--ignore", "box"})), 0) << errors_;
  EXPECT_TRUE (objects ().empty ());
}

TEST_F (FusionNetwork, DamagedNetworksAreOneLine)
{
  using pcl::cosection::test::OnnxGraph;
  const auto expectError = [&] (std::int64_t group, std::int64_t kernels) {
    OnnxGraph graph;
    graph.input ("image", {1, 3, 48, 64}).weights ("kernel", {kernels, 3, 3, 3});
    graph.node ("Conv", {"image", "kernel"}, {"out"},
                {OnnxGraph::attribute ("kernel_shape", {3, 3}), OnnxGraph::attribute ("group", group)});
    std::ofstream (file ("damaged.onnx"), std::ios::binary) << graph.output ("out", {1, 2, 46, 62}).bytes ();
    expectFailure ({"sim", "out", "--segmentation", "mask-rcnn", "--model", "damaged.onnx"}, 1,
                   "damaged.onnx: OpenCV cannot read it as a network: ");
  };
  expectError (0, 2);
  expectError (1, 0); // OpenCV 4.6 crashes
}

TEST_F (FusionNetwork, WrongUsageIsOneLine)
{
  expectFailure ({"sim", "out", "--segmentation", "mask-rcnn"}, 2, "--model");
  expectFailure ({"sim", "out", "--segmentation", "geometric", "--model", "net.onnx"}, 2, "--segmentation mask-rcnn");
  expectFailure ({"sim", "out", "--model", "net.onnx"}, 2, "--segmentation mask-rcnn");
  expectFailure (withNetwork ({"--classes", "bal"}), 2, "did you mean ball?");
  expectFailure ({"sim", "out", "--segmentation", "mask-rcnn", "--model", "absent.onnx"}, 1, "absent.onnx");
}
