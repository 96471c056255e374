// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Networks whose files say what is not so: checked before OpenCV sees them, or read and run where a crash does no harm.

#include <pcl/cosection/segmentation/instance_detector.h>

#include "common/message_of.h"
#include "common/temporary_folder.h"
#include "onnx_messages.h"
#include "spot_network.h"

#include "pcl_cosection/segmentation/network/child_process.h"
#include "pcl_cosection/segmentation/network/onnx_check.h"

#include <pcl/cosection/common/error.h>

#include <opencv2/core/utility.hpp>
#include <sys/wait.h>

#include <gtest/gtest.h>

#include <cerrno>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

using namespace pcl::cosection;
using test::OnnxGraph;
using test::ProtobufMessage;
using test::SpotNetwork;
using test::TensorShape;

namespace {

/** \brief A graph of one convolution. */
OnnxGraph
convolution (const std::vector<ProtobufMessage>& attributes = {OnnxGraph::attribute ("kernel_shape", {1, 1})},
             const TensorShape& kernel = {2, 3, 1, 1})
{
  OnnxGraph graph;
  graph.input ("image", {1, 3, SpotNetwork::height, SpotNetwork::width}).weights ("kernel", kernel);
  graph.node ("Conv", {"image", "kernel"}, {"out"}, attributes).output ("out", {1, 2, 16, 24});
  return (graph);
}

/** \brief What is wrong with an ONNX file; empty: nothing. */
std::string
wrongWith (const std::string& bytes)
{
  try
  {
    checkOnnx (bytes);
  }
  catch (const IoError& error)
  {
    return (error.what ());
  }
  return ("");
}

std::string
wrongWithTensor (const TensorShape& shape, int type, const std::string& raw)
{
  return (wrongWith (convolution ().tensor ("weights", shape, type, raw).bytes ()));
}

/** \brief The convolution, with a tensor of another kind. */
std::string
withTensor (const ProtobufMessage& tensor)
{
  return (convolution ().part (5, tensor).bytes ());
}

class DamagedNetworks : public testing::Test
{
protected:
  InstanceDetectorOptions write (const std::string& name, const std::string& bytes) const
  {
    std::ofstream (folder_.file (name), std::ios::binary) << bytes;
    InstanceDetectorOptions options;
    options.model = folder_.file (name);
    options.input_width = SpotNetwork::width;
    options.input_height = SpotNetwork::height;
    return (options);
  }

  std::string failure (const InstanceDetectorOptions& options) const
  {
    const std::string what = test::messageOf<IoError> (
        [&] { InstanceDetector (options).detect (test::spotPicture (0, 0)); });
    EXPECT_EQ (what.find (options.model), 0u) << what;
    return (what);
  }

  /** \brief What the check does not know of, and OpenCV 4.6 crashes on; later ones may refuse it. */
  InstanceDetectorOptions crashing () const
  {
    return (write ("crash.onnx", convolution ({OnnxGraph::attribute ("kernel_shape", {3, 3})}, {0, 3, 3, 3}).bytes ()));
  }

  InstanceDetectorOptions good () const
  {
    return (write ("good.onnx", affineOnnx (SpotNetwork::width, SpotNetwork::height,
                                            SpotNetwork{NetworkOutputForm::Prototypes}.outputs ())));
  }

  const test::TemporaryFolder folder_;
};

bool
hasNoChildren ()
{
  return (waitpid (-1, nullptr, WNOHANG) < 0 && errno == ECHILD);
}

std::size_t
openFiles ()
{
  const std::filesystem::directory_iterator files ("/proc/self/fd");
  return (static_cast<std::size_t> (std::distance (begin (files), end (files))));
}

} // namespace

