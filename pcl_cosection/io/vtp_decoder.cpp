// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors

#include "mesh_decoders.h"

#include <pcl/cosection/common/error.h>

#include <vtkCellArray.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataReader.h>

#include <exception>

namespace pcl
{
namespace cosection
{
namespace
{

/** \brief While it lives VTK says nothing: parts of a reader speak that have no observers. */
class VtkSilence
{
public:
  VtkSilence () : before_ (vtkObject::GetGlobalWarningDisplay ())
  {
    vtkObject::GlobalWarningDisplayOff ();
  }
  VtkSilence (const VtkSilence&) = delete;
  VtkSilence&
  operator= (const VtkSilence&) = delete;
  ~VtkSilence ()
  {
    vtkObject::SetGlobalWarningDisplay (before_);
  }

private:
  int before_;
};

/** \brief Tells whether something went wrong, which VTK only prints. */
class CheckedReader : public vtkXMLPolyDataReader
{
public:
  vtkTypeMacro (CheckedReader, vtkXMLPolyDataReader);

  static CheckedReader*
  New ()
  {
    VTK_STANDARD_NEW_BODY (CheckedReader);
  }

  bool
  failed () const
  {
    return InformationError != 0 || DataError != 0;
  }
};

/** \brief Calls \a add with the indices of each cell; VTK does not check them. */
template <typename Add>
void
forEachCell (vtkCellArray& cells, Add&& add)
{
  vtkDataArray& offsets = *cells.GetOffsetsArray ();
  vtkDataArray& indices = *cells.GetConnectivityArray ();
  std::vector<std::int64_t> corners;
  for (vtkIdType n = 1; n < offsets.GetNumberOfTuples (); ++n)
  {
    const auto begin = static_cast<vtkIdType> (offsets.GetTuple1 (n - 1));
    const auto end = static_cast<vtkIdType> (offsets.GetTuple1 (n));
    if (begin < 0 || end < begin || end > indices.GetNumberOfTuples ())
      throw IoError ("the offsets of the VTK file's cells do not fit their connectivity");
    corners.clear ();
    for (vtkIdType m = begin; m < end; ++m)
      corners.push_back (static_cast<std::int64_t> (indices.GetTuple1 (m)));
    add (corners);
  }
}

PolygonSoup
toSoup (vtkPolyData& data)
{
  PolygonSoup soup;
  for (vtkIdType n = 0; n < data.GetNumberOfPoints (); ++n)
  {
    Eigen::Vector3d p;
    data.GetPoint (n, p.data ());
    soup.points.push_back (p.cast<float> ());
  }
  forEachCell (*data.GetPolys (), [&soup] (const std::vector<std::int64_t>& corners) {
    soup.corners.insert (soup.corners.end (), corners.begin (), corners.end ());
    soup.endPolygon ();
  });
  forEachCell (*data.GetStrips (), [&soup] (const std::vector<std::int64_t>& corners) { soup.addStrip (corners); });
  return soup;
}

} // namespace

PolygonSoup
decodeVtp (const std::string& bytes)
{
  const std::size_t end_of_head = bytes.find ("<AppendedData");
  const std::string head = bytes.substr (0, end_of_head);
  if (head.find ("<VTKFile") == std::string::npos)
    throw IoError ("it has no VTKFile element");
  if (head.find ("PolyData") == std::string::npos)
    throw IoError ("the VTK file does not hold PolyData");
  const VtkSilence silence;
  vtkNew<CheckedReader> reader;
  reader->ReadFromInputStringOn ();
  reader->SetInputString (bytes);
  try
  {
    reader->Update ();
  }
  catch (const std::exception&) // of sizes that no memory can hold
  {
    throw IoError ("VTK cannot read it: it is damaged");
  }
  if (reader->failed () || reader->GetOutput () == nullptr)
    throw IoError ("VTK cannot read it: it is damaged, or ends too early");
  return toSoup (*reader->GetOutput ());
}

} // namespace cosection
} // namespace pcl
