// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Networks of the learned prior, and files that hold no such network.

#include <pcl/cosection/surface/options.h>

#include "common/temporary_folder.h"
#include "onnx_messages.h"

#include <pcl/cosection/common/error.h>

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

using namespace pcl::cosection;
using test::OnnxGraph;

namespace {

constexpr int size = CompletionNetwork::size;
constexpr int channels = CompletionNetwork::channels * size;

/** \brief A network of one convolution with a kernel of 1 x 1. */
OnnxGraph
network (int inputs, int outputs)
{
  OnnxGraph graph;
  graph.input ("observed", {1, inputs, size, size}).weights ("kernel", {outputs, inputs, 1, 1});
  graph.node ("Conv", {"observed", "kernel"}, {"occupied"}, {OnnxGraph::attribute ("kernel_shape", {1, 1})});
  graph.output ("occupied", {1, outputs, size, size});
  return graph;
}

class CompletionNetworks : public testing::Test
{
protected:
  std::string write (const std::string& name, const std::string& bytes) const
  {
    std::ofstream (folder_.file (name), std::ios::binary) << bytes;
    return folder_.file (name);
  }

  std::string wrongWith (const std::string& name, const std::string& bytes) const
  {
    try
    {
      loadCompletionNetwork (write (name, bytes));
    }
    catch (const IoError& error)
    {
      return error.what ();
    }
    return "";
  }

private:
  test::TemporaryFolder folder_;
};

std::vector<float>
nothing ()
{
  return std::vector<float> (static_cast<std::size_t> (channels) * size * size);
}

} // namespace

TEST_F (CompletionNetworks, AnswersAreThoseOfTheWeights)
{
  std::vector<float> observed = nothing ();
  observed[5] = 1.0f;
  const auto loaded = loadCompletionNetwork (write ("other.onnx", network (channels, size).bytes ()));
  const std::vector<float> logits = loaded->complete (observed);
  ASSERT_EQ (logits.size (), static_cast<std::size_t> (size) * size * size);
  EXPECT_NEAR (logits[5], 0.1f, 1e-6f); // the first weight
  EXPECT_EQ (logits[6], 0.0f);
  EXPECT_EQ (loaded->complete (observed), logits);
}

TEST_F (CompletionNetworks, WeightsMayBeOfHalfPrecision)
{
  std::string weights;
  for (int n = 0; n < size * channels; ++n)
    weights += std::string ("\x00\x3c", 2); // 1
  OnnxGraph graph;
  constexpr int half = 10;
  graph.input ("observed", {1, channels, size, size}).tensor ("kernel", {size, channels, 1, 1}, half, weights);
  graph.node ("Conv", {"observed", "kernel"}, {"occupied"}, {OnnxGraph::attribute ("kernel_shape", {1, 1})});
  graph.output ("occupied", {1, size, size, size});
  std::vector<float> observed = nothing ();
  observed[5] = 0.5f;
  EXPECT_EQ (loadCompletionNetwork (write ("half.onnx", graph.bytes ()))->complete (observed)[5], 0.5f);
}

TEST_F (CompletionNetworks, FilesThatAreNoneAreRefusedWithTheReason)
{
  EXPECT_THROW (loadCompletionNetwork ("/nowhere/completion.onnx"), IoError);
  EXPECT_NE (wrongWith ("text.onnx", "not a network").find ("ONNX file"), std::string::npos);
  EXPECT_NE (wrongWith ("empty.onnx", "").find ("network"), std::string::npos);
  EXPECT_NE (wrongWith ("model.pb", "x").find (".onnx"), std::string::npos);
  EXPECT_NE (wrongWith ("few.onnx", network (channels, 16).bytes ()).find ("1 x 32 x 32 x 32"), std::string::npos);
  EXPECT_NE (wrongWith ("picture.onnx", network (3, size).bytes ()), "");
  const std::string whole = network (channels, size).bytes ();
  EXPECT_NE (wrongWith ("half.onnx", whole.substr (0, whole.size () / 2)), "");
}
