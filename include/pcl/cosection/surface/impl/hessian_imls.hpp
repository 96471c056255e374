// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/surface/hessian_imls.h>

#include <pcl/common/point_tests.h>
#include <pcl/console/print.h>
#include <pcl/point_types.h>

#include <cmath>

namespace pcl::cosection
{

template <typename PointNT> HessianIMLS<PointNT>::HessianIMLS ()
{
  this->check_tree_ = false;
}

template <typename PointNT>
void
HessianIMLS<PointNT>::setOptions (const CoSectionOptions& options)
{
  options.validate ();
  options_ = options;
}

template <typename PointNT>
void
HessianIMLS<PointNT>::setVoxelSize (float voxel_size_m)
{
  if (!(voxel_size_m > 0.0f))
    throw InvalidArgument ("voxel size must be positive, in metres");
  CoSectionOptions options = options_;
  options.voxel_size_m = voxel_size_m;
  setOptions (options);
}

template <typename PointNT>
void
HessianIMLS<PointNT>::setResolution (int resolution)
{
  CoSectionOptions options = options_;
  options.resolution = resolution;
  options.voxel_size_m = 0.0;
  setOptions (options);
}

template <typename PointNT>
void
HessianIMLS<PointNT>::addView (const DepthView& view)
{
  CoSection ().addView (view); // validates
  views_.push_back (view);
}

template <typename PointNT>
void
HessianIMLS<PointNT>::addObstacle (const SignedDistanceField::ConstPtr& body,
                                   const std::vector<Eigen::Isometry3d>& T_body_object)
{
  CoSection ().addObstacle (body, T_body_object); // validates
  bodies_.emplace_back (body, T_body_object);
}

template <typename PointNT>
void
HessianIMLS<PointNT>::addObstacle (const TriangleMesh& body, const std::vector<Eigen::Isometry3d>& T_body_object)
{
  CoSection ().addObstacle (body, T_body_object); // validates
  meshes_.emplace_back (body, T_body_object);
}

template <typename PointNT>
void
HessianIMLS<PointNT>::addObstacle (const pcl::PolygonMesh& body, const std::vector<Eigen::Isometry3d>& T_body_object)
{
  addObstacle (fromPolygonMesh (body), T_body_object);
}

template <typename PointNT>
void
HessianIMLS<PointNT>::setSupportPlane (const pcl::ModelCoefficients& coefficients)
{
  const auto& c = coefficients.values;
  if (c.size () != 4)
    throw InvalidArgument ("a plane has four coefficients, not " + std::to_string (c.size ()));
  const Eigen::Vector4d plane (c[0], c[1], c[2], c[3]);
  CoSection ().addSupportPlane (plane); // validates
  planes_.push_back (plane);
}

template <typename PointNT>
void
HessianIMLS<PointNT>::clearConstraints ()
{
  views_.clear ();
  bodies_.clear ();
  meshes_.clear ();
  planes_.clear ();
}

template <typename PointNT>
bool
HessianIMLS<PointNT>::compute ()
{
  result_ = ObjectResult ();
  ObjectInput object;
  object.id = 1;
  for (const auto i : *indices_)
  {
    const PointNT& p = (*input_)[i];
    const Eigen::Vector3f normal = p.getNormalVector3fMap ();
    const float length = normal.norm ();
    if (!pcl::isXYZFinite (p) || !std::isfinite (length) || !(length > 0.0f))
      continue;
    OrientedPoint point;
    point.position = p.getVector3fMap ();
    point.normal = normal / length;
    if constexpr (pcl::traits::has_color<PointNT>::value)
      point.colour = {p.r, p.g, p.b};
    if constexpr (pcl::traits::has_intensity<PointNT>::value)
      point.intensity = std::isfinite (p.intensity) ? p.intensity : 0.0f;
    object.points.push_back (point);
  }
  try
  {
    CoSection scene (options_);
    for (const DepthView& view : views_)
      scene.addView (view);
    for (const auto& [body, poses] : bodies_)
      scene.addObstacle (body, poses);
    for (const auto& [body, poses] : meshes_)
      scene.addObstacle (body, poses);
    for (const Eigen::Vector4d& plane : planes_)
      scene.addSupportPlane (plane);
    scene.addObject (std::move (object));
    SceneResult result = scene.reconstruct (progress_);
    result_ = std::move (result.objects.front ());
  }
  catch (const Error& e)
  {
    result_.error = e.what ();
  }
  if (result_.error.empty ())
    return true;
  PCL_ERROR ("[pcl::%s::reconstruct] %s.\n", getClassName ().c_str (), result_.error.c_str ());
  return false;
}

template <typename PointNT>
void
HessianIMLS<PointNT>::reconstruct (pcl::PolygonMesh& output)
{
  output.polygons.clear ();
  output.cloud = pcl::PCLPointCloud2 ();
  if (!this->initCompute ())
  {
    PCL_ERROR ("[pcl::%s::reconstruct] There is no input cloud.\n", getClassName ().c_str ());
    return;
  }
  output.header = input_->header;
  performReconstruction (output);
  this->deinitCompute ();
}

template <typename PointNT>
void
HessianIMLS<PointNT>::reconstruct (pcl::PointCloud<PointNT>& points, std::vector<pcl::Vertices>& polygons)
{
  points.clear ();
  polygons.clear ();
  if (!this->initCompute ())
  {
    PCL_ERROR ("[pcl::%s::reconstruct] There is no input cloud.\n", getClassName ().c_str ());
    return;
  }
  points.header = input_->header;
  performReconstruction (points, polygons);
  this->deinitCompute ();
}

template <typename PointNT>
void
HessianIMLS<PointNT>::performReconstruction (pcl::PolygonMesh& output)
{
  output.cloud = pcl::PCLPointCloud2 ();
  output.polygons.clear ();
  if (!compute ())
    return;
  toPolygonMesh (result_.mesh, output);
  output.cloud.header = output.header;
}

template <typename PointNT>
void
HessianIMLS<PointNT>::performReconstruction (pcl::PointCloud<PointNT>& points, std::vector<pcl::Vertices>& polygons)
{
  points.clear ();
  polygons.clear ();
  if (!compute ())
    return;
  const TriangleMesh& mesh = result_.mesh;
  points.resize (mesh.vertices.size ());
  for (std::size_t v = 0; v < mesh.vertices.size (); ++v)
  {
    points[v].getVector3fMap () = mesh.vertices[v];
    points[v].getNormalVector3fMap () = mesh.normals[v];
    if constexpr (pcl::traits::has_color<PointNT>::value)
      if (!mesh.colours.empty ())
      {
        points[v].r = mesh.colours[v][0];
        points[v].g = mesh.colours[v][1];
        points[v].b = mesh.colours[v][2];
      }
    if constexpr (pcl::traits::has_intensity<PointNT>::value)
      if (!mesh.intensity.empty ())
        points[v].intensity = mesh.intensity[v];
  }
  polygons.resize (mesh.triangles.size ());
  for (std::size_t t = 0; t < mesh.triangles.size (); ++t)
    polygons[t].vertices.assign (mesh.triangles[t].begin (), mesh.triangles[t].end ());
}

} // namespace pcl::cosection

#define PCL_INSTANTIATE_CosectionHessianIMLS(T) template class pcl::cosection::HessianIMLS<T>;
