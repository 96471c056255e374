// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "common/message_of.h"
#include "common/temporary_folder.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/mesh_io.h>

#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataWriter.h>

#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
#include <fstream>

using namespace pcl::cosection;
using test::messageOf;
using test::readFile;
using test::TemporaryFolder;
using test::writeFile;

namespace {

constexpr int columns = 40;

/** \brief A wavy sheet of quadrangles, large enough for several compressed blocks. */
vtkNew<vtkPolyData>
sheet ()
{
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> polys;
  for (int v = 0; v < columns; ++v)
    for (int u = 0; u < columns; ++u)
      points->InsertNextPoint (u, v, std::sin (0.3 * u * v));
  for (int v = 1; v < columns; ++v)
    for (int u = 1; u < columns; ++u)
    {
      const vtkIdType last = v * columns + u;
      const vtkIdType corners[] = {last - columns - 1, last - columns, last, last - 1};
      polys->InsertNextCell (4, corners);
    }
  vtkNew<vtkPolyData> data;
  data->SetPoints (points);
  data->SetPolys (polys);
  return data;
}

const char* const piece = "<Piece NumberOfPoints=\"3\" NumberOfPolys=\"1\" NumberOfStrips=\"0\">\n"
                          "<!-- <Points> -->\n<PointData><DataArray type='Float32' Name=\"a > b\" format='ascii'> 7 8 9"
                          "</DataArray></PointData>\n"
                          "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">";
const char* const cells = "</DataArray></Points>\n<Lines/><Polys>\n<DataArray type=\"Int64\" Name=\"connectivity\" "
                          "format=\"ascii\">0 1 2</DataArray>\n"
                          "<DataArray type='UInt8' Name='offsets' format='ascii'>3</DataArray></Polys></Piece>\n";

/** \brief Limits the growth of the address space to some bytes, for its lifetime. */
class MemoryLimit
{
public:
  explicit MemoryLimit (std::size_t growth)
  {
    std::size_t pages = 0;
    std::ifstream ("/proc/self/statm") >> pages;
    ::getrlimit (RLIMIT_AS, &before_);
    const rlimit limited{pages * static_cast<std::size_t> (::sysconf (_SC_PAGESIZE)) + growth, before_.rlim_max};
    ::setrlimit (RLIMIT_AS, &limited);
  }
  MemoryLimit (const MemoryLimit&) = delete;
  MemoryLimit& operator= (const MemoryLimit&) = delete;

  ~MemoryLimit () { ::setrlimit (RLIMIT_AS, &before_); }

private:
  rlimit before_;
};

constexpr std::size_t most_growth = 1 << 28;

} // namespace

TEST (VtpReader, ReadsWhateverVtkWrites)
{
  const TemporaryFolder folder;
  const std::string path = folder.file ("sheet.vtp");
  const auto data = sheet ();
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputData (data);
  writer->SetFileName (path.c_str ());
  writer->SetBlockSize (2048);
  const auto check = [&] {
    writer->Write ();
    const TriangleMesh mesh = loadMesh (path);
    EXPECT_EQ (mesh.triangles.size (), 2u * (columns - 1) * (columns - 1));
    ASSERT_EQ (mesh.vertices.size (), std::size_t{columns} * columns);
    for (std::size_t v = 0; v < mesh.vertices.size (); ++v)
    {
      Eigen::Vector3d p;
      data->GetPoint (static_cast<vtkIdType> (v), p.data ());
      ASSERT_EQ (mesh.vertices[v], p.cast<float> ()) << "vertex " << v;
    }
  };
  for (const int compressor : {vtkXMLWriter::NONE, vtkXMLWriter::ZLIB, vtkXMLWriter::LZ4})
    for (const int header : {vtkXMLWriter::UInt32, vtkXMLWriter::UInt64})
      for (const int order : {vtkXMLWriter::BigEndian, vtkXMLWriter::LittleEndian})
      {
        writer->SetCompressorType (compressor);
        writer->SetHeaderType (header);
        writer->SetByteOrder (order);
        writer->SetDataModeToAscii ();
        check ();
        writer->SetDataModeToAppended ();
        writer->EncodeAppendedDataOff ();
        check ();
        writer->EncodeAppendedDataOn ();
        check ();
        writer->SetDataModeToBinary (); // base 64: otherwise the writer continues with raw data, which is no XML
        check ();
      }
  writer->SetCompressorTypeToLZMA ();
  writer->SetBlockSize (1 << 15); // each takes long
  check ();
}

TEST (VtpReader, PiecesAreOneMesh)
{
  const TemporaryFolder folder;
  const std::string path = folder.file ("pieces.vtp");
  writeFile (path, std::string ("<?xml version=\"1.0\"?>\n<VTKFile type='PolyData'><PolyData>\n") + piece +
                       "0 0 0 1 0 0 0 1 0" + cells + piece + "0 0 0 0 1 0 0 0 1" + cells + "</PolyData></VTKFile>\n");
  const TriangleMesh mesh = loadMesh (path);
  EXPECT_EQ (mesh.vertices.size (), 4u);
  EXPECT_EQ (mesh.triangles.size (), 2u);

  // Pieces that do not end.
  writeFile (path, std::string ("<VTKFile type='PolyData'>\n") + piece + piece + "0 0 0 1 0 0 0 1 0" + cells + piece +
                       "</VTKFile>\n");
  EXPECT_NE (messageOf<IoError> ([&] { loadMesh (path); }), "");
}

TEST (VtpReader, SizesThatCannotBeTakeNoMemory)
{
  const TemporaryFolder folder;
  const std::string path = folder.file ("sizes.vtp");
  const auto data = sheet ();
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputData (data);
  writer->SetFileName (path.c_str ());
  writer->EncodeAppendedDataOff ();
  for (const int compressor : {vtkXMLWriter::NONE, vtkXMLWriter::ZLIB, vtkXMLWriter::LZ4})
  {
    writer->SetCompressorType (compressor);
    writer->Write ();
    const std::string good = readFile (path);
    const std::size_t sizes = good.find ("_", good.find ("<AppendedData")) + 1;
    // Number of blocks, their size, that of the last, and that of the first compressed; or bytes.
    for (std::size_t place = 0; place < (compressor == vtkXMLWriter::NONE ? 1 : 4); ++place)
      for (const char* huge : {"\xff\xff\xff\x7f", "\xff\xff\xff\xff", "\0\0\0\x40"})
      {
        std::string bytes = good;
        bytes.replace (sizes + 4 * place, 4, huge, 4);
        writeFile (path, bytes);
        const MemoryLimit limit (most_growth);
        try
        {
          loadMesh (path); // a size that is not used may have any value
        }
        catch (const IoError&)
        {}
      }
    for (const char* count : {"NumberOfPoints=\"", "NumberOfPolys=\""})
      for (const char* huge : {"4000000000", "99999999999999999999", "-1", "1e9"})
      {
        std::string bytes = good;
        bytes.insert (bytes.find (count) + std::string (count).size (), huge);
        writeFile (path, bytes);
        EXPECT_NE (messageOf<IoError> ([&] { loadMesh (path); }), "") << count << huge;
      }
  }
}
