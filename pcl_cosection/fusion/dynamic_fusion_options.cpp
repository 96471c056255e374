// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "dynamic_fusion_options.h"

#include <pcl/cosection/common/error.h>

#include <cmath>

namespace pcl::cosection
{

namespace
{

void
check (bool good, const char* message)
{
  if (!good)
    throw InvalidArgument (message);
}

} // namespace

void
DynamicFusionOptions::validate () const
{
  association.validate ();
  check (background_resolution >= 16 && background_resolution <= 1024, "background_resolution must be in [16, 1024]");
  check (background_voxel_size_m >= 0.0 && std::isfinite (background_voxel_size_m),
         "background_voxel_size_m must be positive, or 0");
  check (segment_every >= 1, "segment_every must be at least 1");
  check (object_resolution >= 16 && object_resolution <= 512, "object_resolution must be in [16, 512]");
  check (max_object_resolution >= object_resolution,
         "max_object_resolution must not be smaller than object_resolution");
  check (background_truncation_vox >= 2.0 && object_truncation_vox >= 2.0,
         "truncation distances must be at least 2 voxels");
  check (max_weight >= 1.0 && std::isfinite (max_weight), "max_weight must be at least 1");
  check (max_depth_m > 0.0 && max_object_depth_m > 0.0, "the largest depths must be positive");
  check (tracking_points >= 1000, "tracking_points must be at least 1000");
  check (min_object_pixels >= 1, "min_object_pixels must be at least 1");
  check (max_objects >= 0 && max_objects <= 200, "max_objects must be in [0, 200]");
  check (first_pose.matrix ().allFinite (), "first_pose must be finite");
  check (threads >= 0, "threads must not be negative");
}

BackgroundOptions
backgroundOptions (const DynamicFusionOptions& options)
{
  BackgroundOptions background;
  background.resolution = options.background_resolution;
  background.voxel_size_m = options.background_voxel_size_m;
  background.tsdf.truncation_vox = options.background_truncation_vox;
  background.tsdf.max_weight = options.max_weight;
  background.tsdf.foreground = options.objects;
  background.tsdf.threads = options.threads;
  return background;
}

AssociationOptions
associationOptions (const DynamicFusionOptions& options)
{
  AssociationOptions association = options.association;
  association.threads = options.threads;
  return association;
}

} // namespace pcl::cosection
