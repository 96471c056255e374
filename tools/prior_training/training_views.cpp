// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "training_views.h"

#include "pcl_cosection/mesh/moved_mesh.h"
#include "pcl_cosection/simulation/table_scenes.h"
#include "pcl_cosection/view/look_at.h"
#include <pcl/cosection/rendering/rasterizer.h>
#include <pcl/cosection/simulation/simulated_scene.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr int width = 160, height = 120; // pixels around the object; a sensor's picture shows more
constexpr std::size_t least_points = 80;
constexpr int most_views = 3;
constexpr double kinect_focal_px = 525.0;

/** \brief A shape in the world. */
struct Placed
{
  const TrainingShape* shape;
  Eigen::Affine3d T_world_shape;
  double radius_m; // around the vertical axis
  double height_m;
};

/** \brief How a thing stands: mostly as it was modelled, on a side or the head, or leaning against something. */
Eigen::Matrix3d
randomRotation (RandomNumbers& random)
{
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity ();
  const double kind = random.in (0.0, 1.0);
  if (kind < 0.4) // on any side
    R = Eigen::AngleAxisd (M_PI_2 * random.below (4), Eigen::Vector3d::Unit (random.below (2))).toRotationMatrix ();
  else if (kind < 0.55)
    R = Eigen::Quaterniond (random.normal (), random.normal (), random.normal (), random.normal ())
            .normalized ()
            .toRotationMatrix ();
  return Eigen::AngleAxisd (random.in (0.0, 2.0 * M_PI), Eigen::Vector3d::UnitZ ()).toRotationMatrix () * R;
}

Placed
standing (const TrainingShape& shape, double size_m, RandomNumbers& random)
{
  Placed placed{&shape, Eigen::Affine3d::Identity (), 0.0, 0.0};
  Eigen::Vector3d stretch;
  for (int axis = 0; axis < 3; ++axis)
    stretch[axis] = size_m * random.in (0.85, 1.15);
  if (random.chance (0.5)) // mirrored
    stretch.x () = -stretch.x ();
  placed.T_world_shape.linear () = randomRotation (random) * stretch.asDiagonal ();
  double lowest = std::numeric_limits<double>::infinity (), highest = -lowest;
  for (const Eigen::Vector3f& vertex : shape.mesh ().vertices)
  {
    const Eigen::Vector3d p = placed.T_world_shape * vertex.cast<double> ();
    lowest = std::min (lowest, p.z ());
    highest = std::max (highest, p.z ());
    placed.radius_m = std::max (placed.radius_m, p.head<2> ().norm ());
  }
  placed.T_world_shape.translation ().z () = -lowest;
  placed.height_m = highest - lowest;
  return placed;
}

TriangleMesh
meshOf (const Placed& placed)
{
  return movedMesh (placed.shape->mesh (), placed.T_world_shape);
}

