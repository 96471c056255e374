// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/common/image.h>

#include <cstddef>
#include <string>

namespace pcl::cosection {

/** \throws InvalidArgument unless an image has the size of the camera's, and as many pixels */
template <typename Pixel>
void
requireSizeOf (const PinholeCamera& camera, const Image<Pixel>& image, const std::string& what)
{
  if (image.width != camera.width || image.height != camera.height)
    throw InvalidArgument (what + " has " + std::to_string (image.width) + " x " + std::to_string (image.height) +
                           " pixels, the camera " + std::to_string (camera.width) + " x " +
                           std::to_string (camera.height));
  if (image.pixels.size () != static_cast<std::size_t> (image.width) * image.height)
    throw InvalidArgument (what + " holds " + std::to_string (image.pixels.size ()) + " pixels, but its size is " +
                           std::to_string (image.width) + " x " + std::to_string (image.height));
}

} // namespace pcl::cosection
