// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/segmentation/instance_segmentation.h>

#include <pcl/point_types.h>

#include <iostream>

using namespace pcl::cosection;

/** \brief A network that is not there. */
int
main ()
{
  InstanceDetectorOptions network;
  network.model = "absent.onnx";
  InstanceSegmentation<pcl::PointXYZRGB> segmentation;
  try
  {
    segmentation.setNetwork (network);
  }
  catch (const IoError& error)
  {
    std::cout << error.what () << '\n';
    return (0);
  }
  return (1);
}
