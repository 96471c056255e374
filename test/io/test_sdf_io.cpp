// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "common/message_of.h"
#include "common/temporary_folder.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/mesh_io.h>

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <vector>

using namespace pcl::cosection;
using test::messageOf;
using test::TemporaryFolder;

namespace {

SignedDistanceField
ramp ()
{
  SignedDistanceField field;
  field.grid.dims = {5, 4, 3};
  field.grid.voxel_size_m = 0.02;
  field.grid.origin_m = {0.1, -0.2, 0.3};
  for (std::size_t n = 0; n < field.grid.size (); ++n)
  {
    field.values.push_back (0.01f * static_cast<float> (n) - 0.2f);
    field.supported.push_back (n % 3 == 0);
  }
  return field;
}

/** \brief The value of an XML attribute, after the first element that contains \a mark. */
std::string
attribute (const std::string& xml, const std::string& mark, const std::string& name)
{
  const auto element = xml.find (mark);
  const auto value = xml.find (" " + name + "=\"", element);
  if (element == std::string::npos || value == std::string::npos)
    return {};
  const auto begin = value + name.size () + 3;
  return xml.substr (begin, xml.find ('"', begin) - begin);
}

/** \brief An array of the raw data at the end of the file, stored as its size in bytes and its values. */
template <typename T>
std::vector<T>
appendedArray (const std::string& file, const std::string& name)
{
  const auto data = file.find ('_', file.find ("<AppendedData encoding=\"raw\">")) + 1;
  const auto begin = data + std::stoull (attribute (file, "Name=\"" + name + "\"", "offset"));
  std::uint64_t bytes = 0;
  std::memcpy (&bytes, file.data () + begin, sizeof (bytes));
  std::vector<T> values (bytes / sizeof (T));
  std::memcpy (values.data (), file.data () + begin + sizeof (bytes), bytes);
  return values;
}

} // namespace

TEST (SdfIo, IsRawImageData)
{
  const TemporaryFolder folder;
  auto field = ramp ();
  for (const bool with_support : {true, false})
  {
    if (!with_support)
      field.supported.clear ();
    saveSignedDistance (field, folder.file ("a.vti"));
    const auto file = test::readFile (folder.file ("a.vti"));
    EXPECT_EQ (attribute (file, "<VTKFile", "type"), "ImageData");
    EXPECT_EQ (attribute (file, "<VTKFile", "byte_order"), "LittleEndian");
    EXPECT_EQ (attribute (file, "<VTKFile", "header_type"), "UInt64");
    EXPECT_EQ (attribute (file, "<ImageData", "WholeExtent"), "0 4 0 3 0 2");
    EXPECT_EQ (attribute (file, "<ImageData", "Origin"), "0.1 -0.2 0.3");
    EXPECT_EQ (attribute (file, "<ImageData", "Spacing"), "0.02 0.02 0.02");
    EXPECT_EQ (appendedArray<float> (file, "signed_distance"), field.values);
    ASSERT_EQ (file.find ("Name=\"supported\"") != std::string::npos, with_support);
    if (with_support)
    {
      EXPECT_EQ (appendedArray<std::uint8_t> (file, "supported"), field.supported);
    }
  }
  EXPECT_EQ (folder.entries (), 1u);
}

TEST (SdfIo, ReportsWhatGoesWrongAndPrintsNothing)
{
  const TemporaryFolder folder;
  const auto missing = folder.file ("missing/a.vti");
  const auto path = folder.file ("a.vti");
  testing::internal::CaptureStderr ();
  EXPECT_EQ (messageOf<IoError> ([&] { saveSignedDistance (ramp (), missing); }),
             "cannot write '" + missing + "': No such file or directory");
  std::string message;
  {
    const test::FileSizeLimit limit (200);
    message = messageOf<IoError> ([&] { saveSignedDistance (ramp (), path); });
  }
  EXPECT_EQ (message, "cannot write '" + path + "': File too large");
  EXPECT_EQ (testing::internal::GetCapturedStderr (), "");
  auto field = ramp ();
  field.values.pop_back ();
  EXPECT_THROW (saveSignedDistance (field, path), InvalidArgument);
  EXPECT_EQ (folder.entries (), 0u);
}