TEST_F (DamagedNetworks, TensorsHaveTheDataThatTheirDimensionsSay)
{
  const auto bytes = [] (std::size_t size) { return (std::string (size, '\0')); };
  EXPECT_EQ (wrongWith (convolution ().bytes ()), "");
  const std::vector<std::pair<int, std::size_t>> types = {{1, 4}, {2, 1}, {3, 1},  {4, 2},  {5, 2},  {6, 4},
                                                          {7, 8}, {9, 1}, {10, 2}, {11, 8}, {12, 4}, {13, 8}};
  for (const auto& [type, size] : types)
  {
    EXPECT_EQ (wrongWithTensor ({2, 3}, type, bytes (6 * size)), "") << type;
    EXPECT_EQ (wrongWithTensor ({}, type, bytes (size)), "") << type;
    EXPECT_EQ (wrongWithTensor ({0, 7}, type, ""), "") << type;
    for (const std::size_t wrong : {std::size_t{0}, 6 * size - 1, 6 * size + 1, 12 * size})
      EXPECT_NE (wrongWithTensor ({2, 3}, type, bytes (wrong)).find ("2 x 3"), std::string::npos) << type;
  }
  const std::string message = wrongWithTensor ({1, 3, 4096, 4096}, 1, bytes (64));
  EXPECT_EQ (message, "tensor \"weights\" has 64 bytes of data, but its 1 x 3 x 4096 x 4096 values need 201326592");
  for (const TensorShape& shape : {TensorShape{-1},
                                   {-2, -3},
                                   {1ll << 32, 6},
                                   {1ll << 32, 1ll << 32},
                                   {1ll << 31, 1ll << 31, 4, 0},
                                   {1ll << 62, 4}})
    EXPECT_NE (wrongWithTensor (shape, 1, bytes (24)).find ("cannot have"), std::string::npos);
  EXPECT_NE (wrongWithTensor (TensorShape (33, 1), 1, bytes (4)).find ("33 dimensions"), std::string::npos);
  for (const int type : {0, 8, 14, 99, -1})
    EXPECT_NE (wrongWithTensor ({1}, type, bytes (4)).find ("type"), std::string::npos);
}

TEST_F (DamagedNetworks, ValuesMayBeInTheFieldOfTheirType)
{
  const auto floats = [] (const TensorShape& shape, std::size_t values) {
    ProtobufMessage tensor;
    for (const std::int64_t size : shape)
      tensor.number (1, size);
    tensor.number (2, 1).text (8, "weights").text (4, std::string (4 * values, '\0'));
    return (tensor);
  };
  EXPECT_EQ (wrongWith (withTensor (floats ({2, 3}, 6))), "");
  EXPECT_NE (wrongWith (withTensor (floats ({2, 3}, 5))).find ("5 values"), std::string::npos);
  EXPECT_NE (wrongWith (withTensor (floats ({2, 3}, 7))).find ("7 values"), std::string::npos);
  // Those of another type do not count.
  const ProtobufMessage others = ProtobufMessage ().number (1, 6).number (2, 1).text (7, std::string (6, '\1'));
  EXPECT_NE (wrongWith (withTensor (others)).find ("0 bytes"), std::string::npos);
  // Fields of a message that comes twice are of one message.
  const ProtobufMessage once = OnnxGraph::tensorMessage ("", {2}, 1, std::string (8, '\0')),
                        twice = ProtobufMessage ().message (5, once).message (5, once).text (1, "value");
  OnnxGraph graph = convolution ();
  graph.node ("Constant", {}, {"constant"}, {twice});
  EXPECT_NE (wrongWith (graph.bytes ()).find ("2 x 2"), std::string::npos);
}

TEST_F (DamagedNetworks, TensorsAreCheckedWhereverTheyAre)
{
  const ProtobufMessage cut = OnnxGraph::tensorMessage ("cut", {4}, 1, std::string (15, '\0'));
  const ProtobufMessage inner = ProtobufMessage ().message (5, cut); // a graph
  const std::vector<ProtobufMessage> attributes = {
      OnnxGraph::attribute ("value", cut), ProtobufMessage ().text (1, "tensors").message (10, cut),
      ProtobufMessage ().text (1, "body").message (6, inner), ProtobufMessage ().text (1, "bodies").message (11, inner),
      ProtobufMessage ().text (1, "sparse").message (22, ProtobufMessage ().message (1, cut))};
  for (const ProtobufMessage& attribute : attributes)
  {
    OnnxGraph graph = convolution ();
    graph.node ("Constant", {}, {"constant"}, {attribute});
    EXPECT_NE (wrongWith (graph.bytes ()).find ("15 bytes"), std::string::npos);
  }
  EXPECT_NE (wrongWith (convolution ().part (15, ProtobufMessage ().message (1, cut)).bytes ()).find ("15 bytes"),
             std::string::npos);
  const ProtobufMessage outside = ProtobufMessage ().number (1, 4).number (2, 1).number (14, 1);
  EXPECT_NE (wrongWith (withTensor (outside)).find ("another file"), std::string::npos);
}

