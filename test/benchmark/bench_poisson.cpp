// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "volume/analytic_fields.h"

#include "completion/analytic_scene.h"

#include <pcl/cosection/surface/hessian_imls.h>

#include <benchmark/benchmark.h>

#include <pcl/PolygonMesh.h>
#include <pcl/point_types.h>
#include <pcl/surface/poisson.h>

#include <cmath>
#include <random>
#include <thread>

// 100,000 oriented points from all around an object to a mesh: pcl::Poisson at depth 6, which is 64 cells
// a side, beside HessianIMLS.

using namespace pcl::cosection;

namespace {

using Cloud = pcl::PointCloud<pcl::PointNormal>;

constexpr int point_count = 100000;
constexpr double radius_m = 0.1;

/** \brief A ball with dents and bumps. */
double
potato (const Eigen::Vector3d& p)
{
  const Eigen::Vector3d d = p.normalized ();
  return p.norm () - radius_m * (1.0 + 0.1 * std::sin (4.0 * d.x ()) * std::sin (5.0 * d.y () + 1.0) *
                                           std::sin (3.0 * d.z () + 1.0));
}

Cloud::ConstPtr
points ()
{
  static const Cloud::ConstPtr value = [] {
    std::mt19937 generator (1);
    std::normal_distribution<double> gauss;
    auto cloud = pcl::make_shared<Cloud> ();
    for (int i = 0; i < point_count; ++i)
    {
      const Eigen::Vector3d d = Eigen::Vector3d (gauss (generator), gauss (generator), gauss (generator)).normalized ();
      const Eigen::Vector3d p = d * (radius_m - potato (radius_m * d));
      pcl::PointNormal point;
      point.getVector3fMap () = p.cast<float> ();
      point.getNormalVector3fMap () = test::gradient (potato, p).cast<float> ();
      cloud->push_back (point);
    }
    return cloud;
  }();
  return value;
}

double
longestSide ()
{
  Eigen::AlignedBox3f box;
  for (const auto& p : *points ())
    box.extend (p.getVector3fMap ());
  return box.sizes ().maxCoeff ();
}

void
poisson (benchmark::State& state)
{
  pcl::Poisson<pcl::PointNormal> method;
  method.setInputCloud (points ());
  method.setDepth (6);
  method.setThreads (static_cast<int> (state.range (0)));
  pcl::PolygonMesh mesh;
  for (auto _ : state)
    method.reconstruct (mesh);
  state.counters["triangles"] = static_cast<double> (mesh.polygons.size ());
}

void
reconstruct (benchmark::State& state, HessianIMLS<pcl::PointNormal>& imls)
{
  imls.setInputCloud (points ());
  pcl::PolygonMesh mesh;
  for (auto _ : state)
    imls.reconstruct (mesh);
  state.counters["triangles"] = static_cast<double> (mesh.polygons.size ());
  state.counters["longest_axis"] = imls.getSignedDistance () ? imls.getSignedDistance ()->grid.dims.maxCoeff () : 0;
}

/** \brief 64 voxels along the volume, as Poisson's octree has 64 cells. */
void
hessianImls64Volume (benchmark::State& state)
{
  HessianIMLS<pcl::PointNormal> imls;
  // The volume is the object, less its outermost points, with the padding and two voxels more on each
  // side; values lie on its borders, too.
  CoSectionOptions options = imls.getOptions ();
  options.padding = 0.3;
  options.voxel_size_m = (1.0 + 2.0 * options.padding) * longestSide () / 60.0;
  imls.setOptions (options);
  reconstruct (state, imls);
}

/** \brief 64 voxels along the object, the default. */
void
hessianImls64Object (benchmark::State& state)
{
  HessianIMLS<pcl::PointNormal> imls;
  imls.setResolution (64);
  reconstruct (state, imls);
}

} // namespace

BENCHMARK (poisson)
    ->Arg (1)
    ->Arg (std::max (1u, std::thread::hardware_concurrency ()))
    ->Unit (benchmark::kSecond)
    ->UseRealTime ();
BENCHMARK (hessianImls64Volume)->Unit (benchmark::kSecond)->UseRealTime ();
BENCHMARK (hessianImls64Object)->Unit (benchmark::kSecond)->UseRealTime ();
