// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Each stage of segmentation makes its own image of labels; the container of objects keeps what was seen of them.

#include "pcl_cosection/fusion/association/frame_labels.h"
#include <pcl/cosection/fusion/frame_segmenter.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

using namespace pcl::cosection;

namespace {

constexpr std::uint16_t unassigned = TrackedFrame::unassigned;
constexpr float far_m = 1.2f, near_m = 0.8f;
const PinholeCamera small_camera{80, 60, 60.0, 60.0, 39.5, 29.5};

TsdfVolume
labelledVolume (const Image<float>& depth)
{
  VoxelGrid grid;
  grid.dims = {64, 64, 64};
  grid.voxel_size_m = 0.02;
  grid.origin_m = {-0.64, -0.64, 0.4};
  TsdfOptions options;
  options.truncation_vox = 5.0;
  TsdfVolume volume (grid, options);
  volume.integrate (depth, small_camera, Eigen::Isometry3d::Identity ());
  return volume;
}

/** \brief A box before a wall that was seen without it; of the box, the left half is known as object 3. */
class FrameLabels : public testing::Test
{
protected:
  FrameLabels ()
  {
    RgbdFrame frame;
    frame.depth = Image<float> (small_camera.width, small_camera.height, far_m);
    Image<float> known (small_camera.width, small_camera.height, std::numeric_limits<float>::quiet_NaN ());
    for (int v = 20; v < 40; ++v)
      for (int u = 30; u < 50; ++u)
      {
        frame.depth.at (u, v) = near_m;
        if (u < 40)
          known.at (u, v) = near_m;
      }
    DynamicFusionOptions options;
    options.smooth_depth = false;
    cloud_ = makeFrameCloud (frame, small_camera, options);
    const TsdfVolume box = labelledVolume (known);
    TrackedObject& object = objects_.by_id
                                .try_emplace (3, 3, box.grid (), box.options (), Eigen::Isometry3d::Identity ())
                                .first->second;
    object.volume = box;
    scene_ = trackedModels (background_, objects_, Eigen::Isometry3d::Identity ());
  }

  static std::size_t count (const LabelImage& labels, std::uint16_t label)
  {
    return static_cast<std::size_t> (std::count (labels.pixels.begin (), labels.pixels.end (), label));
  }

  TsdfVolume background_ = labelledVolume (Image<float> (small_camera.width, small_camera.height, far_m));
  ObjectMap objects_;
  SceneModels scene_;
  FrameCloud cloud_;
  DataAssociation association_;
};

} // namespace

TEST_F (FrameLabels, AssociationLabelsWhatModelsExplain)
{
  const PixelAssociation associated = associatePixels (cloud_, scene_, association_);
  EXPECT_EQ (associated.labels.at (10, 10), 0);
  EXPECT_EQ (associated.labels.at (33, 30), 3);
  EXPECT_EQ (associated.labels.at (47, 30), unassigned);
  EXPECT_GT (associated.mean_probability.at (3), 0.9);
}

TEST_F (FrameLabels, ObjectsGrowOverWhatIsBesideThemUnlessItIsLarger)
{
  const PixelAssociation associated = associatePixels (cloud_, scene_, association_);
  const LabelImage any = growObjects (associated, cloud_, scene_, association_, ObjectGrowth::Any);
  EXPECT_GT (count (any, 3), count (associated.labels, 3));
  EXPECT_EQ (any.at (10, 10), 0);
  PixelAssociation small = associated; // the object has fewer pixels than the component beside it
  for (std::uint16_t& label : small.labels.pixels)
    label = label == 3 ? 0 : label;
  small.labels.at (39, 30) = 3;
  EXPECT_EQ (growObjects (small, cloud_, scene_, association_, ObjectGrowth::Small).pixels, small.labels.pixels);
}

TEST_F (FrameLabels, AMaskOverrulesAssociation)
{
  const LabelImage labels = associatePixels (cloud_, scene_, association_).labels;
  Image<std::uint16_t> mask (small_camera.width, small_camera.height, 0);
  for (int v = 20; v < 40; ++v)
    for (int u = 30; u < 50; ++u)
      mask.at (u, v) = 7;
  mask.at (5, 5) = 8;
  mask.at (6, 6) = FrameSegmenter::ignored;
  const LabelImage masked = applyMask (labels, mask, {{7, 3}}, cloud_, scene_, association_);
  EXPECT_EQ (count (masked, 3), 400u);
  EXPECT_EQ (masked.at (5, 5), unassigned); // an instance of no object
  EXPECT_EQ (masked.at (6, 6), unassigned);
  EXPECT_EQ (count (masked, unassigned), 2u);
}

TEST_F (FrameLabels, OtherStages)
{
  const LabelImage labels = associatePixels (cloud_, scene_, association_).labels;
  const std::size_t pixels = count (labels, 3);
  EXPECT_EQ (count (relabelled (labels, {{3, 5}}), 5), pixels);
  EXPECT_EQ (relabelled (labels, {}).pixels, labels.pixels);
  EXPECT_EQ (withoutUnconfirmed (labels, objects_).pixels, labels.pixels);
  objects_.by_id.at (3).confirmed = false;
  EXPECT_EQ (count (withoutUnconfirmed (labels, objects_), 3), 0u);

  LabelImage one (5, 5, 0);
  one.at (2, 2) = 4;
  EXPECT_EQ (count (widened (one, 1), 4), 9u);

  MovingParts moving;
  moving.any = true;
  moving.log_odds = Image<float> (small_camera.width, small_camera.height, 1.0f);
  moving.log_odds.at (1, 1) = -1.0f;
  moving.log_odds.at (33, 30) = -1.0f; // an object's
  const LabelImage resting = withoutMoving (labels, moving, cloud_);
  EXPECT_EQ (count (resting, unassigned), count (labels, unassigned) + 1);
  EXPECT_EQ (resting.at (1, 1), unassigned);

  objects_.by_id.at (3).state = ObjectState::Lost;
  LabelImage background (small_camera.width, small_camera.height, 0);
  const PosedFrame frame{0.0, cloud_, Eigen::Isometry3d::Identity ()};
  EXPECT_EQ (withoutLost (background, objects_, frame).at (33, 30), unassigned);
  EXPECT_EQ (withoutLost (background, objects_, frame).at (10, 10), 0);
}

TEST_F (FrameLabels, ObjectsThatAreNotSeenForLongKeepTheirSurface)
{
  EventLog log;
  const DynamicFusionOptions options;
  const TrackedObject first = objects_.by_id.at (3);
  for (int id = 3; id < 21; ++id)
  {
    TrackedObject& object = objects_.by_id.try_emplace (id, first).first->second;
    object.id = id;
    object.state = ObjectState::Lost;
    object.frames_not_tracked = 1000;
  }
  objects_.by_id.at (20).confirmed = false;
  pruneObjects (0.0, {}, options, objects_, log);
  EXPECT_EQ (objects_.by_id.size (), 17u);
  EXPECT_EQ (objects_.found ().size (), 17u);
  EXPECT_EQ (objects_.find (20), nullptr); // one mask showed it, and it is gone
  EXPECT_EQ (objects_.by_id.at (3).state, ObjectState::Retired);
  EXPECT_FALSE (objects_.by_id.at (3).volume);
  EXPECT_EQ (objects_.by_id.at (3).surface.vertices.size (), first.volume->surfaceMesh ().vertices.size ());
  for (int id = 4; id < 20; ++id)
    EXPECT_EQ (objects_.by_id.at (id).state, ObjectState::Dormant) << id;
  EXPECT_EQ (log.lines ().size (), 17u);
}
