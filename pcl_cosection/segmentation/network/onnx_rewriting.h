// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief An ONNX file whose weights are of single precision, where they were of half: OpenCV reads no others.
 * \param[in] bytes of a file that checkOnnx () has nothing against */
std::string inSinglePrecision (const std::string& bytes);

/** \brief The names of the outputs of a file that says of its input that it has so many dimensions, and leaves one of
 * them open; nothing of others.
 * \param[in] bytes of a file that checkOnnx () has nothing against */
std::optional<std::vector<std::string>> outputsOfOpenInput (const std::string& bytes, int dimensions);

/** \brief An ONNX file that says the size of its input, where it left it open: from it, OpenCV knows while it reads
 * what products and changes of shape get, which versions from 4.7 on insist on.
 * \param[in] bytes of a file that checkOnnx () has nothing against \param[in] shape of the input, all dimensions */
std::string withInputShape (const std::string& bytes, const std::vector<int>& shape);

} // namespace pcl::cosection
