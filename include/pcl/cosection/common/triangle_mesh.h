// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/export.h>

#include <pcl/PolygonMesh.h>

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <vector>

namespace pcl::cosection {

/** \brief Why a piece of surface is where it is. */
enum class Provenance : std::uint8_t
{
  Observed = 0,     ///< measured points nearby
  Inferred = 1,     ///< neither seen nor bounded: by smoothness and priors
  Hull = 2,         ///< bounded by space that was seen free
  Intersection = 3, ///< bounded by another object or the background
};

/** \brief Indexed triangles with outward orientation (counter-clockwise from outside), metres.
 *
 * The per-vertex arrays are empty or as long as \a vertices. */
struct PCL_COSECTION_EXPORT TriangleMesh
{
  /** \brief Indices of three vertices. */
  using Triangle = std::array<std::uint32_t, 3>;
  /** \brief Red, green, blue. */
  using Colour = std::array<std::uint8_t, 3>;

  std::vector<Eigen::Vector3f> vertices; ///< metres
  std::vector<Triangle> triangles;       ///< counter-clockwise from outside
  std::vector<Eigen::Vector3f> normals;  ///< unit, outward
  std::vector<Colour> colours;           ///< red, green, blue
  std::vector<float> intensity;          ///< as the points'
  std::vector<float> confidence;         ///< exp (-d / 5), d: voxels to the nearest data
  std::vector<float> sigma_m;            ///< expected error: the truth is within two of it for 95 % of the vertices
  std::vector<std::uint8_t> provenance;  ///< Provenance

  /** \brief Whether there is no triangle. */
  bool empty () const { return triangles.empty (); }
};

/** \brief What the connectivity of a mesh says. */
struct PCL_COSECTION_EXPORT MeshTopology
{
  bool closed_manifold = false;  ///< every edge in exactly two triangles of opposite direction, every vertex one fan
  int boundary_edges = 0;        ///< edges of one triangle
  int non_manifold_edges = 0;    ///< edges of more than two triangles, or of two that disagree on the direction
  int non_manifold_vertices = 0; ///< vertices whose triangles form more than one fan
  int components = 0;            ///< connected by shared vertices
  int euler = 0;                 ///< V - E + F, over referenced vertices
};

/** \brief Volume integrals of a closed mesh of unit density. */
struct PCL_COSECTION_EXPORT MassProperties
{
  double volume_m3 = 0.0;                                ///< negative if the mesh is turned inside out
  Eigen::Vector3d centroid_m = Eigen::Vector3d::Zero (); ///< centre of mass
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero ();    ///< about the centroid, density 1 kg/m^3: kg m^2
};

/** \brief Analyse the connectivity; O (triangles log triangles). */
PCL_COSECTION_EXPORT MeshTopology computeTopology (const TriangleMesh& mesh);

/** \brief Exact polyhedral volume, centroid and inertia (divergence theorem). */
PCL_COSECTION_EXPORT MassProperties computeMassProperties (const TriangleMesh& mesh);

/** \brief Connected component (by shared vertices) of every vertex, numbered from 0 in the order
 * of their first vertex; unreferenced vertices are components of their own. */
PCL_COSECTION_EXPORT std::vector<int> labelComponents (const TriangleMesh& mesh);

/** \brief Keep the triangles for which \a keep is true, and the vertices they use, in their order. */
PCL_COSECTION_EXPORT TriangleMesh extractTriangles (const TriangleMesh& mesh, const std::vector<bool>& keep);

/** \brief Append \a other to \a mesh; a per-vertex array missing in one of them is dropped. */
PCL_COSECTION_EXPORT void appendMesh (TriangleMesh& mesh, const TriangleMesh& other);

/** \brief As PCL's mesh: fields x y z, normal_x normal_y normal_z, rgb, intensity, confidence, sigma_m (float) and
 * provenance (unsigned char), as far as \a mesh has them. The header is left alone.
 * \throws InvalidArgument if the vertices need more than 4 GiB, PCL's limit */
PCL_COSECTION_EXPORT void toPolygonMesh (const TriangleMesh& mesh, pcl::PolygonMesh& output);

/** \brief Vertices and faces of PCL's mesh; polygons are split into triangles around their first vertex.
 * \throws InvalidArgument if it has no fields x, y and z of floats, or a polygon of fewer than three vertices or of
 * vertices that do not exist */
PCL_COSECTION_EXPORT TriangleMesh fromPolygonMesh (const pcl::PolygonMesh& mesh);

} // namespace pcl::cosection
