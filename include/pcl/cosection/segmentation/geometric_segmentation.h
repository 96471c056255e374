// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/point_types.h>

#include <pcl/ModelCoefficients.h>
#include <pcl/PointIndices.h>
#include <pcl/pcl_base.h>
#include <pcl/point_cloud.h>

#include <Eigen/Core>

#include <cstdint>
#include <limits>
#include <vector>

namespace pcl {
struct Label;
}

namespace pcl::cosection {

/** \brief Parameters of segmentObjects (). */
struct PCL_COSECTION_EXPORT ObjectSegmentationOptions
{
  double max_object_size_m = 0.5;    ///< what is longer is furniture or room
  double min_object_size_m = 0.02;   ///< what is shorter is no object
  double min_support_area_m2 = 0.03; ///< the largest plane must have so much surface in view to carry objects
  double concave_angle_rad = 0.45;   ///< a crease that is concave by more than this separates two objects
  int threads = 0;                   ///< 0: all

  /** \brief Check all values. \throws InvalidArgument naming the first one outside its domain. */
  void validate () const;
};

/** \brief What segmentObjects () finds. */
struct PCL_COSECTION_EXPORT ObjectSegmentation
{
  std::vector<std::uint32_t> labels;           ///< one per point: 0 background or no reading, 1 ... objects
  std::vector<std::uint8_t> too_long;          ///< one per point: 1 would be part of an object, but that is too long
  std::uint32_t objects = 0;                   ///< number of them, larger ones in the image first
  std::vector<Eigen::Vector4f> support_planes; ///< (n, d), n.x + d = 0, unit n towards the sensor; best seen first
};

/** \brief Finds the objects of a scene in one organised cloud by their geometry alone.
 *
 * Planes are taken for the room and its furniture as far as they are longer than an object, or enclosed: what is seen
 * beside them rises before them, as it does around the back of a shelf's compartment, while the face of an object ends
 * freely. What stands in front of them is divided into small patches of one orientation; neighbouring patches belong
 * together where they meet smoothly or at a convex edge, and apart where they meet at a concave one (S. C. Stein,
 * M. Schoeler, J. Papon, F. Woergoetter, "Object Partitioning using Local Convexity", CVPR 2014). The evidence of all
 * edges is weighed by greedy additive edge contraction (M. Keuper et al., "Efficient Decomposition of Image and Mesh
 * Graphs by Lifted Multicuts", ICCV 2015), so that a few wrong edges do not join two objects. Pieces of one surface
 * that something in front divides, and the inside of hollow things, are put together again.
 *
 * \param[in] points width * height points, row by row, in the sensor's frame (sensor at the origin), metres; not
 * finite: no reading
 * \param[in] width, height pixels
 * \param[in] options lengths and angles
 * \throws InvalidArgument if the sizes do not agree or an option is outside its domain
 * \throws DegenerateInput if there are no readings, or no plane in view that objects could stand on
 *
 * The result does not depend on the number of threads.
 * \code
 * const auto scene = segmentObjects (points, 640, 480);
 * \endcode */
PCL_COSECTION_EXPORT ObjectSegmentation segmentObjects (const std::vector<Eigen::Vector3f>& points, int width,
                                                        int height, const ObjectSegmentationOptions& options = {});

/** \brief The parameters and last result of GeometricSegmentation, which do not depend on the type of its points.
 *
 * A setter that cannot use what it gets says why through PCL's console, changes nothing and returns false. */
class PCL_COSECTION_EXPORT GeometricSegmentationBase
{
public:
  /** \brief Set the length from which on something is furniture or room, metres; default 0.5. */
  bool setMaximumObjectSize (double size_m);

  /** \brief The length from which on something is furniture or room, metres. */
  double getMaximumObjectSize () const { return options_.max_object_size_m; }

  /** \brief Set the length below which something is no object, metres; default 0.02. */
  bool setMinimumObjectSize (double size_m);

  /** \brief The length below which something is no object, metres. */
  double getMinimumObjectSize () const { return options_.min_object_size_m; }