TEST_F (DamagedNetworks, SizesAreThoseThatThereCanBe)
{
  for (const std::int64_t value : {0ll, -1ll, 1ll << 40})
    for (const char* const name : {"strides", "dilations", "kernel_shape"})
    {
      EXPECT_NE (wrongWith (convolution ({OnnxGraph::attribute (name, TensorShape{1, value})}).bytes ()).find (name),
                 std::string::npos);
      EXPECT_NE (wrongWith (convolution ({OnnxGraph::attribute ("group", value)}).bytes ()).find ("group"),
                 std::string::npos);
    }
  EXPECT_EQ (
      wrongWith (convolution ({OnnxGraph::attribute ("group", 1), OnnxGraph::attribute ("strides", {2, 2})}).bytes ()),
      "");
}

TEST_F (DamagedNetworks, NodesUseWhatIsBeforeThem)
{
  OnnxGraph absent = convolution (), later = convolution (), circle = convolution ();
  absent.node ("Relu", {"nowhere"}, {"relu"});
  EXPECT_NE (wrongWith (absent.bytes ()).find ("uses \"nowhere\""), std::string::npos);
  later.node ("Relu", {"late"}, {"relu"}).node ("Relu", {"out"}, {"late"});
  EXPECT_NE (wrongWith (later.bytes ()).find ("uses \"late\""), std::string::npos);
  circle.node ("Relu", {"circle"}, {"circle"});
  EXPECT_NE (wrongWith (circle.bytes ()).find ("uses \"circle\""), std::string::npos);
  OnnxGraph optional = convolution ();
  optional.node ("Clip", {"out", "", ""}, {"clip"});
  EXPECT_EQ (wrongWith (optional.bytes ()), "");
}

TEST_F (DamagedNetworks, WhatIsNoNetworkIsSaid)
{
  const std::string whole = convolution ().bytes ();
  EXPECT_NE (wrongWith (""), "");
  EXPECT_NE (wrongWith ("no network\n"), "");
  EXPECT_NE (wrongWith (OnnxGraph ().bytes ()), "");
  for (std::size_t size = 0; size + 20 < whole.size (); ++size) // the last bytes are the version of the operators
    EXPECT_NE (wrongWith (whole.substr (0, size)), "") << size;
}

TEST_F (DamagedNetworks, ACrashIsAnError)
{
  const std::string while_reading = failure (crashing ());
  EXPECT_NE (while_reading.find ("OpenCV cannot read it as a network: "), std::string::npos) << while_reading;
  if (cv::getVersionMajor () == 4 && cv::getVersionMinor () == 6)
  {
    EXPECT_NE (while_reading.find ("OpenCV crashes ("), std::string::npos) << while_reading;
  }
  // No names of inputs where OpenCV expects some.
  for (const char* const operation : {"Conv", "Gather", "Concat", "Reshape", "BatchNormalization", "Split", "Slice",
                                      "MatMul", "Transpose", "Resize", "Expand", "Pad", "LSTM", "Relu", "Add"})
  {
    OnnxGraph graph = convolution ();
    graph.node (operation, {}, {"lonely"});
    failure (write ("lonely.onnx", graph.bytes ()));
  }
  EXPECT_TRUE (hasNoChildren ());
  EXPECT_EQ (InstanceDetector (good ()).detect (test::spotPicture (8, 6)).size (), 1u);
}

TEST_F (DamagedNetworks, EachChannelIsNormalized)
{
  for (const std::int64_t channels : {2, 3})
  {
    OnnxGraph graph = convolution ();
    graph.weights ("values", {channels});
    graph.node ("BatchNormalization", {"image", "values", "values", "values", "values"}, {"normal"});
    const bool is_refused = failure (write ("normal.onnx", graph.bytes ())).find ("2 values for 3 channels") !=
                            std::string::npos;
    EXPECT_EQ (is_refused, channels == 2);
  }
}

