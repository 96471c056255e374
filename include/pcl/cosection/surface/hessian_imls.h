// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/common/point_types.h>
#include <pcl/cosection/surface/co_section.h>
#include <pcl/cosection/surface/options.h>
#include <pcl/cosection/volume/signed_distance_field.h>

#include <pcl/ModelCoefficients.h>
#include <pcl/surface/reconstruction.h>
#include <pcl/type_traits.h>

#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pcl::cosection {

/** \brief The options, constraints and last result of HessianIMLS, which do not depend on the type of its points.
 *
 * All frames are the object's, all lengths metres. A setter that cannot use what it gets says why through PCL's
 * console, changes nothing and returns false. */
class PCL_COSECTION_EXPORT HessianIMLSBase
{
public:
  /** \brief Set all parameters at once. */
  bool setOptions (const CoSectionOptions& options);

  /** \brief The parameters, as setOptions () and the other setters left them. */
  const CoSectionOptions& getOptions () const { return options_; }

  /** \brief Set the edge of a voxel, metres; overrides the resolution. */
  bool setVoxelSize (float voxel_size_m);

  /** \brief Set the number of voxels along the longest observed side; overrides the voxel size. */
  bool setResolution (int resolution);

  /** \brief Set the number of threads; 0 (default): all processors. The result does not depend on it.
   * \return false if there are more than 1024; the number is as before then */
  bool setNumberOfThreads (unsigned int threads = 0);

  /** \brief Add a view of the scene: the space in front of its readings is free.
   * \param[in] cloud in its sensor's frame: organised (x right, y down, z forward), as a pinhole camera sees it, not
   * finite: no reading; or unorganised, which is drawn as a range image
   * \param[in] T_object_sensor pose of the sensor in the object's frame
   * \return false if the cloud is not the image of a pinhole camera, or more than a tenth of an unorganised one is
   * hidden from the sensor */
  template <typename PointT>
  bool addView (const pcl::PointCloud<PointT>& cloud,
                const Eigen::Isometry3d& T_object_sensor = Eigen::Isometry3d::Identity ())
  {
    return addCloud (toDepthView (cloud, T_object_sensor));
  }

  /** \brief Add a depth image whose T_world_sensor is T_object_sensor. \return false if it is not valid */
  bool addView (const DepthView& view);

  /** \brief Add a body that the object cannot enter, at one or many poses relative to the object.
   * \param[in] body signed distance in the frame of the body, one value per voxel
   * \param[in] T_body_object each takes points of the object to the frame of the body
   * \return false if there is no body, it has not one value per voxel, or a pose is not finite */
  bool addObstacle (const SignedDistanceField::ConstPtr& body,
                    const std::vector<Eigen::Isometry3d>& T_body_object = {Eigen::Isometry3d::Identity ()});

  /** \brief Add a body that is given as a mesh: closed, or open as the boundary of what lies behind it.
   * \param[in] body vertices in the frame of the body, metres
   * \param[in] T_body_object each takes points of the object to the frame of the body
   * \return false if the mesh bounds nothing, or a pose is not finite */
  bool addObstacle (const TriangleMesh& body,
                    const std::vector<Eigen::Isometry3d>& T_body_object = {Eigen::Isometry3d::Identity ()});

  /** \brief Add a body that is given as PCL's mesh, of triangles or larger polygons.
   * \param[in] body vertices in the frame of the body, metres
   * \param[in] T_body_object each takes points of the object to the frame of the body
   * \return false if fromPolygonMesh () cannot read the mesh, it bounds nothing, or a pose is not finite */
  bool addObstacle (const pcl::PolygonMesh& body,
                    const std::vector<Eigen::Isometry3d>& T_body_object = {Eigen::Isometry3d::Identity ()});

  /** \brief Add a plane that the object stands on or leans against.
   * \param[in] coefficients a, b, c, d of a x + b y + c z + d = 0, of any scale and either sign, as
   * pcl::SACSegmentation gives them; the object is on the side of most of its points
   * \return false if there are not four, one is not finite, or the normal is zero */
  bool addSupportPlane (const pcl::ModelCoefficients& coefficients);

