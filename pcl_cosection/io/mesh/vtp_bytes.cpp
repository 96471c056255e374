// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors

#include "vtp_bytes.h"

#include <pcl/cosection/common/error.h>

#include <vtkDataCompressor.h>
#include <vtkLZ4DataCompressor.h>
#include <vtkLZMADataCompressor.h>
#include <vtkObject.h>
#include <vtkSmartPointer.h>
#include <vtkZLibDataCompressor.h>

#include <algorithm>

namespace pcl::cosection
{
namespace
{

constexpr const char* cut_off = "an array of the VTK file is shorter than its header says";

/** \brief While it lives VTK prints nothing. */
class VtkSilence
{
public:
  VtkSilence () : before_ (vtkObject::GetGlobalWarningDisplay ()) { vtkObject::GlobalWarningDisplayOff (); }
  VtkSilence (const VtkSilence&) = delete;
  VtkSilence& operator= (const VtkSilence&) = delete;
  ~VtkSilence () { vtkObject::SetGlobalWarningDisplay (before_); }

private:
  int before_;
};

/** \brief The value of a digit of base 64; -1 if it is none. */
int
digitOf (char c)
{
  if (c >= 'A' && c <= 'Z')
    return c - 'A';
  if (c >= 'a' && c <= 'z')
    return c - 'a' + 26;
  if (c >= '0' && c <= '9')
    return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

/** \brief Takes bytes from what is stored raw or in base 64. */
class StoredBytes
{
public:
  StoredBytes (std::string_view stored, bool base64) : left_ (stored), base64_ (base64) {}

  /** \brief An upper bound of what there is. */
  std::size_t most () const { return decoded_.size () + left_.size (); }

  std::string take (std::uint64_t size)
  {
    if (size > most ())
      throw IoError (cut_off);
    while (base64_ && decoded_.size () < size && decodeFour ())
    {}
    std::string taken;
    if (base64_)
    {
      taken = decoded_.substr (0, size);
      decoded_.erase (0, size);
    }
    else
    {
      taken = left_.substr (0, size);
      left_.remove_prefix (size);
    }
    if (taken.size () < size)
      throw IoError (cut_off);
    return taken;
  }

  /** \brief What follows is encoded anew: padding ends here. */
  void endPart () { decoded_.clear (); }

private:
  /** \brief Four characters that are up to three bytes. \return whether there were any */
  bool decodeFour ()
  {
    std::uint32_t bits = 0;
    int digits = 0;
    for (int n = 0; n < 4; ++n)
    {
      left_.remove_prefix (std::min (left_.find_first_not_of (" \t\r\n"), left_.size ()));
      if (left_.empty ())
        return false;
      const int digit = digitOf (left_[0]);
      if (digit < 0 && (left_[0] != '=' || n < 2))
        return false;
      if (digit >= 0 && digits < n)
        return false; // behind padding
      digits += digit >= 0;
      bits = bits << 6 | static_cast<std::uint32_t> (std::max (digit, 0));
      left_.remove_prefix (1);
    }
    for (int n = 0; n + 1 < digits; ++n)
      decoded_ += static_cast<char> (bits >> (16 - 8 * n) & 0xff);
    return true;
  }

  std::string_view left_;
  bool base64_;
  std::string decoded_; // and not yet taken
};

struct Compressor
{
  vtkSmartPointer<vtkDataCompressor> method;
  std::uint64_t most_ratio = 0; ///< of what it makes smaller at best
};

Compressor
compressorOf (std::string_view name)
{
  if (name == "vtkZLibDataCompressor")
    return {vtkSmartPointer<vtkZLibDataCompressor>::New (), 1100};
  if (name == "vtkLZ4DataCompressor")
    return {vtkSmartPointer<vtkLZ4DataCompressor>::New (), 256};
  if (name == "vtkLZMADataCompressor")
    return {vtkSmartPointer<vtkLZMADataCompressor>::New (), 10000};
  throw IoError ("the compressor " + quoted (name) + " of the VTK file is not known");
}

/** \brief The next \a count sizes. */
std::vector<std::uint64_t>
takeSizes (const VtpStorage& storage, std::uint64_t count, StoredBytes& stored)
{
  const std::string bytes = stored.take (count * sizeOf (storage.header));
  TextScanner scanner (bytes);
  ValueReader reader (scanner, storage.order, "VTK");
  std::vector<std::uint64_t> sizes;
  for (std::uint64_t n = 0; n < count; ++n)
  {
    const std::int64_t size = reader.nextIndex (storage.header);
    if (size < 0)
      throw IoError ("an array of the VTK file has an impossible size");
    sizes.push_back (static_cast<std::uint64_t> (size));
  }
  return sizes;
}

std::string
decompress (const VtpStorage& storage, StoredBytes& stored, std::uint64_t size)
{
  const Compressor compressor = compressorOf (storage.compressor);
  const auto layout = takeSizes (storage, 3, stored); // number of blocks, size of each, size of the last if it differs
  if (layout[0] > stored.most ())
    throw IoError (cut_off);
  const auto packed_sizes = takeSizes (storage, layout[0], stored);
  stored.endPart ();
  const VtkSilence silence;
  std::string bytes;
  for (std::size_t n = 0; n < packed_sizes.size () && bytes.size () < size; ++n)
  {
    const std::string packed = stored.take (packed_sizes[n]);
    const std::uint64_t block = (n + 1 == packed_sizes.size () && layout[2] != 0 ? layout[2] : layout[1]);
    constexpr std::uint64_t slack = 1024;
    if (block > compressor.most_ratio * packed.size () + slack)
      throw IoError ("a block of the VTK file cannot be as large as its header says");
    const std::size_t before = bytes.size ();
    bytes.resize (before + block);
    if (compressor.method->Uncompress (reinterpret_cast<const unsigned char*> (packed.data ()), packed.size (),
                                       reinterpret_cast<unsigned char*> (&bytes[before]), block) != block)
      throw IoError ("a compressed block of the VTK file is damaged");
  }
  if (bytes.size () < size)
    throw IoError (cut_off);
  return bytes;
}

} // namespace

VtpStorage::VtpStorage (const VtpDocument& document) : compressor (document.file.attribute ("compressor"))
{
  const std::string_view order_name = document.file.attribute ("byte_order");
  if (order_name == "BigEndian")
    order = Encoding::BigEndian;
  else if (!order_name.empty () && order_name != "LittleEndian")
    throw IoError ("the byte order " + quoted (order_name) + " of the VTK file is not known");
  const std::string_view header_name = document.file.attribute ("header_type");
  if (header_name == "UInt64")
    header = ScalarType::UInt64;
  else if (!header_name.empty () && header_name != "UInt32")
    throw IoError ("the header type " + quoted (header_name) + " of the VTK file is not known");
}

std::string
decodeVtpBytes (const VtpStorage& storage, std::string_view stored, bool base64, std::uint64_t size)
{
  StoredBytes bytes (stored, base64);
  if (!storage.compressor.empty ())
    return decompress (storage, bytes, size);
  if (takeSizes (storage, 1, bytes)[0] < size)
    throw IoError (cut_off);
  return bytes.take (size);
}

} // namespace pcl::cosection