TEST_F (DamagedNetworks, DamagedGraphsOfTensorFlowAreErrors)
{
  std::vector<test::AffineOutput> outputs = SpotNetwork{NetworkOutputForm::BoxList}.outputs ();
  outputs[3].shape.erase (outputs[3].shape.begin ());
  const std::string whole = affineTensorflow (SpotNetwork::width, SpotNetwork::height, outputs);
  for (std::size_t n = 1; n < 12; ++n)
    failure (write ("cut.pb", whole.substr (0, whole.size () * n / 12)));
  failure (write ("text.pb", "node {\n name: \"image\"\n}\n"));
  InstanceDetectorOptions options = write ("whole.pb", whole);
  options.config = write ("text.pbtxt", "node { name: \"a\" op: \"Conv2D\" }\n").model;
  failure (options);
}

TEST_F (DamagedNetworks, NoProcessAndNoFileIsLeft)
{
  const std::size_t before = openFiles ();
  {
    InstanceDetector first (good ()), second (good ());
    EXPECT_THROW (InstanceDetector detector (crashing ()), IoError);
    EXPECT_EQ (first.detect (test::spotPicture (8, 6)).size (), 1u);
    second = std::move (first);
    EXPECT_EQ (second.detect (test::spotPicture (8, 6)).size (), 1u);
    EXPECT_FALSE (hasNoChildren ());
  }
  EXPECT_TRUE (hasNoChildren ());
  EXPECT_EQ (openFiles (), before);
}

TEST_F (DamagedNetworks, ProgramsMayTakeTheEndOfProcessesForThemselves)
{
  const auto before = std::signal (SIGCHLD, SIG_IGN);
  EXPECT_NE (failure (crashing ()).find ("OpenCV c"), std::string::npos);
  EXPECT_EQ (InstanceDetector (good ()).detect (test::spotPicture (8, 6)).size (), 1u);
  std::signal (SIGCHLD, before);
  EXPECT_TRUE (hasNoChildren ());
}

TEST_F (DamagedNetworks, ThreadsMayHaveNetworksOfTheirOwn)
{
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP () << "a process that is made while other threads allocate waits for ever in the sanitizer's allocator";
#endif
  const InstanceDetectorOptions options = good (), damaged = crashing ();
  std::vector<std::thread> threads;
  std::vector<int> found (4, 0);
  for (int& count : found)
    threads.emplace_back ([&] {
      for (int n = 0; n < 5; ++n)
      {
        EXPECT_THROW (InstanceDetector detector (damaged), IoError);
        count += static_cast<int> (InstanceDetector (options).detect (test::spotPicture (8, 6)).size ());
      }
    });
  for (std::thread& thread : threads)
    thread.join ();
  EXPECT_EQ (found, std::vector<int> (4, 5));
}

TEST_F (DamagedNetworks, NetworksMayHaveThreads)
{
  // OpenCV has run some in this process before, which the other process does not have.
  const int before = cv::getNumThreads ();
  cv::setNumThreads (2);
  cv::parallel_for_ ({0, 100}, [] (const cv::Range&) {});
  InstanceDetectorOptions options = good ();
  options.threads = 2;
  EXPECT_EQ (InstanceDetector (options).detect (test::spotPicture (8, 6)).size (), 1u);
  cv::setNumThreads (before);
}

TEST_F (DamagedNetworks, ChildrenSayHowTheyEnded)
{
  const auto signalOf = [] (const std::function<void (Channel&)>& work) {
    ChildProcess child (work);
    char byte = 0;
    EXPECT_FALSE (child.channel ().receive (&byte, 1));
    return (child.waitForEnd ());
  };
  EXPECT_EQ (signalOf ([] (Channel&) {}), 0);
  EXPECT_EQ (signalOf ([] (Channel&) { throw 1; }), 0);
  EXPECT_EQ (signalOf ([] (Channel&) { std::abort (); }), SIGABRT);
  EXPECT_EQ (signalOf ([] (Channel&) {
               limitProcessorTime (0.0);
               for (volatile unsigned int n = 0; true;)
                 n = n + 1;
             }),
             SIGXCPU);
  ChildProcess child ([] (Channel& to_parent) {
    std::raise (SIGINT); // is for the parent
    to_parent.send ("x", 1);
    pause ();
  });
  char byte = 0;
  EXPECT_TRUE (child.channel ().receive (&byte, 1));
  EXPECT_EQ (byte, 'x');
}