  /** \brief Propose a mesh as the object's shape: from a generator, or a model, of any size and pose. The one of all
   * that fits the measurements best is moved, turned and scaled onto them; if it explains them, it is expected where
   * nothing was measured. \return false if it has no triangles, or is not consistent or not finite */
  bool addProposal (const TriangleMesh& mesh);

  /** \brief Propose a mesh of PCL's, as the other addProposal (). \return false also if fromPolygonMesh () cannot read
   * it */
  bool addProposal (const pcl::PolygonMesh& mesh);

  /** \brief How the proposals fit in the last reconstruct (); nothing if there were none, or none could be aligned. */
  const std::optional<ProposalFit>& getProposalFit () const { return result_.proposal; }

  /** \brief Forget views, obstacles, support planes and proposals. */
  void clearConstraints ();

  /** \brief Set a function that is called with the progress, and may cancel. */
  void setProgressCallback (const ProgressCallback& progress) { progress_ = progress; }

  /** \brief The signed distance of the last reconstruct (), object frame; null if it failed. */
  SignedDistanceField::ConstPtr getSignedDistance () const { return result_.signed_distance; }

  /** \brief The mesh of the last reconstruct (), with provenance, confidence and sigma_m; empty if it failed. */
  const TriangleMesh& getTriangleMesh () const { return result_.mesh; }

  /** \brief What the solver did in the last reconstruct (). */
  const SolverSummary& getSolverSummary () const { return result_.solver; }

protected:
  HessianIMLSBase () = default;
  ~HessianIMLSBase () = default;

  /** \brief Complete the surface of oriented points. \return false, with a message, if they determine none */
  bool complete (std::vector<OrientedPoint> points);

  /** \brief Say that there is nothing to complete. */
  void reportMissingInput () const;

private:
  using Poses = std::vector<Eigen::Isometry3d>;

  bool addCloud (const std::optional<DepthView>& view);

  CoSectionOptions options_;
  std::vector<DepthView> views_;
  std::vector<std::pair<SignedDistanceField::ConstPtr, Poses>> fields_;
  std::vector<std::pair<TriangleMesh, Poses>> meshes_;
  std::vector<Eigen::Vector4d> planes_;
  std::vector<TriangleMesh> proposals_;
  ProgressCallback progress_;
  ObjectResult result_;
};

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
 * imls.addObstacle (table, {T_table_object});      // another body, one or many relative poses
 * imls.addSupportPlane (coefficients);             // as pcl::SACSegmentation gives them
 * pcl::PolygonMesh mesh;
 * imls.reconstruct (mesh);                         // closed
 * auto sdf = imls.getSignedDistance ();            // to hand to the next object
 * \endcode
 *
 * Points that are not finite or have no normal are left out; setIndices () is honoured. On input that determines no
 * surface reconstruct () says why through PCL's console and leaves the output empty. Time and memory are linear in the
 * voxels.
 *
 * Compiled for pcl::PointNormal, PointXYZRGBNormal and PointXYZINormal; works for any type with a normal. */
template <typename PointNT>
class PCL_COSECTION_EXPORT HessianIMLS : public SurfaceReconstruction<PointNT>, public HessianIMLSBase
{
  using Base = SurfaceReconstruction<PointNT>;

public:
  /** \brief Shared pointer. */
  using Ptr = shared_ptr<HessianIMLS<PointNT>>;
  /** \brief Shared pointer to what is constant. */
  using ConstPtr = shared_ptr<const HessianIMLS<PointNT>>;
  /** \brief Cloud of the points. */
  using PointCloud = pcl::PointCloud<PointNT>;

  using Base::indices_;
  using Base::input_;

  HessianIMLS () { this->check_tree_ = false; } // else the base builds a tree that nobody uses

  ~HessianIMLS () override = default;

  /** \brief Complete the surface of the input cloud.
   * \param[out] output closed mesh, object frame, with the fields of toPolygonMesh (); empty if there is no surface */
  void reconstruct (pcl::PolygonMesh& output) override;

  /** \brief Complete the surface of the input cloud.
   * \param[out] points vertices of the closed mesh, object frame, with normals, and with colour and intensity if both
   * the type and the input have them
   * \param[out] polygons triangles, counter-clockwise from outside */
  void reconstruct (pcl::PointCloud<PointNT>& points, std::vector<pcl::Vertices>& polygons) override;

protected:
  /** \brief The name in messages. */
  std::string getClassName () const override { return "cosection::HessianIMLS"; }

