// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <cstdint>

namespace pcl
{
namespace cosection
{

/** \brief Label of a pixel that shows neither an object nor the background, a person for example: nothing is tracked by it, it is in no
 * model, and it is never completed. */
constexpr std::uint16_t ignored_label = 65535;

} // namespace cosection
} // namespace pcl
