// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/io/text_scanner.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

namespace pcl::cosection {

enum class ScalarType
{
  Int8,
  UInt8,
  Int16,
  UInt16,
  Int32,
  UInt32,
  Int64,
  UInt64,
  Float32,
  Float64,
};

enum class Encoding
{
  Ascii,
  LittleEndian,
  BigEndian,
};

template <typename T>
double
loadScalar (const char* data)
{
  T value;
  std::memcpy (&value, data, sizeof (T));
  return static_cast<double> (value);
}

/** \brief How values of a type are stored. */
struct ScalarStorage
{
  std::size_t size;
  double (*load) (const char* data);
};

inline const ScalarStorage&
storageOf (ScalarType type)
{
  static constexpr ScalarStorage types[] = {
      {1, loadScalar<std::int8_t>},   {1, loadScalar<std::uint8_t>},  {2, loadScalar<std::int16_t>},
      {2, loadScalar<std::uint16_t>}, {4, loadScalar<std::int32_t>},  {4, loadScalar<std::uint32_t>},
      {8, loadScalar<std::int64_t>},  {8, loadScalar<std::uint64_t>}, {4, loadScalar<float>},
      {8, loadScalar<double>}}; // in the order of ScalarType
  return types[static_cast<std::size_t> (type)];
}

/** \brief Bytes of a binary value. */
inline std::size_t
sizeOf (ScalarType type)
{
  return storageOf (type).size;
}

/** \brief Reads the numbers of a file, text or binary; every access is checked.
 * All functions throw IoError, whose message is only the reason, where the file ends too early. */
class ValueReader
{
public:
  /** \param[in] scanner where the values begin; behind them later
   * \param[in] what of the file, for the message */
  ValueReader (TextScanner& scanner, Encoding encoding, std::string what)
      : scanner_ (scanner)
      , encoding_ (encoding)
      , what_ (std::move (what))
  {}

  /** \brief Checks that \a count times as many bytes (binary) or values (text) can follow; call it
   * before memory for them is taken. */
  void require (std::uint64_t count, std::size_t bytes, std::size_t values) const
  {
    // A value of text takes a character and one between it and the next.
    const std::size_t each = (encoding_ == Encoding::Ascii ? 2 * values : bytes);
    const std::size_t left = scanner_.left ().size () + (encoding_ == Encoding::Ascii ? 1 : 0);
    if (each != 0 && count > left / each)
      failShort ();
  }

  /** \brief The next value. */
  double next (ScalarType type)
  {
    if (encoding_ == Encoding::Ascii)
    {
      const std::string_view word = scanner_.word ();
      if (word.empty ())
        failShort ();
      return toReal (word);
    }
    const ScalarStorage& storage = storageOf (type);
    const std::string_view bytes = scanner_.bytes (storage.size);
    if (bytes.size () != storage.size)
      failShort ();
    if (encoding_ == Encoding::LittleEndian)
      return storage.load (bytes.data ());
    std::array<char, 8> swapped;
    std::reverse_copy (bytes.begin (), bytes.end (), swapped.begin ());
    return storage.load (swapped.data ());
  }

  /** \brief The next value as an index; -1 if it cannot be an index. */
  std::int64_t nextIndex (ScalarType type)
  {
    constexpr double most = 1e15; // far more than there can be, and exact
    const double value = next (type);
    return value >= 0.0 && value <= most ? static_cast<std::int64_t> (value) : -1;
  }

private:
  [[noreturn]] void failShort () const { throw IoError ("the " + what_ + " file is shorter than its header says"); }

  TextScanner& scanner_;
  Encoding encoding_;
  std::string what_;
};

} // namespace pcl::cosection
