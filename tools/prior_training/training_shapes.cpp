// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "training_shapes.h"

#include "pcl_cosection/common/directions.h"
#include "pcl_cosection/mesh/mesh_cleaning.h"
#include "pcl_cosection/mesh/moved_mesh.h"
#include "pcl_cosection/view/look_at.h"
#include "pcl_cosection/view/visibility/visibility.h"
#include "pcl_cosection/volume/mesh_distance/mesh_surface.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/common/mesh_decimation.h>
#include <pcl/cosection/io/mesh_io.h>
#include <pcl/cosection/rendering/rasterizer.h>
#include <pcl/cosection/simulation/simulated_scene.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>

namespace pcl::cosection {
namespace {

constexpr int cells = 48; // of the grid of distances
constexpr double low = -0.64;
constexpr double cell = 1.28 / cells;
constexpr double units = 16000.0;
constexpr double most_distance = 0.3;
constexpr int directions = 60; // from which a shape is carved
constexpr int picture_px = 256;
constexpr std::size_t most_triangles = 6000;
constexpr double least_thickness = 0.01;

/** \brief Depth pictures of a shape from all sides. */
class Silhouettes
{
public:
  explicit Silhouettes (const TriangleMesh& mesh)
  {
    const double distance = 4.0;
    PinholeCamera camera{picture_px, picture_px, 0.0, 0.0, 0.5 * (picture_px - 1), 0.5 * (picture_px - 1)};
    camera.fx = camera.fy = picture_px * distance / 2.2;
    for (int n = 0; n < directions; ++n)
    {
      const Eigen::Vector3d eye = distance * sphereDirection (n, directions).cast<double> ();
      DepthView view;
      view.camera = camera;
      view.T_world_sensor = lookAt (eye, Eigen::Vector3d::Zero (), eye.unitOrthogonal ());
      Rasterizer rasterizer (camera, view.T_world_sensor);
      rasterizer.draw (mesh, 1);
      view.depth = rasterizer.image ().depth;
      T_sensor_world_.push_back (view.T_world_sensor.inverse ());
      views_.push_back (std::move (view));
    }
  }

