// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/tracking/sdf_alignment.h>

#include "surface_points.h"

#include <pcl/cosection/common/error.h>

#include <pcl/console/print.h>

namespace pcl::cosection {
namespace {

void
requireSurface (const SignedDistanceField& field, std::vector<Eigen::Vector3f>* surface)
{
  if (!surface)
    return;
  *surface = surfacePoints (field);
  if (surface->empty ())
    throw InvalidArgument ("the signed distance has no surface: it does not change its sign");
}

} // namespace

void
SdfAlignmentBase::report (const char* function, const std::string& error) const
{
  PCL_ERROR ("[pcl::%s::%s] %s.\n", name_, function, error.c_str ());
}

bool
SdfAlignmentBase::setOptions (const SdfAlignmentOptions& options)
try
{
  options.validate ();
  options_ = options;
  return true;
}
catch (const Error& error)
{
  report ("setOptions", error.what ());
  return false;
}

void
SdfAlignmentBase::setNumberOfThreads (unsigned int threads)
{
  options_.threads = static_cast<int> (threads);
}

bool
SdfAlignmentBase::setTarget (const TsdfVolume::ConstPtr& volume, std::vector<Eigen::Vector3f>* surface)
try
{
  if (!volume)
    throw InvalidArgument ("the signed distance volume is a null pointer");
  requireSurface (volume->field (), surface);
  volume_ = volume;
  field_.reset ();
  return true;
}
catch (const Error& error)
{
  report ("setSignedDistance", error.what ());
  return false;
}

bool
SdfAlignmentBase::setTarget (const SignedDistanceField::ConstPtr& field, std::vector<Eigen::Vector3f>* surface)
try
{
  if (!field)
    throw InvalidArgument ("the signed distance field is a null pointer");
  requireSurface (SdfTarget (*field).field (), surface); // which checks it
  field_ = field;
  volume_.reset ();
  return true;
}
catch (const Error& error)
{
  report ("setSignedDistance", error.what ());
  return false;
}

bool
SdfAlignmentBase::alignPoints (const SdfAlignmentOptions& options, const std::vector<Eigen::Vector3f>& points,
                               const std::vector<float>& weights, const Eigen::Isometry3d& guess)
try
{
  result_ = SdfAlignmentResult ();
  if (!hasTarget ())
    throw InvalidArgument ("there is no signed distance to align with; setSignedDistance () gives one");
  result_ = SdfAlignment (options).align (points, weights, target (), guess);
  return true;
}
catch (const Error& error)
{
  report ("align", error.what ());
  return false;
}

} // namespace pcl::cosection
