// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// The PCL classes give the result of SdfAlignment, and behave like PCL's own.

#include "tracking_scene.h"

#include <pcl/cosection/tracking/sdf_registration.h>
#include <pcl/cosection/tracking/sdf_tracker.h>

#include <pcl/point_types.h>

#include <gtest/gtest.h>

#include <limits>
#include <memory>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

Cloud::Ptr
cloudOf (const std::vector<Eigen::Vector3f>& points)
{
  auto cloud = pcl::make_shared<Cloud> ();
  for (const Eigen::Vector3f& p : points)
    cloud->push_back ({p.x (), p.y (), p.z ()});
  return cloud;
}

/** \brief A truck, seen from near where it is expected. */
class SdfRegistrationTest : public testing::Test
{
protected:
  static const SceneBody& body ()
  {
    static const SceneBody truck = presetBody ("toys", "truck");
    return truck;
  }

  static const SignedDistanceField::ConstPtr& field ()
  {
    static const SignedDistanceField::ConstPtr exact = std::make_shared<SignedDistanceField> (
        bodyDistance (body (), 64));
    return exact;
  }

  static BodyView viewFrom (const Eigen::Isometry3d& T_body_sensor)
  {
    return renderBody (body (), body_camera, {T_body_sensor}, false).front ();
  }

  SdfRegistrationTest ()
      : view_ (viewFrom (poseOnCircle (center_, body_distance_m, 0.8)))
      , points_ (view_.points (body_camera))
  {
    std::mt19937 random (5);
    const Eigen::Isometry3d first = randomMotion (random, center_, radians (6.0), 0.04) * view_.T_body_sensor;
    guess_ = first.matrix ().cast<float> ();
    T_guess_.matrix () = guess_.cast<double> ();
  }

  Eigen::Vector3d center_ = bodyCenter (body ());
  BodyView view_;
  std::vector<Eigen::Vector3f> points_;
  Eigen::Matrix4f guess_;
  Eigen::Isometry3d T_guess_;
};

} // namespace

TEST_F (SdfRegistrationTest, EqualsTheAlignment)
{
  const SdfAlignmentResult expected = SdfAlignment ().align (points_, {}, *field (), T_guess_);
  SdfRegistration<pcl::PointXYZ>::Ptr registration (new SdfRegistration<pcl::PointXYZ>);
  registration->setSignedDistance (field ());
  pcl::Registration<pcl::PointXYZ, pcl::PointXYZ>::Ptr base = registration; // as in code for any registration
  base->setInputSource (cloudOf (points_));
  Cloud aligned;
  base->align (aligned, guess_);
  ASSERT_TRUE (base->hasConverged ());
  EXPECT_EQ (base->getFinalTransformation (), expected.T_grid_sensor.matrix ().cast<float> ().eval ());
  EXPECT_EQ (registration->getInformationMatrix (), expected.information);
  ASSERT_EQ (aligned.size (), points_.size ());
  for (std::size_t n = 0; n < aligned.size (); n += 100)
    EXPECT_LT (
        (aligned[n].getVector3fMap ().cast<double> () - expected.T_grid_sensor * points_[n].cast<double> ()).norm (),
        1e-6);
  const double spacing_m = field ()->grid.voxel_size_m;
  EXPECT_LT (base->getFitnessScore (), spacing_m * spacing_m);

  // As a TSDF volume it is set in the same way.
  const auto volume = std::make_shared<TsdfVolume> (bodyTsdf (body (), body_camera, {view_}, 64));
  const SdfAlignmentResult in_tsdf = SdfAlignment ().align (points_, {}, *volume, T_guess_);
  registration->setSignedDistance (volume);
  base->align (aligned, guess_);
  EXPECT_EQ (base->getFinalTransformation (), in_tsdf.T_grid_sensor.matrix ().cast<float> ().eval ());
}

TEST_F (SdfRegistrationTest, HonoursIndicesWeightsAndTheBase)
{
  auto cloud = cloudOf (points_);
  const auto last = static_cast<int> (cloud->size ());
  for (int n = 0; n < 3000; ++n)
    cloud->push_back ({0.05f, 0.01f, static_cast<float> (body_distance_m)});
  cloud->push_back ({std::numeric_limits<float>::quiet_NaN (), 0.0f, 0.0f});
  SdfRegistration<pcl::PointXYZ> registration;
  registration.setSignedDistance (field ());
  registration.setInputSource (cloud);
  auto indices = pcl::make_shared<pcl::Indices> ();
  for (int n = 0; n < last; ++n)
    indices->push_back (n);
  registration.setIndices (indices);
  Cloud aligned;
  registration.align (aligned, guess_);
  const Eigen::Matrix4f
      expected = SdfAlignment ().align (points_, {}, *field (), T_guess_).T_grid_sensor.matrix ().cast<float> ();
  EXPECT_EQ (registration.getFinalTransformation (), expected);
  EXPECT_EQ (aligned.size (), points_.size ());

  SdfRegistration<pcl::PointXYZ> weighted;
  std::vector<float> weights (cloud->size (), 0.0f);
  std::fill (weights.begin (), weights.begin () + last, 1.0f);
  weighted.setSignedDistance (field ());
  weighted.setInputSource (cloud);
  weighted.setWeights (weights);
  weighted.align (aligned, guess_);
  EXPECT_TRUE (weighted.hasConverged ());
  EXPECT_EQ (weighted.getFinalTransformation (), expected);
  EXPECT_EQ (aligned.size (), cloud->size ());

  weighted.setMaximumIterations (1);
  weighted.align (aligned, guess_);
  EXPECT_FALSE (weighted.hasConverged ());
  EXPECT_EQ (weighted.getAlignment ().iterations, 1);
  weighted.setMaximumIterations (40);
  weighted.setMaxCorrespondenceDistance (1e-6);
  weighted.align (aligned, guess_);
  EXPECT_EQ (weighted.getAlignment ().stop, SdfAlignmentStop::TooFewPoints);

  weighted.setWeights ({1.0f});
  weighted.align (aligned, guess_);
  EXPECT_FALSE (weighted.hasConverged ());
  EXPECT_EQ (weighted.getFinalTransformation (), guess_);
}

