// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "support_plane.h"

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/sample_consensus/ransac.h>
#include <pcl/sample_consensus/sac_model_plane.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace pcl::cosection {
namespace {

constexpr double min_reach_m = 0.05;
constexpr double line_sigma_m = 5e-4; // standard deviation of points on one line
constexpr int max_ransac_iterations = 500;
constexpr std::size_t max_points = 20000; // RANSAC uses an even subset of no more

/** \brief PCL's plane model that redraws samples of nearly collinear points without an error message: such samples are
 * frequent among points some millimetres apart. */
class PlaneModel : public pcl::SampleConsensusModelPlane<pcl::PointXYZ>
{
public:
  using SampleConsensusModelPlane::SampleConsensusModelPlane;

protected:
  bool isSampleGood (const pcl::Indices& samples) const override
  {
    const Eigen::Vector3f p = (*input_)[samples[0]].getVector3fMap ();
    const Eigen::Vector3f a = (*input_)[samples[1]].getVector3fMap () - p;
    const Eigen::Vector3f b = (*input_)[samples[2]].getVector3fMap () - p;
    return a.cross (b).stableNorm () >= Eigen::NumTraits<float>::dummy_precision (); // as PCL asks of them
  }
};

/** \brief Whether points are not collinear, so that they determine a plane. */
bool
spanPlane (const pcl::PointCloud<pcl::PointXYZ>& cloud, const pcl::Indices& indices)
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
  return eigen.eigenvalues ()[1] > line_sigma_m * line_sigma_m;
}

double
height (const Eigen::Vector4d& plane, const OrientedPoint& point)
{
  return plane.head<3> ().dot (point.position.cast<double> ()) + plane[3];
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
  const float margin = static_cast<float> (std::max (min_reach_m, options.reach * box.sizes ().maxCoeff ()));
  box.min ().array () -= margin;
  box.max ().array () += margin;

  std::vector<OrientedPoint> near;
  for (const OrientedPoint& p : background)
    if (box.contains (p.position))
      near.push_back (p);
  const std::size_t stride = near.size () / max_points + 1;
  const pcl::PointCloud<pcl::PointXYZ>::Ptr cloud (new pcl::PointCloud<pcl::PointXYZ>);
  std::vector<const OrientedPoint*> source;
  for (std::size_t n = 0; n < near.size (); n += stride)
  {
    cloud->push_back (pcl::PointXYZ (near[n].position.x (), near[n].position.y (), near[n].position.z ()));
    source.push_back (&near[n]);
  }
  const auto enough = static_cast<std::size_t> (
      std::max (static_cast<double> (options.min_inliers) / static_cast<double> (stride),
                options.min_inlier_share * static_cast<double> (cloud->size ())));

  pcl::Indices remaining (cloud->size ());
  for (std::size_t n = 0; n < remaining.size (); ++n)
    remaining[n] = static_cast<pcl::index_t> (n);
  while (static_cast<int> (planes.size ()) < options.max_planes &&
         remaining.size () >= std::max<std::size_t> (3, enough) && spanPlane (*cloud, remaining))
  {
    const pcl::SampleConsensusModelPlane<pcl::PointXYZ>::Ptr model (new PlaneModel (cloud, remaining));
    pcl::RandomSampleConsensus<pcl::PointXYZ> ransac (model, options.inlier_distance_m);
    ransac.setMaxIterations (max_ransac_iterations);
    if (!ransac.computeModel ())
      break;
    Eigen::VectorXf coefficients, refined;
    ransac.getModelCoefficients (coefficients);
    pcl::Indices inliers;
    ransac.getInliers (inliers);
    if (inliers.size () < enough)
      break;
    model->optimizeModelCoefficients (inliers, coefficients, refined);
    model->selectWithinDistance (refined, options.inlier_distance_m, inliers);
    if (inliers.size () < enough)
      break;
    Eigen::Vector4d plane = refined.head<4> ().cast<double> ();
    plane /= plane.head<3> ().norm ();
    double facing = 0.0;
    for (const pcl::index_t i : inliers)
      facing += plane.head<3> ().dot (source[i]->normal.cast<double> ());
    if (facing < 0.0)
      plane = -plane;
    const auto below = std::count_if (object.begin (), object.end (), [&] (const OrientedPoint& p) {
      return height (plane, p) < -options.inlier_distance_m;
    });
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