TriangleMesh
table (double half_m)
{
  TriangleMesh mesh;
  const auto h = static_cast<float> (half_m);
  mesh.vertices = {{-h, -h, 0.0f}, {h, -h, 0.0f}, {h, h, 0.0f}, {-h, h, 0.0f}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

/** \brief Shining and dark spots have no reading. */
void
makeHoles (std::vector<float>& depth, RandomNumbers& random)
{
  for (int n = 1 + random.below (4); n > 0; --n)
  {
    const double u = random.in (0.25 * width, 0.75 * width), v = random.in (0.2 * height, 0.8 * height);
    const double a = random.in (2.0, 14.0), b = random.in (2.0, 14.0);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        if (std::pow ((x - u) / a, 2) + std::pow ((y - v) / b, 2) < 1.0)
          depth[static_cast<std::size_t> (y) * width + x] = std::numeric_limits<float>::quiet_NaN ();
  }
}

constexpr int table_label = 0, object_label = 1; // others follow

/** \brief A measured view, and to what its pixels are said to belong. */
struct Measured
{
  DepthView view;
  Image<std::uint16_t> labels;
};

Measured
measure (const std::vector<TriangleMesh>& bodies, const Placed& object, double azimuth, RandomNumbers& random)
{
  const double size_m = std::max (2.0 * object.radius_m, object.height_m);
  const double elevation = random.in (0.17, 1.4);
  const double distance = std::max (random.logIn (0.4, 1.6), 1.6 * size_m);
  const Eigen::Vector3d target (size_m * random.in (-0.2, 0.2), size_m * random.in (-0.2, 0.2),
                                object.height_m * random.in (0.2, 0.8));
  const Eigen::Vector3d eye = target + distance * Eigen::Vector3d (std::cos (elevation) * std::cos (azimuth),
                                                                   std::cos (elevation) * std::sin (azimuth),
                                                                   std::sin (elevation));
  Measured measured;
  DepthView& view = measured.view;
  const double focal = random.in (25.0, 100.0) * distance / size_m;
  view.camera = {width, height, focal, focal, 0.5 * (width - 1), 0.5 * (height - 1)};
  view.T_world_sensor = lookAt (eye, target);
  Rasterizer rasterizer (view.camera, view.T_world_sensor);
  for (std::size_t n = 0; n < bodies.size (); ++n)
    rasterizer.draw (bodies[n], table_label + static_cast<int> (n));
  const RasterImage& image = rasterizer.image ();
  Image<float> depth (width, height);
  depth.pixels = image.depth;
  DepthNoise noise;
  noise.baseline_m *= kinect_focal_px / focal / random.logIn (0.5, 4.0); // errors of several sensors, in metres
  noise.lateral_sigma_px *= std::min (1.0, focal / kinect_focal_px) * random.in (0.5, 1.5);
  noise.edge_dropout = random.in (0.0, 0.6);
  noise.shadows = random.chance (0.5);
  noise.min_m = 0.05;
  if (random.chance (0.5))
    noise.disparity_step_px = 0.0;
  view.depth = measureDepth (depth, image.normals, view.camera, noise, random.seed (), 0).pixels;
  if (random.chance (0.25))
    makeHoles (view.depth, random);
  measured.labels = Image<std::uint16_t> (width, height, 0);
  std::copy (image.ids.begin (), image.ids.end (), measured.labels.pixels.begin ());
  if (random.chance (0.35))
    measured.labels = withMaskErrors (std::move (measured.labels), random.below (4) - 1, random.below (3) - 1);
  return measured;
}

} // namespace

std::optional<TrainingSample>
randomSample (const TrainingShape& shape, const std::vector<const TrainingShape*>& others, RandomNumbers& random)
{
  const double size_m = random.logIn (0.04, 0.4);
  const Placed object = standing (shape, size_m, random);
  std::vector<TriangleMesh> bodies = {table (20.0 * size_m), meshOf (object)};
  for (const TrainingShape* other : others)
  {
    Placed placed = standing (*other, size_m * random.logIn (0.4, 1.6), random);
    const double angle = random.in (0.0, 2.0 * M_PI);
    placed.T_world_shape.translation ().head<2> () = (object.radius_m + placed.radius_m) * random.in (0.8, 1.4) *
                                                     Eigen::Vector2d (std::cos (angle), std::sin (angle));
    bodies.push_back (meshOf (placed));
  }
  const int count = random.chance (0.75) ? 1 : 2 + random.below (most_views - 1);
  std::vector<Measured> measured;
  double azimuth = random.in (0.0, 2.0 * M_PI);
  for (int n = 0; n < count; ++n, azimuth += random.in (0.4, 2.0))
    measured.push_back (measure (bodies, object, azimuth, random));

  SensorViews views;
  std::vector<OrientedPoint> points;
  for (const Measured& each : measured)
  {
    const std::size_t before = points.size ();
    for (int v = 0; v < height; ++v)
      for (int u = 0; u < width; ++u)
        if (const float z = each.view.at (u, v); each.labels.at (u, v) == object_label && z > 0.0f)
          points.push_back ({(each.view.T_world_sensor * each.view.camera.unproject (u, v, z)).cast<float> (),
                             Eigen::Vector3f::Zero ()});
    if (points.size () > before)
      views.emplace_back (&each.view, each.view.T_world_sensor);
  }
  if (points.size () < least_points)
    return std::nullopt;
  // The table is found a little too high or too low, and a little tilted.
  const double tilt = random.chance (0.5) ? 0.01 * random.normal () : 0.0;
  const Eigen::Vector3d up = Eigen::AngleAxisd (tilt, Eigen::Vector3d::UnitX ()) * Eigen::Vector3d::UnitZ ();
  const auto cube = completionCube (points, views, {up.x (), up.y (), up.z (), 0.002 * random.normal ()});
  if (!cube)
    return std::nullopt;
  TrainingSample sample;
  sample.inputs = completionInputs (*cube, points, views);
  sample.distance_vox.resize (CompletionCube::voxels);
  const Eigen::Affine3d T_shape_world = object.T_world_shape.inverse ();
  for (int k = 0; k < CompletionCube::size; ++k)
    for (int j = 0; j < CompletionCube::size; ++j)
      for (int i = 0; i < CompletionCube::size; ++i)
        sample.distance_vox[CompletionCube::index (i, j, k)] = static_cast<float> (
            size_m * shape.distance (T_shape_world * cube->center (i, j, k)) / cube->voxel_size_m);
  return sample;
}

} // namespace pcl::cosection
