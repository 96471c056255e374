// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "affine_network.h"

#include <pcl/cosection/common/image.h>
#include <pcl/cosection/segmentation/instance_detector.h>

#include <array>
#include <string>
#include <vector>

namespace pcl::cosection::test {

/** \brief Networks that find a spot of one colour and known size in the first channel of an image of 24 x 16 pixels.
 * They give it class 2 of 3, with a score of 0.9. */
struct SpotNetwork
{
  static constexpr int width = 24, height = 16;
  static constexpr int spot_width = 6, spot_height = 4;

  NetworkOutputForm form;
  float brightest = 1.0f; ///< the spot's value for the network

  /** \brief The outputs. With prototypes the mask is the spot, otherwise its left half. */
  std::vector<AffineOutput> outputs () const;
};

/** \brief A one-stage network that finds all pixels of a colour as one instance of a class, with a score of 0.9.
 * \param[in] colours by class: factors of red, green and blue, 0 to 1, the sum of which is above \a threshold */
std::vector<AffineOutput> colourNetwork (int width, int height, const std::vector<Eigen::Vector3f>& colours,
                                         float threshold);

/** \brief A black picture with a spot whose first column and row are given, enlarged. */
Picture spotPicture (int left, int top, const std::array<std::uint8_t, 3>& colour = {255, 0, 0}, int enlarged = 1,
                     int width = SpotNetwork::width, int height = SpotNetwork::height);

} // namespace pcl::cosection::test
