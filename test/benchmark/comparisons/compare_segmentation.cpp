// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// compare_segmentation FILE.pcd ...: how well segmentObjects () finds the objects of labelled organised clouds, and how
// fast.

#include "segmentation/label_comparison.h"

#include <pcl/cosection/segmentation/geometric_segmentation.h>

#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>

using namespace pcl::cosection;

namespace {

constexpr int repetitions = 3;

struct LabelledImage
{
  int width = 0;
  int height = 0;
  std::vector<Eigen::Vector3f> points;
  std::vector<std::uint32_t> labels;
  std::vector<char> valid;
};

LabelledImage
readImage (const char* path)
{
  LabelledImage image;
  pcl::PointCloud<pcl::PointXYZL> cloud;
  if (!std::filesystem::is_regular_file (path) || pcl::io::loadPCDFile (path, cloud) != 0 || !cloud.isOrganized ())
    return (image);
  image.width = static_cast<int> (cloud.width);
  image.height = static_cast<int> (cloud.height);
  for (const pcl::PointXYZL& p : cloud)
  {
    image.points.push_back (p.getVector3fMap ());
    image.labels.push_back (p.label);
    image.valid.push_back (std::isfinite (p.z));
  }
  return (image);
}

} // namespace

int
main (int argc, char** argv)
{
  std::printf ("%-24s %7s %6s %9s %11s %8s %8s\n", "view", "objects", "found", "mean IoU", "background", "wall ms",
               "CPU ms");
  double iou_sum = 0.0, wall_sum = 0.0, cpu_sum = 0.0;
  int objects = 0, views = 0;
  for (int k = 1; k < argc; ++k)
  {
    const LabelledImage image = readImage (argv[k]);
    if (image.points.empty ())
    {
      std::fprintf (stderr, "%s: is no organised cloud\n", argv[k]);
      return (1);
    }
    ObjectSegmentation found;
    double wall_ms = 1e9, cpu_ms = 1e9;
    for (int n = 0; n < repetitions; ++n)
    {
      const auto start = std::chrono::steady_clock::now ();
      const std::clock_t cpu_start = std::clock ();
      found = segmentObjects (image.points, image.width, image.height);
      cpu_ms = std::min (cpu_ms, 1e3 * static_cast<double> (std::clock () - cpu_start) / CLOCKS_PER_SEC);
      wall_ms = std::min (
          wall_ms, std::chrono::duration<double, std::milli> (std::chrono::steady_clock::now () - start).count ());
    }
    const test::LabelComparison comparison = test::compareLabels (image.labels, found.labels, image.valid);
    std::printf ("%-24s %7zu %6u %9.3f %11zu %8.0f %8.0f\n", std::filesystem::path (argv[k]).stem ().c_str (),
                 comparison.best_iou.size (), found.objects, comparison.mean_iou, comparison.background_pixels, wall_ms,
                 cpu_ms);
    for (const auto& [object, iou] : comparison.best_iou)
      iou_sum += iou;
    objects += static_cast<int> (comparison.best_iou.size ());
    wall_sum += wall_ms;
    cpu_sum += cpu_ms;
    ++views;
  }
  if (objects > 0)
    std::printf ("mean IoU of %d objects %.3f, %.1f views/s (%.0f ms CPU each)\n", objects, iou_sum / objects,
                 1e3 * views / wall_sum, cpu_sum / views);
  return (0);
}
