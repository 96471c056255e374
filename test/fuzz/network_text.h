// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace fuzz {

/** \brief A network of many operators, as a text that onnxFromText () understands. */
std::string networkText ();

/** \brief An ONNX file whose encoding is whole, whatever its network is. Each line is an input, output or tensor, its
 * name and its sizes; "integers" or "scalar", a name and values; or an operator, its inputs, ">", its outputs, and
 * attributes as strides=1,1. Other lines are nodes as well. */
std::string onnxFromText (const std::string& text);

} // namespace fuzz
