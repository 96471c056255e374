// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <string>
#include <vector>

namespace pcl::cosection::test
{

/** \brief An output that is an affine function of a network's input, which is 1 x 3 x height x width, row by row. */
struct AffineOutput
{
  std::string name;
  std::vector<std::int64_t> shape;
  Eigen::MatrixXf weights; ///< values of the output x values of the input
  Eigen::VectorXf bias;    ///< values of the output
};

/** \brief The bytes of an ONNX file with a network of such outputs. \param[in] fixed_size the file says the size of the
 * input */
std::string affineOnnx (int width, int height, const std::vector<AffineOutput>& outputs, bool fixed_size = true);

/** \brief The bytes of a frozen graph of TensorFlow with a network of such outputs, which have no more than three
 * dimensions: of four, OpenCV may reorder them. */
std::string affineTensorflow (int width, int height, const std::vector<AffineOutput>& outputs);

} // namespace pcl::cosection::test
