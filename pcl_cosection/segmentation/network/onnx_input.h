// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <optional>
#include <string>

namespace pcl::cosection
{

struct InputSize
{
  int width = 0;  ///< pixels
  int height = 0; ///< pixels
};

/** \brief The size of image that an ONNX network is made for, which OpenCV does not tell.
 * \param[in] model the bytes of the file, which may be any
 * \return nothing if they are none of an ONNX file, or its first input is no 1 x channels x height x width of fixed
 * height and width */
std::optional<InputSize> onnxInputSize (const std::string& model);

} // namespace pcl::cosection
