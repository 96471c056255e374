// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/io/rgbd_sequence.h>

#include <string>

namespace pcl::cosection {

/** \brief "640 x 480 pixels" */
std::string sizeText (int width, int height);

/** \brief "1 and 2" */
std::string pairText (double a, double b);

/** \brief What is implausible about a camera, whose size may be 0 (unknown); empty if nothing is. */
std::string implausibleIntrinsics (const PinholeCamera& camera);

/** \brief How far a principal point is from the middle of an image, of its size. */
double offCentre (const PinholeCamera& camera, const ImageSize& image);

/** \brief The camera of images of another resolution. */
PinholeCamera scaled (const PinholeCamera& camera, const ImageSize& from, const ImageSize& to);

} // namespace pcl::cosection
