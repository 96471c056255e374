// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/image.h>
#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/volume/signed_distance_field.h>

#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief How TsdfVolume averages. */
struct PCL_COSECTION_EXPORT TsdfOptions
{
  double truncation_vox = 10.0; ///< distances are cut off at this many voxels; thinner bodies come out thicker
  double max_weight = 64.0;     ///< of a voxel; what it bounds is how long a surface that is gone is remembered
  bool colour = false;          ///< average colours, too
  bool foreground = false;      ///< count how often a voxel's surface was seen in the object's mask and outside it
  int threads = 0;              ///< 0: all; no result depends on it

  /** \brief Check all values. \throws InvalidArgument if a number is not positive and finite, or \a threads is
   * negative. */
  void validate () const;
};

/** \brief What is known of the pixels of a depth image beside their depth; nullptr: nothing. Of the camera's size. */
struct PCL_COSECTION_EXPORT TsdfPixels
{
  const Image<float>* weights = nullptr;        ///< >= 0, instead of 1; NaN: 0
  const Image<std::uint16_t>* labels = nullptr; ///< only pixels of \a label are integrated
  std::uint16_t label = 0;                      ///< of the pixels that are integrated, where there are labels
  const Picture* colours = nullptr;             ///< taken if the volume has colour
};

/** \brief A truncated signed distance volume: the running average of what depth images say about the distance to the
 * surface.
 *
 * B. Curless, M. Levoy, "A Volumetric Method for Building Complex Models from Range Images", SIGGRAPH 1996;
 * R. Newcombe et al., "KinectFusion: Real-Time Dense Surface Mapping and Tracking", ISMAR 2011, Equations (6) to (13).
 *
 * A voxel at p (sensor frame) that projects to the pixel with depth D is at the distance
 *
 *     d = (D - p_z) |p| / p_z
 *
 * from the surface, along its own ray: positive in front of it. The reading is that of the nearest pixel; readings are
 * never mixed. If d >= -truncation, with the pixel's weight w,
 *
 *     sdf <- sdf + w / (W + w) (min (d, truncation) - sdf),  W <- min (W + w, max_weight)
 *
 * Voxels farther behind the surface than that learn nothing. Leaving out unreliable pixels, such as those at depth
 * edges, is the caller's part: as NaN or with weight 0.
 *
 * Foreground counts follow M. Strecke, J. Stueckler, "EM-Fusion: Dynamic Object-Level SLAM with Probabilistic Data
 * Association", ICCV 2019.
 *
 * Memory per voxel: 8 bytes, with colour 16, with foreground counts 4 more (see estimateBytes ()).
 *
 * \code
 * TsdfVolume volume (grid);
 * for (const auto& frame : frames)
 *   volume.integrate (frame.depth, camera, frame.T_grid_sensor);
 * const TriangleMesh mesh = volume.surfaceMesh ();
 * \endcode */
class PCL_COSECTION_EXPORT TsdfVolume
{
public:
  /** \brief Shared pointer. */
  using Ptr = std::shared_ptr<TsdfVolume>;
  /** \brief Shared pointer to what is constant. */
  using ConstPtr = std::shared_ptr<const TsdfVolume>;

  /** \brief An empty volume. \throws InvalidArgument as estimateBytes () */
  explicit TsdfVolume (const VoxelGrid& grid, const TsdfOptions& options = {});

  /** \brief Memory that a volume holds, bytes. Integrating needs up to two numbers per pixel beside it; growing, both
   * the old and the new volume.
   * \throws InvalidArgument if the options are not valid, the grid has no voxels or more than can be counted, its voxel
   * size is not positive or its origin not finite, or the truncation distance is beyond 1e9 m */
  static std::size_t estimateBytes (const VoxelGrid& grid, const TsdfOptions& options = {});

  /** \brief Average a depth image in. O (voxels in the frustum up to the farthest reading + pixels).
   * \param[in] depth metres along the optical axis; not finite or not positive: no reading
   * \param[in] camera of the image
   * \param[in] T_grid_sensor pose of the sensor in the grid's frame; it may be within the volume
   * \param[in] pixels what else is known of the pixels
   * \throws InvalidArgument if the camera is not valid, an image is not of its size, or the pose is not a finite rigid
   * motion; nothing was changed then */
  void integrate (const Image<float>& depth, const PinholeCamera& camera, const Eigen::Isometry3d& T_grid_sensor,
                  const TsdfPixels& pixels = {});

  /** \brief Average in that space is free, from pixels of other labels than the volume's: voxels more than the
   * truncation distance in front of their readings come nearer to that distance. Others, also those beside what the
   * readings show, learn nothing. Pixels of \a label in \a labels are left out.
   * \throws InvalidArgument as integrate () */
  void integrateFreeSpace (const Image<float>& depth, const PinholeCamera& camera,
                           const Eigen::Isometry3d& T_grid_sensor, const Image<std::uint16_t>& labels,
                           std::uint16_t label);