  /** \brief Whether a place can be seen from outside. */
  bool see (const Eigen::Vector3d& p) const
  {
    for (std::size_t n = 0; n < views_.size (); ++n)
    {
      const Eigen::Vector3d in_sensor = T_sensor_world_[n] * p;
      const auto pixel = pixelOf (views_[n].camera, in_sensor);
      if (!pixel)
        return true;
      const float depth = views_[n].at (pixel->x (), pixel->y ());
      if (!isReading (depth) || depth > in_sensor.z ())
        return true;
    }
    return false;
  }

private:
  std::vector<DepthView> views_;
  std::vector<Eigen::Isometry3d> T_sensor_world_;
};

/** \brief A profile from the axis to the axis; it bulges, narrows, has a neck. */
Polygon2d
turnedProfile (RandomNumbers& random)
{
  const int count = 6 + random.below (10);
  std::vector<double> radii (count);
  const double straight = random.in (0.0, 1.0);
  for (double& r : radii)
    r = straight < 0.4 ? 1.0 : random.in (0.4, 1.0);
  for (int pass = random.below (6) + 1; pass > 0; --pass)
    for (int n = 1; n + 1 < count; ++n)
      radii[n] = 0.25 * (radii[n - 1] + 2.0 * radii[n] + radii[n + 1]);
  if (random.chance (0.35)) // a neck
  {
    const int from = count / 2 + random.below (count / 2);
    const double factor = random.in (0.2, 0.7);
    for (int n = from; n < count; ++n)
      radii[n] *= factor;
  }
  if (random.chance (0.2)) // a point at the end: fruit, eggs
    for (int n = 0; n < count; ++n)
      radii[n] *= std::sqrt (std::max (0.02, 1.0 - std::pow (2.0 * n / (count - 1.0) - 1.0, 2.0)));
  const double height = random.logIn (0.3, 4.0);
  Polygon2d profile{{0.0, 0.0}};
  for (int n = 0; n < count; ++n)
    profile.emplace_back (radii[n], height * n / (count - 1.0));
  profile.emplace_back (0.0, height);
  return profile;
}

Polygon2d
vesselProfile (RandomNumbers& random)
{
  const int count = 10;
  const double height = random.logIn (0.15, 2.2), foot = random.in (0.4, 1.0), bend = random.in (0.4, 2.0);
  const double wall = random.in (0.03, 0.1), floor = wall * random.in (1.0, 2.0);
  Polygon2d outer{{0.0, 0.0}}, inner;
  for (int n = 0; n < count; ++n)
  {
    const double t = n / (count - 1.0), radius = foot + (1.0 - foot) * std::pow (t, bend);
    outer.emplace_back (radius, height * t);
    if (height * t > floor)
      inner.emplace_back (radius - wall, height * t);
  }
  if (inner.empty ())
    inner.emplace_back (1.0 - wall, height);
  const double bottom = inner.front ().x ();
  std::reverse (inner.begin (), inner.end ());
  outer.insert (outer.end (), inner.begin (), inner.end ());
  outer.emplace_back (bottom, std::min (floor, 0.9 * height));
  outer.emplace_back (0.0, std::min (floor, 0.9 * height));
  return outer;
}

Polygon2d
outline (RandomNumbers& random)
{
  Polygon2d polygon;
  if (random.chance (0.2)) // a bracket
    return {{0.0, 0.0}, {1.0, 0.0}, {1.0, 0.4}, {0.4, 0.4}, {0.4, 1.0}, {0.0, 1.0}};
  const bool regular = random.chance (0.4);
  const int count = regular ? 3 + random.below (6) : 5 + random.below (8);
  const double flat = random.in (0.3, 1.0);
  for (int n = 0; n < count; ++n)
  {
    const double angle = 2.0 * M_PI * n / count, r = regular ? 1.0 : random.in (0.6, 1.0);
    polygon.emplace_back (r * std::cos (angle), flat * r * std::sin (angle));
  }
  return polygon;
}

/** \brief |x|^a + |y|^b + |z|^a = 1: from boxes with round edges to ellipsoids. */
TriangleMesh
superquadric (RandomNumbers& random, double lowest, double highest)
{
  const double e1 = random.in (lowest, highest), e2 = random.in (lowest, highest);
  const auto power = [] (double x, double e) { return std::copysign (std::pow (std::abs (x), e), x); };
  const int around = 48, rows = 25;
  TriangleMesh mesh;
  for (int row = 0; row < rows; ++row)
    for (int n = 0; n < around; ++n)
    {
      const double u = M_PI * (row / (rows - 1.0) - 0.5), v = 2.0 * M_PI * n / around;
      const double c = power (std::max (0.0, std::cos (u)), e1);
      mesh.vertices.emplace_back (static_cast<float> (c * power (std::cos (v), e2)),
                                  static_cast<float> (c * power (std::sin (v), e2)),
                                  static_cast<float> (power (std::sin (u), e1)));
    }
  for (int row = 0; row + 1 < rows; ++row)
    for (int n = 0; n < around; ++n)
    {
      const auto a = static_cast<std::uint32_t> (row * around + n);
      const auto b = static_cast<std::uint32_t> (row * around + (n + 1) % around);
      const auto c = a + around, d = b + around;
      mesh.triangles.push_back ({a, b, d});
      mesh.triangles.push_back ({a, d, c});
    }
  const Eigen::Vector3f sizes (static_cast<float> (random.logIn (0.2, 1.0)),
                               static_cast<float> (random.logIn (0.2, 1.0)),
                               static_cast<float> (random.logIn (0.2, 1.5)));
  for (Eigen::Vector3f& vertex : mesh.vertices)
    vertex = vertex.cwiseProduct (sizes);
  return mesh;
}

TriangleMesh
randomPart (RandomNumbers& random)
{
  constexpr double chord = 0.01;
  switch (random.below (8))
  {
  case 0:
  case 1:
    return makeRevolution (turnedProfile (random))->tessellate (chord);
  case 2:
    return makeRevolution (vesselProfile (random))->tessellate (chord);
  case 3:
    return makeExtrusion (outline (random), random.logIn (0.15, 3.0))->tessellate (chord);
  case 4:
    return superquadric (random, 0.1, 1.5);
  default:
    return superquadric (random, 0.02, 0.3);
  }
}

/** \brief Its box is centred at the origin, the longest edge is 1. */
TriangleMesh
normalised (TriangleMesh mesh)
{
  const Eigen::AlignedBox3d box = vertexBox (mesh);
  const double size = box.sizes ().maxCoeff ();
  if (!(size > 0.0) || box.sizes ().minCoeff () < least_thickness * size)
    throw DegenerateInput ("the mesh is flat");
  return movedMesh (std::move (mesh),
                    Eigen::Affine3d (Eigen::Scaling (1.0 / size) * Eigen::Translation3d (-box.center ())));
}

} // namespace

TrainingShape::TrainingShape (TriangleMesh mesh) : mesh_ (normalised (std::move (mesh)))
{
  requireSurface (mesh_);
}

void
TrainingShape::prepare ()
{
  if (!distances_.empty ())
    return;
  const Silhouettes silhouettes (mesh_);
  const TriangleTree tree (mesh_);
  distances_.resize (static_cast<std::size_t> (cells) * cells * cells);
  std::size_t n = 0;
  std::uint32_t triangle = 0;
  for (int k = 0; k < cells; ++k)
    for (int j = 0; j < cells; ++j)
      for (int i = 0; i < cells; ++i, ++n)
      {
        const Eigen::Vector3d p = Eigen::Vector3d::Constant (low) + cell * Eigen::Vector3d (i + 0.5, j + 0.5, k + 0.5);
        const NearestPoint found = tree.nearest (p, most_distance, triangle);
        const bool is_far = !std::isfinite (found.squared_m2);
        if (!is_far)
          triangle = found.triangle;
        const Eigen::Vector3d nearest = p - found.offset_m;
        double distance = is_far ? most_distance : std::sqrt (found.squared_m2);
        if (!silhouettes.see (p))
          distance = -distance;
        else if (distance < 0.45 * cell && silhouettes.see (nearest + 0.8 * cell / std::max (distance, 1e-6) *
                                                                          (nearest - p))) // a wall between voxels
          distance -= 0.45 * cell;
        distances_[n] = static_cast<std::int16_t> (std::lround (distance * units));
      }
}

double
TrainingShape::distance (const Eigen::Vector3d& p) const
{
  const Eigen::Array3d at = (p.array () - low) / cell - 0.5;
  const Eigen::Array3d inside = at.max (0.0).min (cells - 1.001);
  const Eigen::Array3i first = inside.cast<int> ();
  const Eigen::Array3d part = inside - first.cast<double> ();
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner)
  {
    const Eigen::Array3i step (corner & 1, (corner >> 1) & 1, corner >> 2);
    const Eigen::Array3d weight = step.cast<double> () * part + (1 - step).cast<double> () * (1.0 - part);
    const Eigen::Array3i c = first + step;
    sum += weight.prod () * distances_[(static_cast<std::size_t> (c.z ()) * cells + c.y ()) * cells + c.x ()];
  }
  return sum / units + cell * (at - inside).matrix ().norm ();
}

