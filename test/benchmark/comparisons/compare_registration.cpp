// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// compare_registration [TRIALS]: views of toys are registered from poses up to 10 degrees and 5 cm away, with a model
// of the object: by SdfRegistration with its signed distance, by PCL's ICP and GICP with points and normals on the zero
// level set of the same signed distance. A row of a table for each. One thread each: PCL's use one. The first trial
// also builds the search trees. For views with noise, also the error from the true pose, beside the one that the
// information matrix expects of independent noise: less cannot be asked of any method.

#include "tracking/tracking_scene.h"

#include <pcl/cosection/tracking/sdf_registration.h>
#include <pcl/cosection/volume/iso_surface.h>

#include <pcl/point_types.h>
#include <pcl/registration/gicp.h>
#include <pcl/registration/icp.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <iomanip>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

const PinholeCamera camera{320, 240, 262.5, 262.5, 159.5, 119.5};
constexpr double distance_m = 0.7;
constexpr int resolution = 64;
constexpr double correspondence_m = 0.1; // PCL's: all that a trial may need
constexpr double good_shift_m = 1e-3;
constexpr double good_angle_deg = 0.2;

using Point = pcl::PointNormal;
using Cloud = pcl::PointCloud<Point>;
using Registration = pcl::Registration<Point, Point>;

Cloud::Ptr
modelCloud (const SignedDistanceField& field)
{
  const TriangleMesh mesh = extractIsoSurface (field);
  auto cloud = pcl::make_shared<Cloud> ();
  for (std::size_t v = 0; v < mesh.vertices.size (); ++v)
  {
    Point p;
    p.getVector3fMap () = mesh.vertices[v];
    p.getNormalVector3fMap () = mesh.normals[v];
    cloud->push_back (p);
  }
  return cloud;
}

/** \brief The points of a view with normals, which ICP asks for: true ones, by the distance's gradient. */
Cloud::Ptr
viewCloud (const BodyView& view, const SceneBody& body)
{
  constexpr double h = 1e-5;
  auto cloud = pcl::make_shared<Cloud> ();
  for (const Eigen::Vector3f& point : view.points (camera))
  {
    const Eigen::Vector3d p = view.T_body_sensor * point.cast<double> ();
    Eigen::Vector3d normal;
    for (int axis = 0; axis < 3; ++axis)
      normal[axis] = body.distance (p + h * Eigen::Vector3d::Unit (axis)) -
                     body.distance (p - h * Eigen::Vector3d::Unit (axis));
    Point q;
    q.getVector3fMap () = point;
    q.getNormalVector3fMap () = (view.T_body_sensor.linear ().transpose () * normal.normalized ()).cast<float> ();
    cloud->push_back (q);
  }
  return cloud;
}

struct View
{
  Eigen::Isometry3d T_body_sensor;
  Cloud::Ptr cloud;
};

double
quantile (std::vector<double> values, double share)
{
  std::sort (values.begin (), values.end ());
  return values[static_cast<std::size_t> (share * static_cast<double> (values.size () - 1))];
}

void
printRow (const std::string& name, Registration& registration, const std::vector<View>& views,
          const Eigen::Vector3d& center, int trials)
{
  std::mt19937 random (11);
  std::vector<double> shifts_mm, angles_deg, times_ms;
  int good = 0;
  for (int trial = 0; trial < trials; ++trial)
  {
    const View& view = views[trial % views.size ()];
    const Eigen::Isometry3d guess = randomMotion (random, center, radians (10.0), 0.05) * view.T_body_sensor;
    registration.setInputSource (view.cloud);
    Cloud aligned;
    const std::clock_t begin = std::clock ();
    registration.align (aligned, guess.matrix ().cast<float> ());
    const std::clock_t end = std::clock ();
    Eigen::Isometry3d found;
    found.matrix () = registration.getFinalTransformation ().cast<double> ();
    const PoseError error (found, view.T_body_sensor, center);
    shifts_mm.push_back (1e3 * error.shift_m);
    angles_deg.push_back (error.angle_rad * 180.0 / M_PI);
    times_ms.push_back (1e3 * static_cast<double> (end - begin) / CLOCKS_PER_SEC);
    good += error.shift_m < good_shift_m && angles_deg.back () < good_angle_deg;
  }
  std::printf ("| %s | %.1f %% | %.2f | %.2f | %.3f | %.2f | %.1f |\n", name.c_str (), 100.0 * good / trials,
               quantile (shifts_mm, 0.5), quantile (shifts_mm, 0.95), quantile (angles_deg, 0.5),
               quantile (angles_deg, 0.95), quantile (times_ms, 0.5));
  std::fflush (stdout);
}

