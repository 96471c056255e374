// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/io/text_scanner.h"

#include <pcl/cosection/common/error.h>

#include <cstddef>
#include <cstdint>
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

/** \brief Bytes of a binary value. */
std::size_t sizeOf (ScalarType type);

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
  void require (std::uint64_t count, std::size_t bytes, std::size_t values) const;

  /** \brief The next value. */
  double next (ScalarType type);

  /** \brief The next value as an index; -1 if it cannot be an index. */
  std::int64_t nextIndex (ScalarType type);

private:
  [[noreturn]] void failShort () const;

  TextScanner& scanner_;
  Encoding encoding_;
  std::string what_;
};

} // namespace pcl::cosection