  /** \brief Forget the distances of voxels within the truncation distance of the readings of pixels of \a label: they
   * are not this volume's, as was thought before.
   * \throws InvalidArgument as integrate () */
  void forget (const Image<float>& depth, const PinholeCamera& camera, const Eigen::Isometry3d& T_grid_sensor,
               const Image<std::uint16_t>& labels, std::uint16_t label);

  /** \brief Count, at voxels within the truncation distance of a reading, whether its pixel has \a label (foreground)
   * or any other (background).
   *
   * Distances are not changed: masks come less often than images. Counts that reach 65535 are halved, both.
   * \throws InvalidArgument as integrate (), or if the volume was made without foreground counts */
  void countForeground (const Image<float>& depth, const PinholeCamera& camera, const Eigen::Isometry3d& T_grid_sensor,
                        const Image<std::uint16_t>& labels, std::uint16_t label);

  /** \brief Give the volume more voxels without losing one: what is in voxel v is in voxel v + \a offset then, bit for
   * bit, and at the same place.
   * \param[in] offset voxels added before the first of each axis
   * \param[in] dims the new size
   * \throws InvalidArgument if a voxel would be lost; nothing was changed then */
  void grow (const Eigen::Vector3i& offset, const Eigen::Vector3i& dims);

  /** \brief As grow (), but what is outside then is dropped: \a offset may be negative and \a dims smaller.
   * \throws InvalidArgument if there are no voxels, or more than can be counted */
  void reframe (const Eigen::Vector3i& offset, const Eigen::Vector3i& dims);

  /** \brief Distance and gradient at \a p (metres, the grid's frame), of the scalar type of \a p; nothing where one of
   * the eight voxels around it has no weight. Where all of them are truncated the gradient is zero. */
  template <typename Scalar> std::optional<TrilinearCell<Scalar>> sample (const Eigen::Matrix<Scalar, 3, 1>& p) const
  {
    return TrilinearCell<Scalar>::around (field_, p);
  }

  /** \brief Weight of the voxel nearest to \a p; 0 outside. */
  float weight (const Eigen::Vector3d& p) const
  {
    const auto v = field_.grid.nearest (p);
    return v ? weights_[field_.grid.index (v->x (), v->y (), v->z ())] : 0.0f;
  }

  /** \brief fg / (fg + bg) at the voxel nearest to \a p; nothing outside, where nothing was counted, and without
   * counts. */
  std::optional<float> foregroundProbability (const Eigen::Vector3d& p) const;

  /** \brief Mean colour around \a p, by trilinear interpolation over the voxels that have one; nothing if none has. */
  std::optional<TriangleMesh::Colour> colour (const Eigen::Vector3d& p) const;

  /** \brief The zero level set in cells whose eight voxels all have a weight, of at least \a min_weight: an open mesh,
   * in the grid's frame, with normals, and with colours if the volume has them (grey where none was seen).
   *
   * Where space behind a surface that one view saw meets space that another saw free, distances jump, and the mesh has
   * a surface in between; more views, and leaving out depth edges, remove it.
   * \throws InvalidArgument if \a min_weight is negative or NaN */
  TriangleMesh surfaceMesh (double min_weight = 0.0) const;

  /** \brief Truncated distances, metres; NaN where the weight is 0. */
  const SignedDistanceField& field () const { return field_; }

  /** \brief Where the voxels are. */
  const VoxelGrid& grid () const { return field_.grid; }

  /** \brief One per voxel. */
  const std::vector<float>& weights () const { return weights_; }

  /** \brief The options of the constructor. */
  const TsdfOptions& options () const { return options_; }

  double truncation () const ///< metres
  {
    return options_.truncation_vox * field_.grid.voxel_size_m;
  }

private:
  /** \brief Averages; an 8-bit one would stop moving as soon as the weight is large. */
  struct ColourVoxel
  {
    std::array<std::uint16_t, 3> rgb{}; // in 256ths
    std::uint16_t weight = 0;           // in 256ths
  };

  struct LabelCounts
  {
    std::uint16_t foreground = 0;
    std::uint16_t background = 0;
  };

  void averageColours (std::size_t first_voxel, const float* distances, const int* pixels, int count,
                       const float* pixel_weights, const Picture& colours);

  void countLabels (std::size_t first_voxel, const float* distances, const int* pixels, int count,
                    const Image<std::uint16_t>& labels, std::uint16_t label);

  TsdfOptions options_;
  SignedDistanceField field_;
  std::vector<float> weights_;
  std::vector<ColourVoxel> colours_; // empty without colour
  std::vector<LabelCounts> counts_;  // empty without foreground counts
};

} // namespace pcl::cosection
