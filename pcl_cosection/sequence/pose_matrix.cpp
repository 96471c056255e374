// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "pose_matrix.h"

#include "pcl_cosection/common/files.h"
#include "pcl_cosection/io/text_scanner.h"

#include <pcl/cosection/common/error.h>

#include <Eigen/SVD>

namespace pcl::cosection {
namespace {

constexpr double rigid_tolerance = 0.02; // of the entries of R R^T - I

} // namespace

Eigen::Isometry3d
poseOfMatrix (const Eigen::Matrix4d& matrix)
{
  if (!matrix.allFinite ())
    throw IoError ("has a pose that is not finite");
  const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3> ();
  const double skew = (rotation * rotation.transpose () - Eigen::Matrix3d::Identity ()).cwiseAbs ().maxCoeff ();
  const double last_row = (matrix.row (3) - Eigen::RowVector4d (0, 0, 0, 1)).cwiseAbs ().maxCoeff ();
  if (!(skew <= rigid_tolerance && last_row <= rigid_tolerance && rotation.determinant () > 0.0))
    throw IoError ("has a matrix that is not a rotation and a translation");
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd (rotation, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity ();
  pose.linear () = svd.matrixU () * svd.matrixV ().transpose (); // the nearest rotation
  pose.translation () = matrix.topRightCorner<3, 1> ();
  return pose;
}

Eigen::Isometry3d
readPoseMatrix (const std::string& path)
{
  const std::string bytes = readBytes (path);
  Eigen::Matrix4d matrix;
  try
  {
    TextScanner scanner (bytes);
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 4; ++column)
        matrix (row, column) = toReal (scanner.word ());
    const std::string_view more = scanner.word ();
    if (!more.empty ())
      throw IoError ("there is " + quoted (more) + " behind it");
  }
  catch (const IoError& error)
  {
    throw IoError (path + ": must be the 16 numbers of a 4 x 4 matrix, but " + error.what ());
  }
  try
  {
    return poseOfMatrix (matrix);
  }
  catch (const IoError& error)
  {
    throw IoError (path + ": " + error.what ());
  }
}

} // namespace pcl::cosection
