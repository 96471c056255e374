// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>

#include <Eigen/Geometry>

#include <pybind11/numpy.h>

#include <array>
#include <cstddef>
#include <vector>

/** \brief An array whose elements lie one after the other, converted if they do not; its shape is checked by who calls
 * from Python. */
template <typename Scalar>
using DenseArray = pybind11::array_t<Scalar, pybind11::array::c_style | pybind11::array::forcecast>;

/** \brief An array that shows the elements of a vector, without a copy, and cannot be written. \param[in] shape whose
 * product is the number of scalars \param[in] owner lives as long as the array */
template <typename Scalar, typename Element>
pybind11::array
viewOf (const std::vector<Element>& elements, std::vector<pybind11::ssize_t> shape, const pybind11::object& owner)
{
  static_assert (sizeof (Element) % sizeof (Scalar) == 0);
  pybind11::array_t<Scalar> array (std::move (shape), reinterpret_cast<const Scalar*> (elements.data ()), owner);
  array.attr ("setflags") (pybind11::arg ("write") = false);
  return array;
}

/** \brief An array of one row per element, as viewOf () makes it; None of an empty vector. */
template <typename Scalar, typename Element>
pybind11::object
rowsOf (const std::vector<Element>& elements, const pybind11::object& owner)
{
  if (elements.empty ())
    return pybind11::none ();
  const auto count = static_cast<pybind11::ssize_t> (elements.size ());
  constexpr auto width = static_cast<pybind11::ssize_t> (sizeof (Element) / sizeof (Scalar));
  return width == 1 ? viewOf<Scalar> (elements, {count}, owner) : viewOf<Scalar> (elements, {count, width}, owner);
}

/** \brief A rigid transform from 4 x 4 numbers, row by row. */
inline Eigen::Isometry3d
toIsometry (const DenseArray<double>& matrix)
{
  using RowMajor = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;
  Eigen::Isometry3d T;
  T.matrix () = Eigen::Map<const RowMajor> (matrix.data ());
  return T;
}

/** \brief A matrix as numbers, row by row. */
template <typename Derived>
pybind11::array_t<double>
toArray (const Eigen::MatrixBase<Derived>& matrix)
{
  pybind11::array_t<double> array ({matrix.rows (), matrix.cols ()});
  for (Eigen::Index row = 0; row < matrix.rows (); ++row)
    for (Eigen::Index column = 0; column < matrix.cols (); ++column)
      array.mutable_at (row, column) = matrix (row, column);
  return array;
}

/** \brief A vector as numbers. */
inline pybind11::array_t<double>
toArray (const Eigen::Vector3d& v)
{
  return pybind11::array_t<double> (3, v.data ());
}

/** \brief A camera of an image. \param[in] intrinsics fx, fy, cx, cy, pixels */
inline pcl::cosection::PinholeCamera
toCamera (const std::array<double, 4>& intrinsics, pybind11::ssize_t height, pybind11::ssize_t width)
{
  return {
      static_cast<int> (width), static_cast<int> (height), intrinsics[0], intrinsics[1], intrinsics[2], intrinsics[3]};
}
