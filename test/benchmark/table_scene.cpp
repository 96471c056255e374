// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "table_scene.h"

#include "pcl_cosection/energy/constraints/hull_constraint.h"
#include "pcl_cosection/energy/constraints/intersection_constraint.h"
#include "pcl_cosection/energy/data/imls_data_term.h"
#include "pcl_cosection/priors/extent_prior.h"
#include "pcl_cosection/volume/distance_transform.h"

#include <algorithm>

namespace pcl::cosection::benchmark_scenes {
namespace {

constexpr double volume_edge_m = 0.35;
constexpr double observed_weight = 0.3;       // sum of weights that makes a voxel one with data
constexpr double pixels_per_voxel_edge = 6.0; // of the whole image
constexpr double focal_length_per_width = 1.25;

} // namespace

TableScene
makeTableScene (int resolution)
{
  TableScene scene;
  scene.grid.dims.setConstant (resolution);
  scene.grid.voxel_size_m = volume_edge_m / resolution;
  const Eigen::Vector3d centre (0.0, 0.0, 0.1);
  scene.grid.origin_m = centre - Eigen::Vector3d::Constant (0.5 * scene.grid.voxel_size_m * (resolution - 1));

  const test::Distance box = test::placed (test::box ({0.08, 0.06, 0.05}), Eigen::Vector3d (0.0, 0.0, 0.05));
  const test::Distance ball = test::placed (test::sphere (0.06), Eigen::Vector3d (0.01, 0.0, 0.15));
  test::AnalyticScene bodies;
  bodies.add (0, test::halfSpace (scene.table));
  bodies.add (1, [=] (const Eigen::Vector3d& p) { return std::min (box (p), ball (p)); });

  PinholeCamera camera;
  camera.width = camera.height = static_cast<int> (pixels_per_voxel_edge * resolution);
  camera.fx = camera.fy = focal_length_per_width * camera.width;
  camera.cx = camera.cy = 0.5 * (camera.width - 1);
  scene.seen = bodies.render (camera, lookAt ({0.5, -0.4, 0.5}, centre));
  return scene;
}

EnergyProblem
makeEnergyProblem (const TableScene& scene, const CoSectionOptions& options)
{
  const VoxelGrid& grid = scene.grid;
  const std::vector<OrientedPoint>& points = scene.seen.points.at (1);
  const DepthView& view = scene.seen.view;
  EnergyProblem problem;
  problem.dims = grid.dims;
  problem.alpha = options.alpha;

  ImlsDataTerm data;
  data.add (grid, points, options.sigma_vox);
  std::vector<std::uint8_t> observed (grid.size ());
  for (std::size_t n = 0; n < grid.size (); ++n)
    observed[n] = data.weight[n] >= observed_weight;
  data.finish (options.weighting);
  problem.weight = std::move (data.weight);
  problem.weighted_target = std::move (data.weighted_target);

  HullConstraint hull (grid);
  hull.add (FreeSpaceView (view), view.T_world_sensor);
  const std::vector<std::uint8_t> free_space = hull.freeSpace (options.revise_votes);
  const std::vector<float> hull_distance = hullDistance (grid.dims, free_space);
  const std::vector<float> extent = ExtentPrior ().bounds (grid, distanceTransform (grid.dims, observed), points,
                                                           {{&view, view.T_world_sensor}});
  problem.exterior.resize (grid.size ());
  for (std::size_t n = 0; n < grid.size (); ++n)
    if (free_space[n])
    {
      problem.weight[n] = problem.weighted_target[n] = 0.0f;
      problem.exterior[n] = LowerBound (hull_distance[n], static_cast<float> (options.beta_hull));
    }
    else if (extent[n] > 0.0f)
      problem.exterior[n] = LowerBound (extent[n], static_cast<float> (options.beta_extent));

  IntersectionConstraint intersection (grid, options.max_bound_vox);
  intersection.addHalfSpace (scene.table, free_space, options.beta_inter);
  problem.intersection = intersection.bounds ();
  return problem;
}

} // namespace pcl::cosection::benchmark_scenes