/** \brief Standard deviation of the angle, as the information matrix has it, radians. \param[in] center about which the
 * shift is meant */
double
expectedAngle (const SdfAlignmentResult& result, const Eigen::Vector3d& center)
{
  using Matrix6d = SdfAlignmentResult::Matrix6d;
  Matrix6d to_center = Matrix6d::Identity (); // (t', omega) about the centre to (t, omega) about the origin: t = t' +
                                              // center x omega
  to_center.topRightCorner<3, 3> () << 0.0, -center.z (), center.y (), center.z (), 0.0, -center.x (), -center.y (),
      center.x (), 0.0;
  const Matrix6d covariance = result.rms_m * result.rms_m *
                              (to_center.transpose () * result.information * to_center).inverse ();
  return std::sqrt (covariance.bottomRightCorner<3, 3> ().trace ());
}

/** \brief From the true pose: how far noise moves it, and how far it may be expected to. */
std::string
describeLimit (const std::string& label, SdfRegistration<Point>& registration, const std::vector<View>& views,
               const Eigen::Vector3d& center)
{
  std::ostringstream text;
  text << std::fixed << std::setprecision (2) << "From the true pose" << label
       << ", angle / its expected standard deviation in degrees:";
  for (const View& view : views)
  {
    registration.setInputSource (view.cloud);
    Cloud aligned;
    registration.align (aligned, view.T_body_sensor.matrix ().cast<float> ());
    Eigen::Isometry3d found;
    found.matrix () = registration.getFinalTransformation ().cast<double> ();
    const PoseError error (found, view.T_body_sensor, center);
    constexpr double degrees = 180.0 / M_PI;
    text << ' ' << degrees * error.angle_rad << " / " << degrees * expectedAngle (registration.getAlignment (), center);
  }
  return text.str ();
}

/** \brief Print the rows. \return the limits of the noise */
std::string
compare (const std::string& name, int trials)
{
  std::string limits;
  const SceneBody body = presetBody ("toys", name);
  const Eigen::Vector3d center = bodyCenter (body);
  const auto field = std::make_shared<SignedDistanceField> (bodyDistance (body, resolution));
  const Cloud::Ptr model = modelCloud (*field);
  for (const bool noise : {false, true})
  {
    std::vector<View> views;
    for (const BodyView& view : renderBody (body, camera, posesAroundBody (center, distance_m, 10), noise))
      views.push_back ({view.T_body_sensor, viewCloud (view, body)});
    const std::string label = ", " + name + (noise ? ", noise" : "");

    SdfRegistration<Point> sdf;
    SdfAlignmentOptions options;
    options.threads = 1;
    sdf.setOptions (options);
    sdf.setSignedDistance (field);
    printRow ("`SdfRegistration`" + label, sdf, views, center, trials);

    pcl::IterativeClosestPointWithNormals<Point, Point> icp; // point to plane
    icp.setInputTarget (model);
    icp.setMaxCorrespondenceDistance (correspondence_m);
    icp.setMaximumIterations (100);
    icp.setTransformationEpsilon (1e-10);
    printRow ("`IterativeClosestPointWithNormals`" + label, icp, views, center, trials);

    pcl::GeneralizedIterativeClosestPoint<Point, Point> gicp;
    gicp.setInputTarget (model);
    gicp.setMaxCorrespondenceDistance (correspondence_m);
    gicp.setMaximumIterations (100);
    gicp.setTransformationEpsilon (1e-5);
    gicp.setRotationEpsilon (1e-5);
    printRow ("`GeneralizedIterativeClosestPoint`" + label, gicp, views, center, trials);
    if (noise)
      limits = describeLimit (label, sdf, views, center);
  }
  return limits;
}

} // namespace

int
main (int argc, char** argv)
{
  const int trials = argc > 1 ? std::atoi (argv[1]) : 100;
  if (trials < 1)
  {
    std::cerr << "Usage: compare_registration [TRIALS]\n";
    return 2;
  }
  try
  {
    std::printf ("| | good | shift, median mm | 95 %% | angle, median deg | 95 %% | CPU time, median ms "
                 "|\n|---|---|---|---|---|---|---|\n");
    std::string limits;
    for (const char* name : {"truck", "car"})
      limits += '\n' + compare (name, trials) + '\n';
    std::cout << limits;
    return 0;
  }
  catch (const std::exception& error)
  {
    std::cerr << "compare_registration: " << error.what () << '\n';
    return 1;
  }
}
