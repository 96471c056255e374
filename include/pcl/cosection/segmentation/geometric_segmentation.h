// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/segmentation/object_segmentation.h>

#include <pcl/ModelCoefficients.h>
#include <pcl/PointIndices.h>
#include <pcl/pcl_base.h>
#include <pcl/point_cloud.h>

#include <vector>

namespace pcl
{
struct Label;

namespace cosection
{

/** \brief Finds the objects in an organised cloud by their geometry alone: without masks, colour or learned weights.
 * segmentObjects () says how.
 *
 * \code
 * pcl::cosection::GeometricSegmentation<pcl::PointXYZRGB> segmentation;
 * segmentation.setInputCloud (cloud); // organised, in its sensor's frame, metres
 * pcl::PointCloud<pcl::Label> labels;
 * std::vector<pcl::PointIndices> label_indices;
 * segmentation.segment (labels, label_indices); // label_indices[0] are the points of object 1
 * \endcode
 *
 * setIndices () works: other points count as no reading. What is left out may hide what objects stand on.
 *
 * Instantiated for pcl::PointXYZ, PointXYZI, PointXYZRGB, PointXYZRGBA, PointXYZRGBL, PointNormal, PointXYZRGBNormal
 * and PointXYZINormal; for other types define PCL_NO_PRECOMPILE before the include. */
template <typename PointT> class PCL_COSECTION_EXPORT GeometricSegmentation : public PCLBase<PointT>
{
  using Base = PCLBase<PointT>;

public:
  using Ptr = shared_ptr<GeometricSegmentation<PointT>>;
  using ConstPtr = shared_ptr<const GeometricSegmentation<PointT>>;
  using PointCloud = pcl::PointCloud<PointT>;

  /** \brief What is longer is furniture or room, metres; default 0.5. \throws InvalidArgument */
  void setMaximumObjectSize (double size_m);

  double getMaximumObjectSize () const { return options_.max_object_size_m; }

  /** \brief What is shorter is no object, metres; default 0.02. \throws InvalidArgument */
  void setMinimumObjectSize (double size_m);

  double getMinimumObjectSize () const { return options_.min_object_size_m; }

  /** \brief A crease that is concave by more than this angle separates two objects, radians; default 0.45.
   * \throws InvalidArgument */
  void setConcaveAngle (double angle_rad);

  double getConcaveAngle () const { return options_.concave_angle_rad; }

  /** \brief All parameters in one. \throws InvalidArgument */
  void setOptions (const ObjectSegmentationOptions& options);

  /** \brief 0 (default): all processors. */
  void setNumberOfThreads (unsigned int threads = 0);

  /** \brief Find the objects.
   * \param[out] labels one per point of the input cloud, of its width and height: 0 background, 1 ... objects
   * \param[out] label_indices points of each object, in their order; those of label n are label_indices[n - 1]
   *
   * Without an organised input cloud, and where there is no plane that objects could stand on, this says so on PCL's
   * console, and both are empty. */
  void segment (pcl::PointCloud<pcl::Label>& labels, std::vector<pcl::PointIndices>& label_indices);

  /** \brief The planes that the last segment () took for the room, as pcl::SACSegmentation gives them. */
  const std::vector<pcl::ModelCoefficients>& getSupportPlanes () const { return support_planes_; }

protected:
  using Base::deinitCompute;
  using Base::indices_;
  using Base::initCompute;
  using Base::input_;

private:
  ObjectSegmentationOptions options_;
  std::vector<pcl::ModelCoefficients> support_planes_;
};

} // namespace cosection
} // namespace pcl

#ifdef PCL_NO_PRECOMPILE
#include <pcl/cosection/segmentation/impl/geometric_segmentation.hpp>
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
extern template class PCL_COSECTION_EXPORT GeometricSegmentation<pcl::PointXYZ>;
extern template class PCL_COSECTION_EXPORT GeometricSegmentation<pcl::PointXYZI>;
extern template class PCL_COSECTION_EXPORT GeometricSegmentation<pcl::PointXYZRGB>;
extern template class PCL_COSECTION_EXPORT GeometricSegmentation<pcl::PointXYZRGBA>;
extern template class PCL_COSECTION_EXPORT GeometricSegmentation<pcl::PointXYZRGBL>;
extern template class PCL_COSECTION_EXPORT GeometricSegmentation<pcl::PointNormal>;
extern template class PCL_COSECTION_EXPORT GeometricSegmentation<pcl::PointXYZRGBNormal>;
extern template class PCL_COSECTION_EXPORT GeometricSegmentation<pcl::PointXYZINormal>;
} // namespace cosection
} // namespace pcl
#endif
