// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "pcl_cosection/common/file_bytes.h"
#include "pcl_cosection/io/mesh/vtk_errors.h"

#include "pcl_cosection/common/atomic_file.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/mesh_io.h>

#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnsignedCharArray.h>
#include <vtkXMLImageDataWriter.h>

namespace pcl::cosection {
namespace {

/** \brief Lends \a values to the image, which only reads them. */
template <typename Array, typename T>
void
addArray (vtkImageData& image, const char* name, const std::vector<T>& values)
{
  vtkNew<Array> array;
  array->SetName (name);
  array->SetArray (const_cast<T*> (values.data ()), static_cast<vtkIdType> (values.size ()), 1);
  image.GetPointData ()->AddArray (array);
}

} // namespace

void
saveSignedDistance (const SignedDistanceField& field, const std::string& path)
{
  const VoxelGrid& grid = field.grid;
  if (grid.dims.minCoeff () < 1 || field.values.size () != grid.size () ||
      (!field.supported.empty () && field.supported.size () != grid.size ()))
    throw InvalidArgument ("cannot write '" + path + "': the field must have one value per voxel");

  vtkNew<vtkImageData> image;
  image->SetDimensions (grid.dims.x (), grid.dims.y (), grid.dims.z ());
  image->SetSpacing (grid.voxel_size_m, grid.voxel_size_m, grid.voxel_size_m);
  image->SetOrigin (grid.origin_m.x (), grid.origin_m.y (), grid.origin_m.z ());
  addArray<vtkFloatArray> (*image, "signed_distance", field.values);
  if (!field.supported.empty ())
    addArray<vtkUnsignedCharArray> (*image, "supported", field.supported);
  image->GetPointData ()->SetActiveScalars ("signed_distance");

  writeAtomically (path, [&] (const std::string& temporary) {
    // VTK encodes, we write: its own report of a full disk or a missing right says little.
    vtkNew<vtkXMLImageDataWriter> writer;
    const auto errors = VtkErrors::observe (*writer);
    writer->SetInputData (image);
    writer->EncodeAppendedDataOff ();
    writer->SetCompressorTypeToNone (); // compressing would take several times as long as all the rest
    writer->SetHeaderTypeToUInt64 ();
    writer->WriteToOutputStringOn ();
    if (writer->Write () == 0 || errors->failed ())
      throw IoError ("cannot write '" + path + "': VTK could not encode the field");
    writeBytes (temporary, writer->GetOutputString ());
  });
}

} // namespace pcl::cosection
