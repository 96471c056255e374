// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/surface/co_section.h>

#include <cmath>

namespace pcl::cosection::test {

/** \brief Half balls of 3 cm radius in rows of eight, 10 cm apart: of few points, and each with few neighbours. */
inline SceneResult
completeManyBalls (int count, int threads)
{
  constexpr int points = 110;
  const double golden = M_PI * (3.0 - std::sqrt (5.0));
  CoSectionOptions options;
  options.threads = threads;
  CoSection scene (options);
  for (int o = 0; o < count; ++o)
  {
    ObjectInput object;
    object.id = o + 1;
    const Eigen::Vector3f middle (0.1f * static_cast<float> (o % 8), 0.1f * static_cast<float> (o / 8), 1.0f);
    for (int i = 0; i < points; ++i)
    {
      const double z = (i + 0.5) / points, across = std::sqrt (1.0 - z * z), turn = golden * i + o; // no two alike
      OrientedPoint point;
      point.normal = Eigen::Vector3d (across * std::cos (turn), across * std::sin (turn), -z).cast<float> ();
      point.position = middle + 0.03f * point.normal;
      object.points.push_back (point);
    }
    scene.addObject (std::move (object));
  }
  return scene.reconstruct ();
}

} // namespace pcl::cosection::test