TriangleMesh
randomBody (RandomNumbers& random)
{
  TriangleMesh body = normalised (randomPart (random));
  if (!random.chance (0.35))
    return body;
  TriangleMesh part = normalised (randomPart (random)); // a cap, a handle, a second body
  const Eigen::AlignedBox3d box = vertexBox (body);
  const double scale = random.in (0.2, 0.7);
  const Eigen::Vector3d off (random.in (-0.5, 0.5), random.in (-0.5, 0.5), random.in (-0.25, 0.5));
  const Eigen::Translation3d at (box.center () + box.sizes ().cwiseProduct (off));
  part = movedMesh (std::move (part), Eigen::Affine3d (at * Eigen::Scaling (scale)));
  appendMesh (body, part);
  return body;
}

std::vector<TrainingShape>
loadTrainingShapes (const std::string& folder, const std::vector<std::string>& excluded)
{
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator (folder))
  {
    const std::string extension = entry.path ().extension ();
    if (entry.is_regular_file () && (extension == ".ply" || extension == ".obj" || extension == ".stl"))
      files.push_back (entry.path ());
  }
  std::sort (files.begin (), files.end ());
  std::vector<TrainingShape> shapes;
  for (const std::string& file : files)
  {
    const std::string name = std::filesystem::path (file).filename ();
    if (std::any_of (excluded.begin (), excluded.end (),
                     [&] (const std::string& part) { return name.find (part) != std::string::npos; }))
      continue;
    try
    {
      TriangleMesh mesh = cleanMesh (loadMesh (file));
      if (std::filesystem::path (file).extension () == ".obj") // y is up
        mesh = movedMesh (std::move (mesh), Eigen::AngleAxisd (M_PI_2, Eigen::Vector3d::UnitX ()));
      if (mesh.triangles.size () > most_triangles)
        try
        {
          mesh = decimate (mesh, most_triangles);
        }
        catch (const std::exception&) // no manifold: it is drawn slowly
        {
          if (mesh.triangles.size () > 10 * most_triangles)
            throw;
        }
      shapes.emplace_back (std::move (mesh));
    }
    catch (const std::exception& error)
    {
      std::cerr << name << " is not used: " << error.what () << '\n';
    }
  }
  return shapes;
}

} // namespace pcl::cosection
