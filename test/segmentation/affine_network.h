// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <string>
#include <vector>

namespace pcl::cosection::test {

/** \brief An output that is an affine function of a network's input of 1 x 3 x height x width values, row by row. */
struct AffineOutput
{
  std::string name;
  std::vector<std::int64_t> shape;
  Eigen::MatrixXf weights; ///< values of the output x values of the input
  Eigen::VectorXf bias;    ///< values of the output
};

/** \brief The bytes of an ONNX file with a network of such outputs. \param[in] fixed_size the file fixes the size of
 * the input */
std::string affineOnnx (int width, int height, const std::vector<AffineOutput>& outputs, bool fixed_size = true);

/** \brief The bytes of a frozen graph of TensorFlow with a network of such outputs. They have at most three dimensions,
 * as OpenCV may reorder four. */
std::string affineTensorflow (int width, int height, const std::vector<AffineOutput>& outputs);

} // namespace pcl::cosection::test
