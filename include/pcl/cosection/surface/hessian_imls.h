// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/progress.h>
#include <pcl/cosection/surface/co_section.h>
#include <pcl/cosection/surface/options.h>
#include <pcl/cosection/volume/signed_distance_field.h>

#include <pcl/ModelCoefficients.h>
#include <pcl/surface/reconstruction.h>

#include <string>
#include <utility>
#include <vector>

namespace pcl::cosection
{

/** \brief Closed surface of one object from oriented points, bounded by the free space that views saw, by
 * other bodies, and by the planes it stands on: Hessian-IMLS (C. Schroers, S. Setzer, J. Weickert, "A
 * Variational Taxonomy for Surface Reconstruction from Oriented Points", Computer Graphics Forum 2014)
 * with the constraints of Co-Section (M. Strecke, J. Stueckler, CVPR 2020). A drop-in for pcl::Poisson.
 *
 * \code
 * pcl::cosection::HessianIMLS<pcl::PointNormal> imls;
 * imls.setInputCloud (points);                     // oriented, object frame, metres
 * imls.setVoxelSize (0.005f);                      // or setResolution (64), or neither
 * imls.addView (organized_cloud, T_object_sensor); // what lies in front of it is free space
 * imls.addObstacle (table, {T_table_object});  // another body, one or many relative poses
 * imls.setSupportPlane (coefficients);             // as pcl::SACSegmentation gives them
 * pcl::PolygonMesh mesh;
 * imls.reconstruct (mesh);                         // closed
 * auto sdf = imls.getSignedDistance ();            // to hand to the next object
 * \endcode
 *
 * Points that are not finite or have no normal are left out; setIndices () is honoured. On input that
 * determines no surface reconstruct () says why through PCL's console and leaves the output empty; setters
 * throw InvalidArgument. All frames are the object's. Time and memory are linear in the voxels.
 *
 * Instantiated for pcl::PointNormal, pcl::PointXYZRGBNormal and pcl::PointXYZINormal; for other types with
 * a normal define PCL_NO_PRECOMPILE before the include. */
template <typename PointNT> class PCL_COSECTION_EXPORT HessianIMLS : public SurfaceReconstruction<PointNT>
{
  using Base = SurfaceReconstruction<PointNT>;

public:
  using Ptr = shared_ptr<HessianIMLS<PointNT>>;
  using ConstPtr = shared_ptr<const HessianIMLS<PointNT>>;
  using PointCloud = pcl::PointCloud<PointNT>;

  using Base::indices_;
  using Base::input_;

  HessianIMLS ();
  ~HessianIMLS () override = default;

  /** \brief All parameters at once; setVoxelSize () and setResolution () change single ones.
   * \throws InvalidArgument */
  void setOptions (const CoSectionOptions& options);

  const CoSectionOptions& getOptions () const { return options_; }

  /** \brief Edge of a voxel, metres; overrides the resolution. \throws InvalidArgument */
  void setVoxelSize (float voxel_size_m);

  /** \brief Voxels along the longest observed side; overrides the voxel size. \throws InvalidArgument */
  void setResolution (int resolution);

  /** \brief Add a view of the scene: what lies in front of its readings is free.
   * \param[in] cloud in its sensor's frame: organised (x right, y down, z forward), as a pinhole sees it, not finite:
   * no reading; or unorganised, drawn as a range image
   * \return false, with a message, if the cloud is not the image of a pinhole camera, or much of an unorganised one is
   * hidden from the sensor */
  template <typename PointT>
  bool addView (const pcl::PointCloud<PointT>& cloud,
                const Eigen::Isometry3d& T_object_sensor = Eigen::Isometry3d::Identity ());

  /** \brief The same as a depth image; its T_world_sensor is T_object_sensor. \throws InvalidArgument */
  void addView (const DepthView& view);

  /** \brief Add a body that the object cannot enter, at one or many poses relative to the object.
   * \param[in] T_body_object takes points of the object to the frame of the body
   * \throws InvalidArgument */
  void addObstacle (const SignedDistanceField::ConstPtr& body,
                    const std::vector<Eigen::Isometry3d>& T_body_object = {Eigen::Isometry3d::Identity ()});

  /** \brief The same, given as a mesh: closed, or open as the boundary of what lies behind it.
   * \throws InvalidArgument if the mesh bounds nothing */
  void addObstacle (const TriangleMesh& body,
                    const std::vector<Eigen::Isometry3d>& T_body_object = {Eigen::Isometry3d::Identity ()});

  /** \brief The same for PCL's meshes, of triangles or larger polygons. \throws InvalidArgument */
  void addObstacle (const pcl::PolygonMesh& body,
                    const std::vector<Eigen::Isometry3d>& T_body_object = {Eigen::Isometry3d::Identity ()});

  /** \brief The plane that the object stands on or leans against: four coefficients a x + b y + c z + d = 0 of
   * either sign; the object is on the side of most of its points. Further calls add further planes.
   * \throws InvalidArgument */
  void setSupportPlane (const pcl::ModelCoefficients& coefficients);

  /** \brief Forget views, bodies and planes. */
  void clearConstraints ();

  void setProgressCallback (const ProgressCallback& progress) { progress_ = progress; }

  void reconstruct (pcl::PolygonMesh& output) override;

  void reconstruct (pcl::PointCloud<PointNT>& points, std::vector<pcl::Vertices>& polygons) override;

  /** \brief Of the last reconstruct (), object frame; null if it failed. */
  SignedDistanceField::ConstPtr getSignedDistance () const { return result_.signed_distance; }

  /** \brief Of the last reconstruct (), with provenance and confidence; empty if it failed. */
  const TriangleMesh& getTriangleMesh () const { return result_.mesh; }

  /** \brief Of the last reconstruct (). */
  const SolverSummary& getSolverSummary () const { return result_.solver; }

protected:
  std::string getClassName () const override { return "cosection::HessianIMLS"; }

  void performReconstruction (pcl::PolygonMesh& output) override;

  void performReconstruction (pcl::PointCloud<PointNT>& points, std::vector<pcl::Vertices>& polygons) override;

private:
  using Poses = std::vector<Eigen::Isometry3d>;

  /** \brief Fill result_; false, with a message, if that fails. */
  bool compute ();

  CoSectionOptions options_;
  std::vector<DepthView> views_;
  std::vector<std::pair<SignedDistanceField::ConstPtr, Poses>> bodies_;
  std::vector<std::pair<TriangleMesh, Poses>> meshes_;
  std::vector<Eigen::Vector4d> planes_;
  ProgressCallback progress_;
  ObjectResult result_;
};

} // namespace pcl::cosection

#include <pcl/cosection/surface/impl/hessian_imls_view.hpp>

#ifdef PCL_NO_PRECOMPILE
#include <pcl/cosection/surface/impl/hessian_imls.hpp>
#else
namespace pcl
{
struct PointNormal;
struct PointXYZRGBNormal;
struct PointXYZINormal;
namespace cosection
{
extern template class PCL_COSECTION_EXPORT HessianIMLS<pcl::PointNormal>;
extern template class PCL_COSECTION_EXPORT HessianIMLS<pcl::PointXYZRGBNormal>;
extern template class PCL_COSECTION_EXPORT HessianIMLS<pcl::PointXYZINormal>;
} // namespace cosection
} // namespace pcl
#endif
