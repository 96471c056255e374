// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "view_data.h"

#include <cmath>
#include <cstring>
#include <limits>

namespace py = pybind11;
using pcl::PCLPointField;

namespace {

/** \brief Lays out the fields of a cloud, and fills them. */
class CloudBuilder
{
public:
  CloudBuilder (py::ssize_t height, py::ssize_t width)
  {
    cloud_.height = static_cast<std::uint32_t> (height);
    cloud_.width = static_cast<std::uint32_t> (width);
  }

  /** \brief Declare a field; all of them come before allocate (). \return where it is */
  std::size_t add (const char* name, std::uint8_t type, std::size_t bytes)
  {
    PCLPointField field;
    field.name = name;
    field.offset = cloud_.point_step;
    field.datatype = type;
    field.count = 1;
    cloud_.fields.push_back (field);
    cloud_.point_step += static_cast<std::uint32_t> (bytes);
    return field.offset;
  }

  void allocate ()
  {
    cloud_.row_step = cloud_.point_step * cloud_.width;
    cloud_.is_dense = 0;
    cloud_.data.assign (size () * cloud_.point_step, 0);
  }

  std::size_t size () const { return static_cast<std::size_t> (cloud_.width) * cloud_.height; }

  /** \brief Copy a value into a point. */
  template <typename Value> void set (std::size_t point, std::size_t offset, const Value& value)
  {
    std::memcpy (cloud_.data.data () + point * cloud_.point_step + offset, &value, sizeof (Value));
  }

  pcl::PCLPointCloud2 take () { return std::move (cloud_); }

private:
  pcl::PCLPointCloud2 cloud_;
};

/** \brief Fields for what there may be beside positions. */
class Attributes
{
public:
  Attributes (const OptionalArray<std::uint32_t>& labels, const OptionalArray<std::uint8_t>& colours,
              CloudBuilder& cloud)
      : labels_ (labels)
      , colours_ (colours)
      , cloud_ (cloud)
  {
    if (colours_)
      colour_at_ = cloud.add ("rgb", PCLPointField::UINT32, sizeof (std::uint32_t));
    if (labels_)
      label_at_ = cloud.add ("label", PCLPointField::UINT32, sizeof (std::uint32_t));
  }

  void fill ()
  {
    for (std::size_t n = 0; labels_ && n < cloud_.size (); ++n)
      cloud_.set (n, label_at_, labels_->data ()[n]);
    for (std::size_t n = 0; colours_ && n < cloud_.size (); ++n)
    {
      const std::uint8_t* rgb = colours_->data () + 3 * n;
      cloud_.set (n, colour_at_,
                  0xff000000u | (static_cast<std::uint32_t> (rgb[0]) << 16u) |
                      (static_cast<std::uint32_t> (rgb[1]) << 8u) | rgb[2]);
    }
  }

private:
  const OptionalArray<std::uint32_t>& labels_;
  const OptionalArray<std::uint8_t>& colours_;
  CloudBuilder& cloud_;
  std::size_t colour_at_ = 0, label_at_ = 0;
};

} // namespace

ViewData
viewOfDepth (const DenseArray<float>& depth, const OptionalArray<std::uint32_t>& labels,
             const OptionalArray<std::uint8_t>& colours, const std::array<double, 4>& intrinsics,
             const DenseArray<double>& pose)
{
  constexpr float none = std::numeric_limits<float>::quiet_NaN ();
  const py::ssize_t height = depth.shape (0), width = depth.shape (1);
  const pcl::cosection::PinholeCamera camera = toCamera (intrinsics, height, width);
  camera.validate ();
  CloudBuilder cloud (height, width);
  std::array<std::size_t, 3> at;
  for (std::size_t axis = 0; axis < 3; ++axis)
    at[axis] = cloud.add (std::array{"x", "y", "z"}[axis], PCLPointField::FLOAT32, sizeof (float));
  Attributes attributes (labels, colours, cloud);
  cloud.allocate ();
  std::size_t point = 0;
  for (py::ssize_t v = 0; v < height; ++v)
    for (py::ssize_t u = 0; u < width; ++u, ++point)
    {
      const float z = depth.data ()[point];
      Eigen::Vector3f p (none, none, none);
      if (std::isfinite (z) && z > 0.0f)
        p = camera.unproject (static_cast<double> (u), static_cast<double> (v), z).cast<float> ();
      for (std::size_t axis = 0; axis < 3; ++axis)
        cloud.set (point, at[axis], p[static_cast<Eigen::Index> (axis)]);
    }
  attributes.fill ();
  return {cloud.take (), toIsometry (pose), ""};
}

ViewData
viewOfPoints (const py::array& points, const OptionalArray<std::uint32_t>& labels,
              const OptionalArray<std::uint8_t>& colours, const OptionalArray<float>& normals,
              const DenseArray<double>& pose)
{
  const bool organized = points.ndim () == 3;
  CloudBuilder cloud (organized ? points.shape (0) : 1, organized ? points.shape (1) : points.shape (0));
  const bool is_double = points.itemsize () == sizeof (double);
  const auto bytes = static_cast<std::size_t> (points.itemsize ());
  for (const char* name : {"x", "y", "z"})
    cloud.add (name, is_double ? PCLPointField::FLOAT64 : PCLPointField::FLOAT32, bytes);
  std::size_t normal_at = 0;
  if (normals)
  {
    normal_at = cloud.add ("normal_x", PCLPointField::FLOAT32, sizeof (float));
    cloud.add ("normal_y", PCLPointField::FLOAT32, sizeof (float));
    cloud.add ("normal_z", PCLPointField::FLOAT32, sizeof (float));
  }
  Attributes attributes (labels, colours, cloud);
  cloud.allocate ();
  for (std::size_t n = 0; n < cloud.size (); ++n)
  {
    if (is_double)
      cloud.set (n, 0,
                 *reinterpret_cast<const std::array<double, 3>*> (static_cast<const double*> (points.data ()) + 3 * n));
    else
      cloud.set (n, 0,
                 *reinterpret_cast<const std::array<float, 3>*> (static_cast<const float*> (points.data ()) + 3 * n));
    if (normals)
      cloud.set (n, normal_at, *reinterpret_cast<const std::array<float, 3>*> (normals->data () + 3 * n));
  }
  attributes.fill ();
  return {cloud.take (), toIsometry (pose), ""};
}
