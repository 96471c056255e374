// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// The code of doc/tutorial_tracking.md, on a simulated car that drives past a depth camera.

#include <pcl/cosection/simulation/scene_renderer.h>
#include <pcl/cosection/simulation/simulated_scene.h>
#include <pcl/cosection/tracking/sdf_registration.h>
#include <pcl/cosection/tracking/sdf_tracker.h>

#include <pcl/point_types.h>

#include <iostream>
#include <memory>
#include <vector>

namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

/** \brief The toys that come with the library, of which we follow the car. */
class Scene
{
public:
  Scene ()
  {
    for (const auto& preset : pcl::cosection::scenePresets ())
      if (preset.name == "toys")
        scene_ = pcl::cosection::parseSceneSpec (preset.spec, preset.name);
    scene_.camera = {320, 240, 262.5, 262.5, 159.5, 119.5};
    renderer_ = std::make_unique<pcl::cosection::SceneRenderer> (scene_);
  }

  /** \brief The points of the car in a frame, as a segmentation gives them. */
  Cloud::Ptr cloud (int frame) const
  {
    const auto image = renderer_->render (scene_.timeOf (frame));
    auto cloud = pcl::make_shared<Cloud> ();
    for (int v = 0; v < scene_.camera.height; ++v)
      for (int u = 0; u < scene_.camera.width; ++u)
        if (image.mask.at (u, v) == car ().id)
        {
          const Eigen::Vector3f p = scene_.camera.unproject (u, v, image.depth.at (u, v)).cast<float> ();
          cloud->push_back ({p.x (), p.y (), p.z ()});
        }
    return cloud;
  }

  Eigen::Affine3f T_sensor_car (int frame) const
  {
    const double time = scene_.timeOf (frame);
    return Eigen::Affine3f (
        (scene_.camera_motion.at (time).inverse () * car ().motion.at (time)).matrix ().cast<float> ());
  }

  /** \brief What is known of its shape: here everything. */
  pcl::cosection::SignedDistanceField::ConstPtr shape () const
  {
    auto field = std::make_shared<pcl::cosection::SignedDistanceField> ();
    auto& grid = field->grid;
    grid.dims = {72, 48, 40};
    grid.voxel_size_m = 0.005;
    grid.origin_m = {-0.1775, -0.1175, -0.035};
    for (int k = 0; k < grid.dims.z (); ++k)
      for (int j = 0; j < grid.dims.y (); ++j)
        for (int i = 0; i < grid.dims.x (); ++i)
          field->values.push_back (static_cast<float> (car ().distance (grid.center (i, j, k))));
    return field;
  }

private:
  const pcl::cosection::SceneBody& car () const { return scene_.bodies.at (2); }

  pcl::cosection::SimulatedScene scene_;
  std::unique_ptr<pcl::cosection::SceneRenderer> renderer_;
};

bool
registerCloud (const pcl::cosection::SignedDistanceField::ConstPtr& shape, const Cloud::Ptr& cloud,
               const Eigen::Matrix4f& T_car_sensor_roughly)
{
  pcl::cosection::SdfRegistration<pcl::PointXYZ> registration;
  registration.setSignedDistance (shape);
  registration.setInputSource (cloud);
  Cloud aligned;
  registration.align (aligned, T_car_sensor_roughly);
  if (registration.hasConverged ())
    std::cout << registration.getFinalTransformation () << '\n';
  std::cout << "determined directions: " << registration.getAlignment ().observed_directions << " of 6\n";
  return registration.hasConverged () && registration.getAlignment ().rms_m < 1e-3;
}

bool
follow (const pcl::cosection::SignedDistanceField::ConstPtr& shape, const Scene& scene, const std::vector<int>& frames)
{
  pcl::cosection::SdfTracker<pcl::PointXYZ> tracker;
  tracker.setSignedDistance (shape);
  tracker.setTrans (scene.T_sensor_car (frames.front ()));
  for (const int frame : frames)
  {
    tracker.setInputCloud (scene.cloud (frame));
    tracker.compute ();
    if (tracker.isLost ())
      return false;
    const Eigen::Affine3f T_sensor_car = tracker.toEigenMatrix (tracker.getResult ());
    std::cout << frame << ": " << T_sensor_car.translation ().transpose () << '\n';
  }
  return (tracker.getPose ().translation ().cast<float> () - scene.T_sensor_car (frames.back ()).translation ())
             .norm () < 1e-3f;
}

} // namespace

int
main ()
{
  const Scene scene;
  const auto shape = scene.shape ();
  std::vector<int> frames;
  for (int frame = 0; frame <= 60; frame += 3)
    frames.push_back (frame);
  Eigen::Affine3f roughly = scene.T_sensor_car (10).inverse ();
  roughly.pretranslate (Eigen::Vector3f (0.02f, -0.02f, 0.01f));
  return registerCloud (shape, scene.cloud (10), roughly.matrix ()) && follow (shape, scene, frames) ? 0 : 1;
}