  /** \brief Set by how much a crease must be concave to separate two objects, radians; default 0.45. */
  bool setConcaveAngle (double angle_rad);

  /** \brief By how much a crease must be concave to separate two objects, radians. */
  double getConcaveAngle () const { return options_.concave_angle_rad; }

  /** \brief Set all parameters at once. */
  bool setOptions (const ObjectSegmentationOptions& options);

  /** \brief Set the number of threads; 0 (default): all processors. The result does not depend on it. */
  void setNumberOfThreads (unsigned int threads = 0);

  /** \brief The planes that the last segment () took for the room, as pcl::SACSegmentation gives them: a, b, c, d of
   * a x + b y + c z + d = 0, the unit normal towards the sensor; the one that is seen best is the first. */
  const std::vector<pcl::ModelCoefficients>& getSupportPlanes () const { return support_planes_; }

protected:
  GeometricSegmentationBase () = default;
  ~GeometricSegmentationBase () = default;

  /** \brief Whether there is an organised cloud of this size; says so if not. Forgets the last result. */
  bool begin (bool input, unsigned int width, unsigned int height);

  /** \brief segmentObjects () in PCL's types. */
  void segmentPoints (const std::vector<Eigen::Vector3f>& points, int width, int height, const pcl::PCLHeader& header,
                      pcl::PointCloud<pcl::Label>& labels, std::vector<pcl::PointIndices>& label_indices);

private:
  ObjectSegmentationOptions options_;
  std::vector<pcl::ModelCoefficients> support_planes_;
};

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
 * Compiled for pcl::PointXYZ, PointXYZI, PointXYZRGB, PointXYZRGBA, PointXYZRGBL, PointNormal, PointXYZRGBNormal
 * and PointXYZINormal; works for others where pcl::PCLBase does (define PCL_NO_PRECOMPILE before the include). */
template <typename PointT>
class PCL_COSECTION_EXPORT GeometricSegmentation : public PCLBase<PointT>, public GeometricSegmentationBase
{
  using Base = PCLBase<PointT>;

public:
  /** \brief Shared pointer. */
  using Ptr = shared_ptr<GeometricSegmentation<PointT>>;
  /** \brief Shared pointer to what is constant. */
  using ConstPtr = shared_ptr<const GeometricSegmentation<PointT>>;
  /** \brief Cloud of the points. */
  using PointCloud = pcl::PointCloud<PointT>;

  /** \brief Find the objects.
   *
   * Without an organised input cloud, and where there is no plane that objects could stand on, this says so on PCL's
   * console, and both outputs are empty.
   * \param[out] labels one per point of the input cloud, of its width and height: 0 background, 1 ... objects
   * \param[out] label_indices points of each object, in their order; those of label n are label_indices[n - 1] */
  void segment (pcl::PointCloud<pcl::Label>& labels, std::vector<pcl::PointIndices>& label_indices);

protected:
  using Base::deinitCompute;
  using Base::indices_;
  using Base::initCompute;
  using Base::input_;
};

template <typename PointT>
void
GeometricSegmentation<PointT>::segment (pcl::PointCloud<pcl::Label>& labels,
                                        std::vector<pcl::PointIndices>& label_indices)
{
  labels.clear ();
  label_indices.clear ();
  if (!begin (input_ != nullptr, input_ ? input_->width : 0, input_ ? input_->height : 0) || !initCompute ())
    return;
  std::vector<Eigen::Vector3f> points (input_->size (),
                                       Eigen::Vector3f::Constant (std::numeric_limits<float>::quiet_NaN ()));
  for (const auto i : *indices_)
    if ((*input_)[i].getVector3fMap ().allFinite ())
      points[i] = (*input_)[i].getVector3fMap ();
  deinitCompute ();
  segmentPoints (points, static_cast<int> (input_->width), static_cast<int> (input_->height), input_->header, labels,
                 label_indices);
}

BOOST_PP_SEQ_FOR_EACH (PCL_COSECTION_EXTERN_TEMPLATE, GeometricSegmentation, PCL_COSECTION_XYZ_POINT_TYPES)

} // namespace pcl::cosection
