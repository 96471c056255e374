// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
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
  std::cout << "a network that is not there:\n";
  return segmentation.setNetwork (network) ? 1 : 0;
}
