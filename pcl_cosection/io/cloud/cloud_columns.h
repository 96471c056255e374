// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cloud_file.h"

#include <pcl/cosection/common/error.h>

#include <cstring>

namespace pcl::cosection {

/** \brief One field of a loaded cloud, any numeric type. */
class CloudColumn
{
public:
  CloudColumn (const std::string& path, const PCLPointCloud2& cloud, const CloudField& field)
      : data_ (cloud.data.data ())
      , step_ (cloud.point_step)
      , type_ (field.type)
      , size_ (field.size)
  {
    for (const PCLPointField& f : cloud.fields)
      if (f.name == field.name)
      {
        offset_ = f.offset;
        if (offset_ + size_ <= step_)
          return;
      }
    throw IoError (path + ": field " + field.name + " cannot be read");
  }

  double real (std::size_t i) const { return (size_ == 4 ? static_cast<double> (load<float> (i)) : load<double> (i)); }

  std::int64_t integer (std::size_t i) const
  {
    switch (size_)
    {
    case 1:
      return (type_ == 'I' ? load<std::int8_t> (i) : load<std::uint8_t> (i));
    case 2:
      return (type_ == 'I' ? load<std::int16_t> (i) : load<std::uint16_t> (i));
    case 4:
      return (type_ == 'I' ? load<std::int32_t> (i) : static_cast<std::int64_t> (load<std::uint32_t> (i)));
    default:
      return (load<std::int64_t> (i));
    }
  }

  double number (std::size_t i) const { return type_ == 'F' ? real (i) : static_cast<double> (integer (i)); }

  std::uint32_t bits (std::size_t i) const { return (load<std::uint32_t> (i)); }

private:
  template <typename T> T load (std::size_t i) const
  {
    T value;
    std::memcpy (&value, data_ + i * step_ + offset_, sizeof (T));
    return (value);
  }

  const std::uint8_t* data_;
  std::size_t step_;
  std::size_t offset_ = 0;
  char type_;
  std::size_t size_;
};

} // namespace pcl::cosection
