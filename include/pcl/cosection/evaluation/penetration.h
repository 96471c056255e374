// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/triangle_mesh.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

namespace pcl::cosection {

/** \brief How to measure penetration. */
struct PCL_COSECTION_EXPORT PenetrationOptions
{
  std::size_t samples = 10000;  ///< on the surface, beside its vertices
  std::size_t max_vertices = 0; ///< of so many, evenly chosen; 0: all
  std::uint64_t seed = 0;       ///< of the samples
  double voxel_size_m = 0.0;    ///< of the volume; 0: by \a voxels
  int voxels = 128;             ///< along the longest side of the smaller box
  bool open_parts = true;       ///< whether there is matter behind open parts
  double band_m = 0.05;         ///< how far behind them
  int threads = 0;              ///< 0: all

  /** \brief Check all values. \throws InvalidArgument naming the first one outside its domain. */
  void validate () const;
};

class SolidDepth;

/** \brief A mesh that others may penetrate, and that may penetrate others.
 *
 * What is inside is what sampleSignedDistance () says: closed parts are solid, cavities are not; behind open parts
 * there is matter within a band, where the nearest point is not on their rim.
 *
 * \code
 * const PenetrationBody cup (cup_mesh), table (table_mesh);
 * const double depth_m = table.depthOf (cup, T_table_cup);
 * \endcode */
class PCL_COSECTION_EXPORT PenetrationBody
{
public:
  /** \brief Prepare a mesh. \throws InvalidArgument, DegenerateInput as compareMeshes () */
  explicit PenetrationBody (const TriangleMesh& mesh, const PenetrationOptions& options = {});
  ~PenetrationBody ();
  /** \brief Takes over what the other one has. */
  PenetrationBody (PenetrationBody&&) noexcept;
  /** \brief Takes over what the other one has. */
  PenetrationBody& operator= (PenetrationBody&&) noexcept;

  /** \brief Whether some of the mesh is open: it has no inside, only a band behind it. */
  bool isOpen () const;

  /** \brief Whether some of the mesh is closed: only then it has a volume. */
  bool hasVolume () const;

  /** \brief How deep the surface of \a other, by its vertices and area-uniform samples of it, lies inside this: the
   * greatest distance to this surface, metres; 0: it does not.
   * \param[in] other the body whose surface is measured
   * \param[in] T_this_other pose of \a other in the frame of this mesh */
  double depthOf (const PenetrationBody& other,
                  const Eigen::Isometry3d& T_this_other = Eigen::Isometry3d::Identity ()) const;

  /** \brief The volume that both bodies fill, cubic metres, by counting the centres of voxels.
   * \return nothing if this or \a other has no closed part, for then it has no volume; nothing for two rooms
   * \throws InvalidArgument if the voxels are so small that there are more than 2e8 */
  std::optional<double> sharedVolume (const PenetrationBody& other,
                                      const Eigen::Isometry3d& T_this_other = Eigen::Isometry3d::Identity ()) const;

private:
  PenetrationOptions options_;
  Eigen::AlignedBox3d box_;
  std::vector<Eigen::Vector3d> points_; ///< vertices and samples
  std::unique_ptr<SolidDepth> solid_;
};

} // namespace pcl::cosection
