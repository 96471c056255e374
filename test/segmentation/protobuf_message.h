// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstring>
#include <string>

namespace pcl::cosection::test {

/** \brief A message in the encoding of Protocol Buffers, field by field. */
class ProtobufMessage
{
public:
  /** \brief A whole number. */
  ProtobufMessage& number (int field, std::int64_t value)
  {
    varint (static_cast<std::uint64_t> (field) << 3);
    varint (static_cast<std::uint64_t> (value));
    return (*this);
  }

  /** \brief A string, or bytes. */
  ProtobufMessage& text (int field, const std::string& bytes)
  {
    varint (static_cast<std::uint64_t> (field) << 3 | 2);
    varint (bytes.size ());
    bytes_ += bytes;
    return (*this);
  }

  ProtobufMessage& message (int field, const ProtobufMessage& inner) { return (text (field, inner.bytes_)); }

  const std::string& bytes () const { return (bytes_); }

private:
  void varint (std::uint64_t value)
  {
    for (; value > 127; value >>= 7)
      bytes_ += static_cast<char> ((value & 127) | 128);
    bytes_ += static_cast<char> (value);
  }

  std::string bytes_;
};

/** \brief Numbers as they stand in memory. */
template <typename Container>
std::string
rawBytes (const Container& values)
{
  std::string bytes (sizeof (*values.data ()) * values.size (), '\0');
  if (!bytes.empty ()) // no values may have no address
    std::memcpy (bytes.data (), values.data (), bytes.size ());
  return (bytes);
}

} // namespace pcl::cosection::test
