// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Follow an object of known shape, a box of 10 x 14 x 20 cm, through three clouds of three of its faces.
#include <pcl/cosection/tracking/sdf_tracker.h>

#include <pcl/point_types.h>

#include <array>
#include <iostream>

int
main ()
{
  auto box = std::make_shared<pcl::cosection::SignedDistanceField> (); // of 64^3 voxels of 5 mm
  box->grid = {Eigen::Vector3i::Constant (64), 0.005, Eigen::Vector3d::Constant (-0.1575)};
  for (int n = 0; n < 64 * 64 * 64; ++n) // x varies fastest
  {
    const Eigen::Vector3d center = box->grid.center (n % 64, n / 64 % 64, n / 4096);
    const Eigen::Array3d q = center.array ().abs () - Eigen::Array3d (0.05, 0.07, 0.1);
    box->values.push_back (static_cast<float> (q.max (0.0).matrix ().norm () + std::min (0.0, q.maxCoeff ())));
  }

  pcl::cosection::SdfTracker<pcl::PointXYZ> tracker;
  tracker.setSignedDistance (box);
  tracker.setTrans (Eigen::Affine3f (Eigen::Translation3f (0.0f, 0.0f, 1.0f))); // T_sensor_object, roughly
  for (int frame = 1; frame <= 3; ++frame)
  {
    const float x = 0.01f * static_cast<float> (frame); // it moves by 1 cm per frame
    auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>> ();
    for (float s = -0.95f; s < 1.0f; s += 0.1f)
      for (float t = -0.95f; t < 1.0f; t += 0.1f)
        for (const auto& [a, b, c] : {std::array<float, 3>{s, t, -1.0f}, {1.0f, s, t}, {s, -1.0f, t}})
          cloud->push_back ({x + 0.05f * a, 0.07f * b, 1.0f + 0.1f * c});
    tracker.setInputCloud (cloud);
    tracker.compute ();
    std::cout << tracker.getPose ().translation ().transpose () << (tracker.isLost () ? " lost\n" : " m\n");
  }
}