  /** \brief Complete the input, once the base class has checked that there is one. */
  void performReconstruction (pcl::PolygonMesh& output) override;

  /** \brief Complete the input, once the base class has checked that there is one. */
  void performReconstruction (pcl::PointCloud<PointNT>& points, std::vector<pcl::Vertices>& polygons) override;

private:
  /** \brief The points of the input that are finite and have a normal. */
  std::vector<OrientedPoint> orientedPoints () const;
};

template <typename PointNT>
std::vector<OrientedPoint>
HessianIMLS<PointNT>::orientedPoints () const
{
  std::vector<OrientedPoint> points;
  for (const auto i : *indices_)
  {
    const PointNT& p = (*input_)[i];
    const Eigen::Vector3f normal = p.getNormalVector3fMap ();
    const float length = normal.norm ();
    if (!p.getVector3fMap ().allFinite () || !std::isfinite (length) || !(length > 0.0f))
      continue;
    OrientedPoint point;
    point.position = p.getVector3fMap ();
    point.normal = normal / length;
    if constexpr (pcl::traits::has_color<PointNT>::value)
      point.colour = {p.r, p.g, p.b};
    if constexpr (pcl::traits::has_intensity<PointNT>::value)
      point.intensity = std::isfinite (p.intensity) ? p.intensity : 0.0f;
    points.push_back (point);
  }
  return points;
}

template <typename PointNT>
void
HessianIMLS<PointNT>::reconstruct (pcl::PolygonMesh& output)
{
  output.polygons.clear ();
  output.cloud = pcl::PCLPointCloud2 ();
  if (!this->initCompute ())
  {
    reportMissingInput ();
    return;
  }
  output.header = input_->header;
  performReconstruction (output);
  this->deinitCompute ();
}

template <typename PointNT>
void
HessianIMLS<PointNT>::reconstruct (pcl::PointCloud<PointNT>& points, std::vector<pcl::Vertices>& polygons)
{
  points.clear ();
  polygons.clear ();
  if (!this->initCompute ())
  {
    reportMissingInput ();
    return;
  }
  points.header = input_->header;
  performReconstruction (points, polygons);
  this->deinitCompute ();
}

template <typename PointNT>
void
HessianIMLS<PointNT>::performReconstruction (pcl::PolygonMesh& output)
{
  output.cloud = pcl::PCLPointCloud2 ();
  output.polygons.clear ();
  if (!complete (orientedPoints ()))
    return;
  toPolygonMesh (getTriangleMesh (), output);
  output.cloud.header = output.header;
}

template <typename PointNT>
void
HessianIMLS<PointNT>::performReconstruction (pcl::PointCloud<PointNT>& points, std::vector<pcl::Vertices>& polygons)
{
  points.clear ();
  polygons.clear ();
  if (!complete (orientedPoints ()))
    return;
  const TriangleMesh& mesh = getTriangleMesh ();
  points.resize (mesh.vertices.size ());
  for (std::size_t v = 0; v < mesh.vertices.size (); ++v)
  {
    points[v].getVector3fMap () = mesh.vertices[v];
    points[v].getNormalVector3fMap () = mesh.normals[v];
    if constexpr (pcl::traits::has_color<PointNT>::value)
      if (!mesh.colours.empty ())
      {
        points[v].r = mesh.colours[v][0];
        points[v].g = mesh.colours[v][1];
        points[v].b = mesh.colours[v][2];
      }
    if constexpr (pcl::traits::has_intensity<PointNT>::value)
      if (!mesh.intensity.empty ())
        points[v].intensity = mesh.intensity[v];
  }
  polygons.resize (mesh.triangles.size ());
  for (std::size_t t = 0; t < mesh.triangles.size (); ++t)
    polygons[t].vertices.assign (mesh.triangles[t].begin (), mesh.triangles[t].end ());
}

BOOST_PP_SEQ_FOR_EACH (PCL_COSECTION_EXTERN_TEMPLATE, HessianIMLS, PCL_COSECTION_NORMAL_POINT_TYPES)

} // namespace pcl::cosection
