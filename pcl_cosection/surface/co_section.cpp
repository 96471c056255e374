// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include <pcl/cosection/surface/co_section.h>

#include "co_section_run.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/volume/mesh_distance.h>

#include <algorithm>
#include <string>

namespace pcl
{
namespace cosection
{

namespace
{

void
checkPoses (const std::vector<Eigen::Isometry3d>& poses)
{
  if (!std::all_of (poses.begin (), poses.end (), [] (const Eigen::Isometry3d& T) { return T.matrix ().allFinite (); }))
    throw InvalidArgument ("the pose of a body is not finite");
}

} // namespace

CoSection::CoSection (const CoSectionOptions& options) : impl_ (new Impl)
{
  options.validate ();
  impl_->options = options;
}

CoSection::~CoSection () = default;
CoSection::CoSection (CoSection&&) noexcept = default;
CoSection&
CoSection::operator= (CoSection&&) noexcept = default;

int
CoSection::addView (DepthView view)
{
  view.validate ();
  impl_->views.emplace_back (std::move (view));
  return static_cast<int> (impl_->views.size ()) - 1;
}

void
CoSection::setBackground (std::vector<OrientedPoint> points)
{
  impl_->background = std::move (points);
}

void
CoSection::addObject (ObjectInput object)
{
  if (object.id <= 0)
    throw InvalidArgument ("object id is " + std::to_string (object.id) + "; it must be positive");
  if (std::any_of (impl_->objects.begin (), impl_->objects.end (), [&] (const ObjectInput& o) { return o.id == object.id; }))
    throw InvalidArgument ("object " + std::to_string (object.id) + " was added twice");
  impl_->objects.push_back (std::move (object));
}

void
CoSection::addSupportPlane (const Eigen::Vector4d& plane)
{
  const double norm = plane.head<3> ().stableNorm ();
  if (!(norm > 0.0) || !plane.allFinite ())
    throw InvalidArgument ("the coefficients of a plane must be finite and its normal not zero");
  impl_->planes.push_back (plane / norm);
}

void
CoSection::addIntersection (SignedDistanceField::ConstPtr body, const std::vector<Eigen::Isometry3d>& T_body_world)
{
  if (!body || body->values.size () != body->grid.size () ||
      (!body->supported.empty () && body->supported.size () != body->grid.size ()))
    throw InvalidArgument ("a signed distance field must have one value per voxel");
  checkPoses (T_body_world);
  impl_->bodies.push_back ({std::move (body), T_body_world});
}

void
CoSection::addIntersection (TriangleMesh body, const std::vector<Eigen::Isometry3d>& T_body_world)
{
  checkPoses (T_body_world);
  VoxelGrid somewhere;
  somewhere.dims.setConstant (2);
  somewhere.voxel_size_m = 1.0;
  sampleSignedDistance (body, somewhere, somewhere.voxel_size_m); // validates
  impl_->meshes.push_back ({std::move (body), T_body_world});
}

SceneResult
CoSection::reconstruct (const ProgressCallback& progress) const
{
  return CoSectionRun (*impl_, progress).run ();
}

} // namespace cosection
} // namespace pcl
