// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/fusion/dynamic_fusion.h>

#include "pcl_cosection/common/require.h"
#include "process_frame.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace pcl::cosection {
namespace {

AssociationOptions
associationOptions (const DynamicFusionOptions& options)
{
  AssociationOptions association = options.association;
  association.threads = options.threads;
  return association;
}

} // namespace

void
DynamicFusionOptions::validate () const
{
  association.validate ();
  require (background_resolution >= 16 && background_resolution <= 1024, "background_resolution must be in [16, 1024]");
  require (background_voxel_size_m >= 0.0 && std::isfinite (background_voxel_size_m),
           "background_voxel_size_m must be positive, or 0");
  require (segment_every >= 1, "segment_every must be at least 1");
  require (object_resolution >= 16 && object_resolution <= 512, "object_resolution must be in [16, 512]");
  require (max_object_resolution >= object_resolution,
           "max_object_resolution must not be smaller than object_resolution");
  require (background_truncation_vox >= 2.0 && object_truncation_vox >= 2.0,
           "truncation distances must be at least 2 voxels");
  require (max_weight >= 1.0 && std::isfinite (max_weight), "max_weight must be at least 1");
  require (max_depth_m > 0.0 && max_object_depth_m > 0.0, "the largest depths must be positive");
  require (tracking_points >= 1000, "tracking_points must be at least 1000");
  require (min_object_pixels >= 1, "min_object_pixels must be at least 1");
  require (max_objects >= 0 && max_objects <= 200, "max_objects must be in [0, 200]");
  require (first_pose.matrix ().allFinite (), "first_pose must be finite");
  require (threads >= 0, "threads must not be negative");
}

FusionSetup::FusionSetup (const PinholeCamera& camera, const DynamicFusionOptions& options)
    : camera (camera)
    , options (options)
    , association (associationOptions (options))
{
  camera.validate ();
  options.validate ();
  constexpr double standard_pixels = 640.0 * 480.0;
  const double share = static_cast<double> (camera.width) * camera.height / standard_pixels;
  min_object_pixels = static_cast<std::size_t> (std::max (1.0, std::round (options.min_object_pixels * share)));
  alignment.max_points = options.tracking_points;
  alignment.threads = options.threads;
  background_tsdf.truncation_vox = options.background_truncation_vox;
  object_tsdf.truncation_vox = options.object_truncation_vox;
  for (TsdfOptions* tsdf : {&background_tsdf, &object_tsdf})
  {
    tsdf->max_weight = options.max_weight;
    tsdf->threads = options.threads;
  }
  background_tsdf.foreground = options.objects;
  object_tsdf.colour = true;
  object_tsdf.foreground = true;
}

struct DynamicFusion::Impl
{
  Impl (const PinholeCamera& camera, const DynamicFusionOptions& options) : setup (camera, options), state (setup) {}

  FusionSetup setup;
  FusionState state;
  TrackedFrame result; // of the last frame
};

DynamicFusion::DynamicFusion (const PinholeCamera& camera, const DynamicFusionOptions& options)
    : impl_ (std::make_unique<Impl> (camera, options))
{}

DynamicFusion::~DynamicFusion () = default;
DynamicFusion::DynamicFusion (DynamicFusion&& other) noexcept = default;
DynamicFusion& DynamicFusion::operator= (DynamicFusion&& other) noexcept = default;

void
DynamicFusion::setSegmenter (std::shared_ptr<FrameSegmenter> segmenter)
{
  impl_->state.segmenter = ScheduledSegmenter (impl_->setup.options.segment_every, std::move (segmenter));
}

const TrackedFrame&
DynamicFusion::process (const RgbdFrame& frame, const Image<std::uint16_t>* mask)
{
  const PinholeCamera& camera = impl_->setup.camera;
  if (mask && (mask->width != camera.width || mask->height != camera.height))
    throw InvalidArgument ("the mask must be of the camera's size");
  impl_->result = processFrame (frame, mask, impl_->setup, impl_->state);
  return impl_->result;
}

std::set<int>
DynamicFusion::objects () const
{
  return impl_->state.objects.idsOf (
      [] (const TrackedObject& object) { return object.isActive () && object.confirmed; });
}

std::set<int>
DynamicFusion::foundObjects () const
{
  return impl_->state.objects.found ();
}

std::map<std::uint16_t, std::string>
DynamicFusion::refusedInstances () const
{
  std::map<std::uint16_t, std::string> refused = impl_->state.objects.refused;
  for (const std::uint16_t instance : impl_->state.objects.shown)
    refused.erase (instance);
  return refused;
}

TriangleMesh
DynamicFusion::surfaceMesh (int id) const
{
  const TrackedObject* object = impl_->state.objects.find (id);
  if (!object)
    return {};
  return object->volume ? object->volume->surfaceMesh () : object->surface;
}

std::optional<ClassScore>
DynamicFusion::objectClass (int id) const
{
  const TrackedObject* object = impl_->state.objects.find (id);
  return object ? object->classes.best () : std::nullopt;
}

TriangleMesh
DynamicFusion::backgroundMesh () const
{
  const std::optional<TsdfVolume>& background = impl_->state.background;
  return background ? background->surfaceMesh () : TriangleMesh ();
}

std::vector<std::string>
DynamicFusion::events () const
{
  return impl_->state.log.lines ();
}

const std::map<std::string, double>&
DynamicFusion::timings () const
{
  return impl_->state.timings_s;
}

} // namespace pcl::cosection