TEST_F (SdfRegistrationTest, SaysWhatIsMissing)
{
  Cloud aligned;
  SdfRegistration<pcl::PointXYZ> registration;
  registration.align (aligned); // neither
  EXPECT_FALSE (registration.hasConverged ());
  registration.setInputSource (cloudOf (points_));
  registration.align (aligned, guess_); // no volume
  EXPECT_FALSE (registration.hasConverged ());
  EXPECT_EQ (registration.getFinalTransformation (), guess_);
  registration.setInputTarget (cloudOf (points_)); // a target cloud does not replace the volume
  registration.align (aligned, guess_);
  EXPECT_FALSE (registration.hasConverged ());

  registration.setSignedDistance (field ());
  registration.align (aligned, guess_);
  EXPECT_TRUE (registration.hasConverged ());
  registration.align (aligned, Eigen::Matrix4f::Constant (std::numeric_limits<float>::quiet_NaN ()));
  EXPECT_FALSE (registration.hasConverged ());
  EXPECT_TRUE (registration.getFinalTransformation ().allFinite ());

  EXPECT_FALSE (registration.setSignedDistance (SignedDistanceField::ConstPtr ()));
  EXPECT_FALSE (registration.setSignedDistance (TsdfVolume::ConstPtr ()));
  EXPECT_FALSE (registration.setSignedDistance (std::make_shared<TsdfVolume> (field ()->grid))); // no surface
}

TEST_F (SdfRegistrationTest, TrackerFollowsAndSaysWhenTheObjectIsLost)
{
  SdfTracker<pcl::PointXYZ> tracker;
  tracker.setSignedDistance (field ());
  const auto T_body_sensor = [&] (int frame) { // the sensor moves around the object, and nearer
    return poseOnCircle (center_, body_distance_m - 0.01 * frame, radians (20.0 + 4.0 * frame));
  };
  tracker.setTrans (Eigen::Affine3f (T_body_sensor (0).inverse ().matrix ().cast<float> ()));
  EXPECT_TRUE (tracker.isLost ());
  int steps[2] = {0, 0};
  for (const MotionModel model : {MotionModel::ConstantPose, MotionModel::ConstantVelocity})
  {
    tracker.setMotionModel (model);
    tracker.setTrans (Eigen::Affine3f (T_body_sensor (0).inverse ().matrix ().cast<float> ()));
    for (int frame = 1; frame < 8; ++frame)
    {
      tracker.setInputCloud (cloudOf (viewFrom (T_body_sensor (frame)).points (body_camera)));
      tracker.compute ();
      ASSERT_FALSE (tracker.isLost ()) << frame;
      const PoseError error (tracker.getPose ().inverse (), T_body_sensor (frame), center_);
      EXPECT_LT (error.shift_m, 1e-3) << frame;
      EXPECT_LT (error.angle_rad, radians (0.2)) << frame;
      steps[static_cast<int> (model)] += tracker.getAlignment ().iterations;
      const auto state = tracker.getResult ();
      EXPECT_GT (state.weight, 0.5f);
      EXPECT_LT ((tracker.toEigenMatrix (state).matrix ().cast<double> () - tracker.getPose ().matrix ()).norm (),
                 1e-5);
    }
  }
  EXPECT_LT (steps[1], steps[0]); // the velocity is a better guess

  const Eigen::Isometry3d last = tracker.getPose ();
  Cloud::Ptr elsewhere (new Cloud);
  for (int n = 0; n < 1000; ++n)
    elsewhere->push_back ({1.0f + 0.001f * n, 2.0f, 3.0f});
  tracker.setInputCloud (elsewhere);
  tracker.compute ();
  EXPECT_TRUE (tracker.isLost ());
  EXPECT_EQ (tracker.getResult ().weight, 0.0f);
  EXPECT_TRUE (tracker.getPose ().isApprox (last, 1e-12));
  tracker.setInputCloud (cloudOf (viewFrom (T_body_sensor (8)).points (body_camera)));
  tracker.compute ();
  EXPECT_FALSE (tracker.isLost ());
  tracker.setInputCloud (pcl::make_shared<Cloud> ());
  tracker.compute ();
  EXPECT_TRUE (tracker.isLost ());
}

TEST_F (SdfRegistrationTest, TrackerRefusesWhatIsNotValid)
{
  SdfTracker<pcl::PointXYZ> tracker;
  tracker.compute (); // no cloud
  EXPECT_TRUE (tracker.isLost ());
  tracker.setInputCloud (cloudOf (points_));
  tracker.compute (); // no volume
  EXPECT_TRUE (tracker.isLost ());
  EXPECT_FALSE (tracker.setSignedDistance (SignedDistanceField::ConstPtr ()));
  EXPECT_FALSE (tracker.setSignedDistance (TsdfVolume::ConstPtr ()));
  EXPECT_FALSE (tracker.setMinimumInlierShare (1.5f));
  Eigen::Affine3f wrong = Eigen::Affine3f::Identity ();
  wrong.linear () *= 3.0f;
  EXPECT_FALSE (tracker.setTrans (wrong));
}
