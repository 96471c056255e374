// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/surface/hessian_imls.h>

#include "pcl_cosection/common/console_errors.h"

#include <pcl/point_types.h>

#include <algorithm>
#include <limits>

namespace pcl::cosection {

bool
HessianIMLSBase::setOptions (const CoSectionOptions& options)
{
  return reportErrors ("cosection::HessianIMLS::setOptions", [&] {
    options.validate ();
    options_ = options;
  });
}

bool
HessianIMLSBase::setVoxelSize (float voxel_size_m)
{
  return reportErrors ("cosection::HessianIMLS::setVoxelSize", [&] {
    if (!(voxel_size_m > 0.0f))
      throw InvalidArgument ("voxel size must be positive, in metres");
    CoSectionOptions options = options_;
    options.voxel_size_m = voxel_size_m;
    options.validate ();
    options_ = options;
  });
}

bool
HessianIMLSBase::setResolution (int resolution)
{
  return reportErrors ("cosection::HessianIMLS::setResolution", [&] {
    CoSectionOptions options = options_;
    options.resolution = resolution;
    options.voxel_size_m = 0.0;
    options.validate ();
    options_ = options;
  });
}

bool
HessianIMLSBase::setNumberOfThreads (unsigned int threads)
{
  return reportErrors ("cosection::HessianIMLS::setNumberOfThreads", [&] {
    CoSectionOptions options = options_;
    options.threads = static_cast<int> (std::min<unsigned int> (threads, std::numeric_limits<int>::max ()));
    options.validate ();
    options_ = options;
  });
}

bool
HessianIMLSBase::addView (const DepthView& view)
{
  return reportErrors ("cosection::HessianIMLS::addView", [&] {
    view.validate ();
    views_.push_back (view);
  });
}

bool
HessianIMLSBase::addCloud (const std::optional<DepthView>& view)
{
  if (view)
    return addView (*view);
  PCL_ERROR (
      "[pcl::cosection::HessianIMLS::addView] The cloud is not the image of a pinhole camera, nor all visible from "
      "the origin of its frame; it is left out.\n");
  return false;
}

bool
HessianIMLSBase::addObstacle (const SignedDistanceField::ConstPtr& body, const Poses& T_body_object)
{
  return reportErrors ("cosection::HessianIMLS::addObstacle", [&] {
    CoSection ().addObstacle (body, T_body_object); // validates
    fields_.emplace_back (body, T_body_object);
  });
}

bool
HessianIMLSBase::addObstacle (const TriangleMesh& body, const Poses& T_body_object)
{
  return reportErrors ("cosection::HessianIMLS::addObstacle", [&] {
    CoSection ().addObstacle (body, T_body_object); // validates
    meshes_.emplace_back (body, T_body_object);
  });
}

bool
HessianIMLSBase::addObstacle (const pcl::PolygonMesh& body, const Poses& T_body_object)
{
  TriangleMesh mesh;
  return reportErrors ("cosection::HessianIMLS::addObstacle", [&] { mesh = fromPolygonMesh (body); }) &&
         addObstacle (mesh, T_body_object);
}

bool
HessianIMLSBase::addSupportPlane (const pcl::ModelCoefficients& coefficients)
{
  return reportErrors ("cosection::HessianIMLS::addSupportPlane", [&] {
    const auto& c = coefficients.values;
    if (c.size () != 4)
      throw InvalidArgument ("a plane has four coefficients, not " + std::to_string (c.size ()));
    const Eigen::Vector4d plane (c[0], c[1], c[2], c[3]);
    CoSection ().addSupportPlane (plane); // validates
    planes_.push_back (plane);
  });
}

bool
HessianIMLSBase::addProposal (const TriangleMesh& mesh)
{
  return reportErrors ("cosection::HessianIMLS::addProposal", [&] {
    CoSection ().addObject ({1, {}, {}, {mesh}}); // validates
    proposals_.push_back (mesh);
  });
}

bool
HessianIMLSBase::addProposal (const pcl::PolygonMesh& mesh)
{
  TriangleMesh triangles;
  return reportErrors ("cosection::HessianIMLS::addProposal", [&] { triangles = fromPolygonMesh (mesh); }) &&
         addProposal (triangles);
}

void
HessianIMLSBase::clearConstraints ()
{
  proposals_.clear ();
  views_.clear ();
  fields_.clear ();
  meshes_.clear ();
  planes_.clear ();
}

bool
HessianIMLSBase::complete (std::vector<OrientedPoint> points)
{
  result_ = ObjectResult ();
  return reportErrors ("cosection::HessianIMLS::reconstruct", [&] {
    CoSection scene (options_);
    for (const DepthView& view : views_)
      scene.addView (view);
    for (const auto& [body, poses] : fields_)
      scene.addObstacle (body, poses);
    for (const auto& [body, poses] : meshes_)
      scene.addObstacle (body, poses);
    for (const Eigen::Vector4d& plane : planes_)
      scene.addSupportPlane (plane);
    scene.addObject ({1, std::move (points), {}, proposals_});
    SceneResult all = scene.reconstruct (progress_);
    for (const std::string& warning : all.warnings)
      PCL_WARN ("[pcl::cosection::HessianIMLS::reconstruct] %s\n", warning.c_str ());
    ObjectResult result = std::move (all.objects.front ());
    if (!result.error.empty ())
      throw Error (result.error);
    result_ = std::move (result);
  });
}

void
HessianIMLSBase::reportMissingInput () const
{
  PCL_ERROR ("[pcl::cosection::HessianIMLS::reconstruct] There is no input cloud.\n");
}

} // namespace pcl::cosection

BOOST_PP_SEQ_FOR_EACH (PCL_COSECTION_TEMPLATE, pcl::cosection::HessianIMLS, PCL_COSECTION_NORMAL_POINT_TYPES)
