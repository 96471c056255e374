// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "support_plane.h"

#include "pcl_cosection/io/quiet_console.h"

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/sample_consensus/ransac.h>
#include <pcl/sample_consensus/sac_model_plane.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl::cosection {
namespace {

constexpr double default_inlier_distance = 0.05; // of the longest side of the object
constexpr double min_reach_noise = 36.0;         // in standard deviations of the points
constexpr double line_share = 0.1;               // of the inlier distance: standard deviation of points on one line
constexpr double good_sample = 1e-4;             // least area of a sample, of the squared reach
constexpr int max_ransac_iterations = 500;
constexpr std::size_t max_points = 20000; // RANSAC uses an even subset of no more

/** \brief PCL's plane model that redraws samples of nearly collinear points without an error message. PCL's own limit
 * is an area of 1e-5, whatever the unit; the points here are scaled, so that it is below this one's. */
class PlaneModel : public pcl::SampleConsensusModelPlane<pcl::PointXYZ>
{
public:
  PlaneModel (const PointCloudConstPtr& cloud, const pcl::Indices& indices, double least_area)
      : SampleConsensusModelPlane (cloud, indices)
      , least_area_ (static_cast<float> (least_area))
  {}

protected:
  bool isSampleGood (const pcl::Indices& samples) const override
  {
    const Eigen::Vector3f p = (*input_)[samples[0]].getVector3fMap ();
    const Eigen::Vector3f a = (*input_)[samples[1]].getVector3fMap () - p;
    const Eigen::Vector3f b = (*input_)[samples[2]].getVector3fMap () - p;
    return a.cross (b).stableNorm () >= least_area_;
  }

private:
  float least_area_;
};

/** \brief Whether points are not collinear, so that they determine a plane. */
bool
spanPlane (const pcl::PointCloud<pcl::PointXYZ>& cloud, const pcl::Indices& indices, double inlier_distance)
{
  Eigen::Vector3d mean = Eigen::Vector3d::Zero ();
  for (const pcl::index_t i : indices)
    mean += cloud[i].getVector3fMap ().cast<double> () / static_cast<double> (indices.size ());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero ();
  for (const pcl::index_t i : indices)
  {
    const Eigen::Vector3d p = cloud[i].getVector3fMap ().cast<double> () - mean;
    scatter += p * p.transpose () / static_cast<double> (indices.size ());
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen (scatter, Eigen::EigenvaluesOnly);
  return eigen.eigenvalues ()[1] > std::pow (line_share * inlier_distance, 2);
}

/** \brief The power of two that makes a length at least one half and less than one; scaling by it rounds nothing. */
double
scaleToUnit (double length)
{
  int exponent = 0;
  std::frexp (length, &exponent);
  return std::ldexp (1.0, -exponent);
}

double
height (const Eigen::Vector4d& plane, const OrientedPoint& point)
{
  return plane.head<3> ().dot (point.position.cast<double> ()) + plane[3];
}

/** \brief The plane in metres, on the side of which the normals of its points are. \param[in] found of scaled points */
Eigen::Vector4d
orientedPlane (const Eigen::VectorXf& found, double scale, const std::vector<const OrientedPoint*>& points,
               const pcl::Indices& inliers)
{
  Eigen::Vector4d plane = found.head<4> ().cast<double> ();
  plane /= plane.head<3> ().norm ();
  plane[3] /= scale;
  double facing = 0.0;
  for (const pcl::index_t i : inliers)
    facing += plane.head<3> ().dot (points[i]->normal.cast<double> ());
  return facing < 0.0 ? Eigen::Vector4d (-plane) : plane;
}

} // namespace

std::vector<Eigen::Vector4d>
findSupportPlanes (const std::vector<OrientedPoint>& background, const std::vector<OrientedPoint>& object,
                   const SupportPlaneOptions& options)
{
  std::vector<Eigen::Vector4d> planes;
  if (object.empty ())
    return planes;
  Eigen::AlignedBox3f box;
  for (const OrientedPoint& p : object)
    box.extend (p.position);
  const double longest_m = box.sizes ().maxCoeff ();
  const double inlier_m = options.inlier_distance_m > 0.0 ? options.inlier_distance_m
                                                          : default_inlier_distance * longest_m;
  const auto margin = static_cast<float> (std::max (min_reach_noise * options.noise_m, options.reach * longest_m));
  box.min ().array () -= margin;
  box.max ().array () += margin;
  const double reach_m = box.sizes ().maxCoeff ();
  if (!(reach_m >= std::numeric_limits<float>::min () && std::isfinite (reach_m)))
    return planes;
  const double scale = scaleToUnit (reach_m), inlier_distance = scale * inlier_m;

  std::vector<OrientedPoint> near;
  for (const OrientedPoint& p : background)
    if (box.contains (p.position))
      near.push_back (p);
  const std::size_t stride = near.size () / max_points + 1;
  const pcl::PointCloud<pcl::PointXYZ>::Ptr cloud (new pcl::PointCloud<pcl::PointXYZ>);
  std::vector<const OrientedPoint*> source;
  for (std::size_t n = 0; n < near.size (); n += stride)
  {
    const Eigen::Vector3f p = static_cast<float> (scale) * near[n].position;
    cloud->push_back (pcl::PointXYZ (p.x (), p.y (), p.z ()));
    source.push_back (&near[n]);
  }
  const auto enough = static_cast<std::size_t> (
      std::max (static_cast<double> (options.min_inliers) / static_cast<double> (stride),
                options.min_inlier_share * static_cast<double> (cloud->size ())));

  const double least_area = good_sample * std::pow (scale * reach_m, 2);
  pcl::Indices remaining (cloud->size ());
  for (std::size_t n = 0; n < remaining.size (); ++n)
    remaining[n] = static_cast<pcl::index_t> (n);
  while (static_cast<int> (planes.size ()) < options.max_planes &&
         remaining.size () >= std::max<std::size_t> (3, enough) && spanPlane (*cloud, remaining, inlier_distance))
  {
    const pcl::SampleConsensusModelPlane<pcl::PointXYZ>::Ptr model (new PlaneModel (cloud, remaining, least_area));
    pcl::RandomSampleConsensus<pcl::PointXYZ> ransac (model, inlier_distance);
    ransac.setMaxIterations (max_ransac_iterations);
    const QuietConsole quiet; // points that span no plane are no error
    if (!ransac.computeModel ())
      break;
    Eigen::VectorXf coefficients, refined;
    ransac.getModelCoefficients (coefficients);
    pcl::Indices inliers;
    ransac.getInliers (inliers);
    if (inliers.size () < enough)
      break;
    model->optimizeModelCoefficients (inliers, coefficients, refined);
    model->selectWithinDistance (refined, inlier_distance, inliers);
    if (inliers.size () < enough)
      break;
    const Eigen::Vector4d plane = orientedPlane (refined, scale, source, inliers);
    const auto below = std::count_if (object.begin (), object.end (),
                                      [&] (const OrientedPoint& p) { return height (plane, p) < -inlier_m; });
    if (static_cast<double> (below) <= options.max_below * static_cast<double> (object.size ()))
      planes.push_back (plane);
    pcl::Indices rest;
    std::sort (inliers.begin (), inliers.end ());
    std::set_difference (remaining.begin (), remaining.end (), inliers.begin (), inliers.end (),
                         std::back_inserter (rest));
    if (rest.size () == remaining.size ())
      break;
    remaining.swap (rest);
  }
  return planes;
}

} // namespace pcl::cosection
