// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors

#include "temporary_folder.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/sdf_io.h>

#include <gtest/gtest.h>

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkXMLImageDataReader.h>

using namespace pcl::cosection;
using test::messageOf;
using test::TemporaryFolder;

namespace
{

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

} // namespace

TEST (SdfIo, VtkReadsWhatWasWritten)
{
  const TemporaryFolder folder;
  auto field = ramp ();
  for (const bool with_support : {true, false})
  {
    if (!with_support)
      field.supported.clear ();
    saveSignedDistance (field, folder.file ("a.vti"));
    vtkNew<vtkXMLImageDataReader> reader;
    reader->SetFileName (folder.file ("a.vti").c_str ());
    reader->Update ();
    vtkImageData* image = reader->GetOutput ();
    for (int axis = 0; axis < 3; ++axis)
    {
      EXPECT_EQ (image->GetDimensions ()[axis], field.grid.dims[axis]);
      EXPECT_DOUBLE_EQ (image->GetSpacing ()[axis], 0.02);
      EXPECT_DOUBLE_EQ (image->GetOrigin ()[axis], field.grid.origin_m[axis]);
    }
    vtkDataArray* values = image->GetPointData ()->GetArray ("signed_distance");
    vtkDataArray* supported = image->GetPointData ()->GetArray ("supported");
    ASSERT_NE (values, nullptr);
    EXPECT_STREQ (values->GetDataTypeAsString (), "float");
    ASSERT_EQ (static_cast<std::size_t> (values->GetNumberOfTuples ()), field.values.size ());
    for (std::size_t n = 0; n < field.values.size (); ++n)
      EXPECT_EQ (static_cast<float> (values->GetTuple1 (static_cast<vtkIdType> (n))), field.values[n]);
    ASSERT_EQ (supported != nullptr, with_support);
    for (std::size_t n = 0; n < field.supported.size (); ++n)
      EXPECT_EQ (supported->GetTuple1 (static_cast<vtkIdType> (n)), field.supported[n]);
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
