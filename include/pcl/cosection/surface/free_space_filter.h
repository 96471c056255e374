// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/point_types.h>

#include <pcl/filters/filter_indices.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace pcl::cosection {

class FreeSpaceView;

/** \brief The views and parameters of FreeSpaceFilter, which do not depend on the type of its points.
 *
 * A setter that cannot use what it gets says why through PCL's console, changes nothing and returns false. */
class PCL_COSECTION_EXPORT FreeSpaceFilterBase
{
public:
  /** \brief Add a view of the scene.
   * \param[in] cloud organised, in its sensor's frame (x right, y down, z forward), as a pinhole camera sees it;
   * not finite: no reading
   * \param[in] T_cloud_sensor pose of the sensor in the frame of the input cloud
   * \return false if the cloud is not the image of a pinhole camera, or the pose is not finite */
  template <typename PointViewT>
  bool addView (const pcl::PointCloud<PointViewT>& cloud,
                const Eigen::Isometry3d& T_cloud_sensor = Eigen::Isometry3d::Identity ())
  {
    return addCloud (toDepthView (cloud, T_cloud_sensor));
  }

  /** \brief Add a depth image whose T_world_sensor is T_cloud_sensor. \return false if it is not valid */
  bool addView (const DepthView& view);

  /** \brief Forget all views. */
  void clearViews ();

  /** \brief Set how much the depth along a ray must exceed that of a point for the point to be free, metres; 0
   * (default): the larger of 0.5 % of the view's working range and of 3 sigma_z, with the standard deviation sigma_z of
   * the reading's depth (depthNoiseSigma ()). */
  bool setMargin (float margin_m);

  /** \brief The margin, metres; 0: that of the sensor's noise. */
  float getMargin () const { return margin_m_; }

  /** \brief Set how many views must look through a point to remove it, besides being more than see a surface there;
   * at least 1 (default). */
  bool setMinimumViews (int views);

  /** \brief How many views must look through a point to remove it. */
  int getMinimumViews () const { return minimum_views_; }

  /** \brief Set the number of threads; 0 (default): all processors. The result does not depend on it. */
  void setNumberOfThreads (unsigned int threads = 0) { threads_ = threads; }

protected:
  FreeSpaceFilterBase ();
  /** \brief The copy has the same views and parameters. */
  FreeSpaceFilterBase (const FreeSpaceFilterBase& other);
  /** \brief Takes over the views and parameters of another one. */
  FreeSpaceFilterBase& operator= (const FreeSpaceFilterBase& other);
  ~FreeSpaceFilterBase ();

  /** \brief Which points the views contradict; says so where there is no view. \return one per point, 1: contradicted
   */
  std::vector<std::uint8_t> contradicted (const std::vector<Eigen::Vector3f>& points) const;

private:
  bool addCloud (const std::optional<DepthView>& view);

  std::vector<FreeSpaceView> views_;
  float margin_m_ = 0.0f;
  int minimum_views_ = 1;
  unsigned int threads_ = 0;
};

/** \brief Removes points that depth views contradict: those in space that more views look through than see a surface
 * in. Mixed pixels, ghosts of what moved between views, and points of a view with a wrong pose are such. A single view
 * does not contradict its own points.
 *
 * A view looks through a point when every reading around the point's pixel is farther than the point by more than the
 * margin. "Around" is as far as the margin reaches sideways, so that a point a little off a surface that is seen at a
 * grazing angle is not taken for free. A view sees a surface at a point when its reading there is within the margin.
 * Missing readings say nothing. A reading at a depth edge says at most that there is a surface, and that only if at
 * least three of its eight neighbours have the same depth: a mixed pixel does not support itself.
 *
 * \code
 * pcl::cosection::FreeSpaceFilter<pcl::PointXYZRGB> filter;
 * filter.setInputCloud (merged);              // points of all views, one frame, metres
 * filter.addView (view_1, T_merged_sensor_1); // organised, in its sensor's frame
 * filter.addView (view_2, T_merged_sensor_2);
 * filter.filter (*clean);
 * \endcode
 *
 * As in PCL's filters the output is in the order of the indices; setIndices (), setNegative (), setKeepOrganized () and
 * getRemovedIndices () work; points that are not finite are removed, in negative too. Without a view every finite point
 * passes, with a warning. O (points * views), in parallel over the points.
 *
 * Compiled for pcl::PointXYZ, PointXYZI, PointXYZRGB, PointXYZRGBA, PointXYZRGBL, PointNormal, PointXYZRGBNormal
 * and PointXYZINormal; works for others where PCL's filters do (define PCL_NO_PRECOMPILE before the include). */
template <typename PointT>
class PCL_COSECTION_EXPORT FreeSpaceFilter : public FilterIndices<PointT>, public FreeSpaceFilterBase
{
  using Base = FilterIndices<PointT>;

public:
  /** \brief Shared pointer. */
  using Ptr = shared_ptr<FreeSpaceFilter<PointT>>;
  /** \brief Shared pointer to what is constant. */
  using ConstPtr = shared_ptr<const FreeSpaceFilter<PointT>>;
  /** \brief Cloud of the points. */
  using PointCloud = pcl::PointCloud<PointT>;

  /** \brief A filter without views.
   * \param[in] extract_removed_indices keep the indices of what is removed, for getRemovedIndices () */
  explicit FreeSpaceFilter (bool extract_removed_indices = false);

  ~FreeSpaceFilter () override; // not inline, so that programs need no libpcl_filters for the base's

protected:
  using Base::applyFilter;
  using Base::extract_removed_indices_;
  using Base::filter_name_;
  using Base::indices_;
  using Base::input_;
  using Base::negative_;
  using Base::removed_indices_;

  /** \brief Filter. \param[out] indices of the points that pass, in the order of the input's */
  void applyFilter (Indices& indices) override;
};

template <typename PointT>
FreeSpaceFilter<PointT>::FreeSpaceFilter (bool extract_removed_indices) : Base (extract_removed_indices)
{
  filter_name_ = "cosection::FreeSpaceFilter";
}

template <typename PointT> FreeSpaceFilter<PointT>::~FreeSpaceFilter () = default;

template <typename PointT>
void
FreeSpaceFilter<PointT>::applyFilter (Indices& indices)
{
  std::vector<Eigen::Vector3f> points;
  points.reserve (indices_->size ());
  for (const auto i : *indices_)
    points.push_back ((*input_)[i].getVector3fMap ());
  const std::vector<std::uint8_t> contradicted_points = contradicted (points);

  Indices passed, removed; // what they go to may be the indices of the input
  passed.reserve (points.size ());
  for (std::size_t n = 0; n < points.size (); ++n)
  {
    const auto i = (*indices_)[n];
    if (points[n].allFinite () && (contradicted_points[n] != 0) == negative_)
      passed.push_back (i);
    else if (extract_removed_indices_)
      removed.push_back (i);
  }
  indices = std::move (passed);
  *removed_indices_ = std::move (removed);
}

BOOST_PP_SEQ_FOR_EACH (PCL_COSECTION_EXTERN_TEMPLATE, FreeSpaceFilter, PCL_COSECTION_XYZ_POINT_TYPES)

} // namespace pcl::cosection
