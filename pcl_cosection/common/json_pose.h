// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include <optional>

namespace pcl::cosection {

/** \brief Whether coordinates are such as a place can have, metres: finite and not absurd. */
inline bool
isPlace (const Eigen::Vector3d& place)
{
  constexpr double farthest_m = 1e9; // from the origin
  return place.allFinite () && place.cwiseAbs ().maxCoeff () <= farthest_m;
}

/** \brief A rigid transformation to a place, from its four rows. \param[in] rows of any kind of nlohmann::basic_json
 * \return nothing if they are anything else */
template <typename Json>
std::optional<Eigen::Isometry3d>
poseFromRows (const Json& rows)
{
  constexpr double rigid = 1e-6; // largest deviation from a rotation
  Eigen::Isometry3d pose;
  if (!rows.is_array () || rows.size () != 4)
    return std::nullopt;
  for (std::size_t row = 0; row < 4; ++row)
  {
    if (!rows[row].is_array () || rows[row].size () != 4)
      return std::nullopt;
    for (std::size_t column = 0; column < 4; ++column)
    {
      if (!rows[row][column].is_number ())
        return std::nullopt;
      pose.matrix () (static_cast<Eigen::Index> (row),
                      static_cast<Eigen::Index> (column)) = rows[row][column].template get<double> ();
    }
  }
  const Eigen::Matrix3d rotation = pose.linear ();
  const bool is_pose = pose.matrix ().allFinite () && isPlace (pose.translation ()) &&
                       pose.matrix ().row (3) == Eigen::RowVector4d (0, 0, 0, 1) &&
                       (rotation * rotation.transpose ()).isIdentity (rigid) && rotation.determinant () > 0.0;
  return is_pose ? std::optional (pose) : std::nullopt;
}

} // namespace pcl::cosection
