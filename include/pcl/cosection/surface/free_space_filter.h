// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/export.h>
#include <pcl/cosection/surface/free_space_votes.h>

#include <pcl/filters/filter_indices.h>

#include <vector>

namespace pcl::cosection
{

/** \brief Removes points that depth views contradict: those in space that more views look through than see a surface
 * in (voteOnPoints ()). Flying pixels, ghosts of what moved between views, and points of a view with a wrong pose are
 * such. A single view does not contradict its own points.
 *
 * \code
 * pcl::cosection::FreeSpaceFilter<pcl::PointXYZRGB> filter;
 * filter.setInputCloud (merged);            // points of all views, one frame, metres
 * filter.addView (view_1, T_merged_sensor_1); // organised, in its sensor's frame
 * filter.addView (view_2, T_merged_sensor_2);
 * filter.filter (*clean);
 * \endcode
 *
 * As in PCL's filters the output is in the order of the indices; setIndices (), setNegative (), setKeepOrganized () and
 * getRemovedIndices () work; points that are not finite are removed, in negative too. Without a view every finite point
 * passes, with a warning. O (points * views), in parallel over the points; the result does not depend on the number of
 * threads.
 *
 * Instantiated for pcl::PointXYZ, PointXYZI, PointXYZRGB, PointXYZRGBA, PointXYZRGBL, PointNormal, PointXYZRGBNormal
 * and PointXYZINormal; for other types define PCL_NO_PRECOMPILE before the include. */
template <typename PointT> class PCL_COSECTION_EXPORT FreeSpaceFilter : public FilterIndices<PointT>
{
  using Base = FilterIndices<PointT>;

public:
  using Ptr = shared_ptr<FreeSpaceFilter<PointT>>;
  using ConstPtr = shared_ptr<const FreeSpaceFilter<PointT>>;
  using PointCloud = pcl::PointCloud<PointT>;

  /** \param[in] extract_removed_indices keep the indices of what is removed, for getRemovedIndices () */
  explicit FreeSpaceFilter (bool extract_removed_indices = false);
  ~FreeSpaceFilter () override; // elsewhere, so that programs need no libpcl_filters for the base's

  /** \brief Add a view of the scene.
   * \param[in] cloud organised, in its sensor's frame (x right, y down, z forward), as a pinhole sees it;
   * not finite: no reading
   * \param[in] T_cloud_sensor pose of the sensor in the frame of the input cloud
   * \return false, with a message, if the cloud is not the image of a pinhole camera
   * \throws InvalidArgument if the pose is not finite */
  template <typename PointViewT>
  bool addView (const pcl::PointCloud<PointViewT>& cloud,
                const Eigen::Isometry3d& T_cloud_sensor = Eigen::Isometry3d::Identity ());

  /** \brief The same as a depth image; its T_world_sensor is T_cloud_sensor. \throws InvalidArgument */
  void addView (const DepthView& view);

  void clearViews ();

  /** \brief How much the depth along a ray must exceed that of a point for the point to be free, metres; 0 (default):
   * max (5 mm, 3 sigma_z) at the depth of the reading, pointMargin (). \throws InvalidArgument */
  void setMargin (float margin_m);

  float getMargin () const { return margin_m_; }

  /** \brief Views that must look through a point to remove it, besides being more than see a surface there; default 1.
   * \throws InvalidArgument */
  void setMinimumViews (int views);

  int getMinimumViews () const { return minimum_views_; }

  /** \brief 0 (default): all processors. */
  void setNumberOfThreads (unsigned int threads = 0);

protected:
  using Base::applyFilter;
  using Base::extract_removed_indices_;
  using Base::filter_name_;
  using Base::getClassName;
  using Base::indices_;
  using Base::input_;
  using Base::negative_;
  using Base::removed_indices_;

  /** \brief \param[out] indices of the points that pass, in the order of the input's */
  void applyFilter (Indices& indices) override;

private:
  std::vector<FreeSpaceView> views_;
  float margin_m_ = 0.0f;
  int minimum_views_ = 1;
  unsigned int threads_ = 0;
};

} // namespace pcl::cosection

#include <pcl/cosection/surface/impl/free_space_filter_view.hpp>

#ifdef PCL_NO_PRECOMPILE
#include <pcl/cosection/surface/impl/free_space_filter.hpp>
#else
namespace pcl
{
struct PointXYZ;
struct PointXYZI;
struct PointXYZRGB;
struct PointXYZRGBA;
struct PointXYZRGBL;
struct PointNormal;
struct PointXYZRGBNormal;
struct PointXYZINormal;
namespace cosection
{
extern template class PCL_COSECTION_EXPORT FreeSpaceFilter<pcl::PointXYZ>;
extern template class PCL_COSECTION_EXPORT FreeSpaceFilter<pcl::PointXYZI>;
extern template class PCL_COSECTION_EXPORT FreeSpaceFilter<pcl::PointXYZRGB>;
extern template class PCL_COSECTION_EXPORT FreeSpaceFilter<pcl::PointXYZRGBA>;
extern template class PCL_COSECTION_EXPORT FreeSpaceFilter<pcl::PointXYZRGBL>;
extern template class PCL_COSECTION_EXPORT FreeSpaceFilter<pcl::PointNormal>;
extern template class PCL_COSECTION_EXPORT FreeSpaceFilter<pcl::PointXYZRGBNormal>;
extern template class PCL_COSECTION_EXPORT FreeSpaceFilter<pcl::PointXYZINormal>;
} // namespace cosection
} // namespace pcl
#endif
