// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// VTK parses the XML and decodes the arrays. They are put together by hand, because vtkXMLPolyDataReader takes as much
// memory as counts, offsets of cells and sizes of blocks say and writes beyond it where they overflow or disagree.

#include "mesh_decoders.h"
#include "value_reader.h"
#include "vtk_errors.h"

#include <vtkBase64Utilities.h>
#include <vtkDataArray.h>
#include <vtkLZ4DataCompressor.h>
#include <vtkLZMADataCompressor.h>
#include <vtkNew.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLDataParser.h>
#include <vtkZLibDataCompressor.h>

#include <limits>
#include <sstream>

namespace pcl::cosection {
namespace {

constexpr const char* cut_off = "an array of the VTK file is shorter than its header says";

/** \brief Builds no more than a few levels of elements, as VTK destroys them by recursion. */
class ShallowParser : public vtkXMLDataParser
{
public:
  vtkTypeMacro (ShallowParser, vtkXMLDataParser);

  static ShallowParser* New () { return new ShallowParser; }

  bool tooDeep () const { return too_deep_; }

protected:
  void StartElement (const char* name, const char** attributes) override
  {
    constexpr int deepest = 20; // VTK writes six
    too_deep_ = too_deep_ || ++depth_ > deepest;
    if (!too_deep_)
      Superclass::StartElement (name, attributes);
  }

  void EndElement (const char* name) override
  {
    --depth_;
    if (!too_deep_)
      Superclass::EndElement (name);
  }

private:
  int depth_ = 0;
  bool too_deep_ = false;
};

std::string_view
attribute (vtkXMLDataElement& element, const char* key)
{
  const char* const value = element.GetAttribute (key);
  return value == nullptr ? std::string_view () : value;
}

/** \brief How many there are of something. \return 0 if the file does not say */
std::uint64_t
countOf (vtkXMLDataElement& element, const char* what)
{
  if (attribute (element, what).empty ())
    return 0;
  const std::int64_t count = toInteger (TextScanner (attribute (element, what)).word ()); // it may be padded
  if (count < 0 || count > std::numeric_limits<std::uint32_t>::max ())
    throw IoError (std::string ("the VTK file has an impossible ") + what);
  return static_cast<std::uint64_t> (count);
}

int
typeOf (std::string_view word)
{
  static constexpr std::pair<const char*, int> names[] = {{"Int8", VTK_TYPE_INT8},       {"UInt8", VTK_TYPE_UINT8},
                                                          {"Int16", VTK_TYPE_INT16},     {"UInt16", VTK_TYPE_UINT16},
                                                          {"Int32", VTK_TYPE_INT32},     {"UInt32", VTK_TYPE_UINT32},
                                                          {"Int64", VTK_TYPE_INT64},     {"UInt64", VTK_TYPE_UINT64},
                                                          {"Float32", VTK_TYPE_FLOAT32}, {"Float64", VTK_TYPE_FLOAT64}};
  for (const auto& [known, type] : names)
    if (word == known)
      return type;
  throw IoError ("values of type " + quoted (word) + " in VTK files are not supported");
}

vtkSmartPointer<vtkDataCompressor>
compressorOf (std::string_view name)
{
  if (name == "vtkZLibDataCompressor")
    return vtkSmartPointer<vtkZLibDataCompressor>::New ();
  if (name == "vtkLZ4DataCompressor")
    return vtkSmartPointer<vtkLZ4DataCompressor>::New ();
  if (name == "vtkLZMADataCompressor")
    return vtkSmartPointer<vtkLZMADataCompressor>::New ();
  throw IoError ("the compressor " + quoted (name) + " of the VTK file is not known");
}

/** \brief What stands before binary data: its size, or those of its compressed blocks. */
struct DataHeader
{
  Encoding order;
  ScalarType type;
  bool compressed;

  /** \brief The size of the data that \a stored begins with. \throws IoError if what is stored cannot have it */
  std::uint64_t dataSize (std::string_view stored, bool base64) const
  {
    stored.remove_prefix (base64 ? std::min (stored.find_first_not_of (" \t\r\n"), stored.size ()) : 0);
    const std::uint64_t most = (base64 ? stored.size () / 4 * 3 : stored.size ());
    if (!compressed)
    {
      const std::uint64_t size = firstSizes (1, stored, base64)[0];
      if (size > most)
        throw IoError (cut_off);
      return size;
    }
    const auto layout = firstSizes (3, stored, base64); // number of blocks, size of each, of the last if it differs
    if (layout[0] > most || layout[2] > layout[1])
      throw IoError (cut_off);
    const auto sizes = firstSizes (3 + layout[0], stored, base64);
    std::uint64_t left = most;
    for (std::size_t n = 3; n < sizes.size (); left -= sizes[n++])
    {
      constexpr std::uint64_t best_ratio = 10000, slack = 1024; // of LZMA; zlib and LZ4 compress less
      if (sizes[n] > left || layout[1] == 0 || layout[1] > best_ratio * sizes[n] + slack)
        throw IoError (cut_off);
    }
    return layout[0] * layout[1];
  }

private:
  std::vector<std::uint64_t> firstSizes (std::uint64_t count, std::string_view stored, bool base64) const
  {
    std::string bytes (stored.substr (0, count * sizeOf (type) * (base64 ? 4 : 3) / 3 + 3));
    if (base64)
      bytes.resize (vtkBase64Utilities::DecodeSafely (reinterpret_cast<const unsigned char*> (bytes.data ()),
                                                      bytes.size () / 4 * 4,
                                                      reinterpret_cast<unsigned char*> (bytes.data ()), bytes.size ()));
    TextScanner scanner (bytes);
    ValueReader reader (scanner, order, "VTK");
    std::vector<std::uint64_t> sizes;
    for (std::uint64_t n = 0; n < count; ++n)
      sizes.push_back (static_cast<std::uint64_t> (reader.nextIndex (type))); // -1 is more than there can be
    return sizes;
  }
};

/** \brief Reads the arrays of a file. */
class ArrayReader
{
public:
  ArrayReader (std::string_view bytes, vtkXMLDataParser& parser)
      : bytes_ (bytes)
      , parser_ (parser)
      , header_ (
            {attribute (*parser.GetRootElement (), "byte_order") == "BigEndian" ? Encoding::BigEndian
                                                                                : Encoding::LittleEndian,
             attribute (*parser.GetRootElement (), "header_type") == "UInt64" ? ScalarType::UInt64 : ScalarType::UInt32,
             !attribute (*parser.GetRootElement (), "compressor").empty ()})
  {
    if (header_.compressed)
    {
      const auto compressor = compressorOf (attribute (*parser.GetRootElement (), "compressor"));
      errors_ = VtkErrors::observe (*compressor);
      parser.SetCompressor (compressor);
    }
    const auto begin = static_cast<std::size_t> (std::max<vtkTypeInt64> (0, parser.GetAppendedDataPosition ()));
    if (begin == 0 || begin > bytes.size ())
      return;
    appended_ = bytes.substr (begin, std::max (begin, bytes.rfind ("</AppendedData")) - begin);
    const auto element = parser.GetRootElement ()->FindNestedElementWithName ("AppendedData");
    base64_ = element == nullptr || attribute (*element, "encoding") != "raw";
  }

  /** \brief The first \a count values of an array. */
  vtkSmartPointer<vtkDataArray> read (vtkXMLDataElement& array, std::uint64_t count) const
  {
    const auto values = vtkSmartPointer<vtkDataArray>::Take (
        vtkDataArray::CreateDataArray (typeOf (attribute (array, "type"))));
    const std::string_view format = attribute (array, "format");
    const std::uint64_t offset = countOf (array, "offset");
    const std::string_view content = bytes_.substr (
        std::min (bytes_.find ('>', static_cast<std::size_t> (array.GetXMLByteIndex ())), bytes_.size () - 1) + 1);
    const std::string_view stored = content.substr (0, content.find ('<'));
    std::uint64_t most = stored.size () / 2 + 1; // a value and a space
    if (format == "appended")
      most = offset > appended_.size () ? 0 : header_.dataSize (appended_.substr (offset), base64_);
    else if (format == "binary")
      most = header_.dataSize (stored, true);
    else if (format != "ascii")
      throw IoError ("the format " + quoted (format) + " of an array of the VTK file is not known");
    const std::uint64_t word = (format == "ascii" ? 1 : static_cast<std::uint64_t> (values->GetDataTypeSize ()));
    if (count > most / word)
      throw IoError (cut_off);
    values->SetNumberOfValues (static_cast<vtkIdType> (count));
    void* const to = values->GetVoidPointer (0);
    const std::size_t taken = format == "appended" ? parser_.ReadAppendedData (static_cast<vtkTypeInt64> (offset), to,
                                                                               0, count, values->GetDataType ())
                                                   : parser_.ReadInlineData (&array, format == "ascii", to, 0, count,
                                                                             values->GetDataType ());
    if (taken != count || (errors_ != nullptr && errors_->failed ()))
      throw IoError (cut_off);
    return values;
  }

private:
  std::string_view bytes_, appended_;
  bool base64_ = true; ///< what is appended
  vtkXMLDataParser& parser_;
  DataHeader header_;
  vtkSmartPointer<VtkErrors> errors_;
};

/** \brief The \a count indices in the array of a \a name. */
std::vector<std::int64_t>
indices (const ArrayReader& reader, vtkXMLDataElement* section, const char* name, std::uint64_t count)
{
  if (count == 0)
    return {};
  vtkXMLDataElement* const array = section == nullptr
                                       ? nullptr
                                       : section->FindNestedElementWithNameAndAttribute ("DataArray", "Name", name);
  if (array == nullptr)
    throw IoError (std::string ("the VTK file has cells without their ") + name);
  const auto values = reader.read (*array, count);
  std::vector<std::int64_t> result;
  for (vtkIdType n = 0; n < values->GetNumberOfValues (); ++n)
  {
    constexpr double most = std::numeric_limits<std::uint32_t>::max ();
    const double value = values->GetTuple1 (n);
    result.push_back (value >= 0.0 && value <= most ? static_cast<std::int64_t> (value) : -1);
  }
  return result;
}

/** \brief Calls \a add with the indices of each cell; offsets are where each cell ends. */
template <typename Add>
void
forEachCell (const ArrayReader& reader, vtkXMLDataElement* section, std::uint64_t count, Add&& add)
{
  const auto ends = indices (reader, section, "offsets", count);
  std::int64_t begin = 0;
  for (const std::int64_t end : ends)
    if (end < std::exchange (begin, end))
      throw IoError ("the offsets of the VTK file's cells do not fit their connectivity");
  const auto corners = indices (reader, section, "connectivity", static_cast<std::uint64_t> (begin));
  begin = 0;
  for (const std::int64_t end : ends)
  {
    add (std::vector<std::int64_t> (corners.begin () + begin, corners.begin () + end));
    begin = end;
  }
}

void
addPiece (const ArrayReader& reader, vtkXMLDataElement& piece, PolygonSoup& soup)
{
  const auto first = static_cast<std::int64_t> (soup.points.size ());
  const auto count = static_cast<std::int64_t> (countOf (piece, "NumberOfPoints"));
  if (count > 0)
  {
    vtkXMLDataElement* const points = piece.FindNestedElementWithName ("Points");
    if (points == nullptr || points->GetNumberOfNestedElements () == 0)
      throw IoError ("the VTK file has points without their array");
    const auto values = reader.read (*points->GetNestedElement (0), static_cast<std::uint64_t> (3 * count));
    for (vtkIdType n = 0; n < 3 * count; n += 3)
      soup.points.emplace_back (values->GetTuple1 (n), values->GetTuple1 (n + 1), values->GetTuple1 (n + 2));
  }
  const auto shift = [&] (std::vector<std::int64_t> corners) {
    for (std::int64_t& corner : corners)
      corner = (corner >= 0 && corner < count ? first + corner : -1); // not of another piece
    return corners;
  };
  forEachCell (reader, piece.FindNestedElementWithName ("Polys"), countOf (piece, "NumberOfPolys"),
               [&] (const std::vector<std::int64_t>& cell) { soup.addPolygon (shift (cell)); });
  forEachCell (reader, piece.FindNestedElementWithName ("Strips"), countOf (piece, "NumberOfStrips"),
               [&] (const std::vector<std::int64_t>& cell) { soup.addStrip (shift (cell)); });
}

} // namespace

PolygonSoup
decodeVtp (const std::string& bytes)
{
  std::istringstream stream (bytes);
  vtkNew<ShallowParser> parser;
  const auto errors = VtkErrors::observe (*parser);
  parser->SetStream (&stream);
  const bool parsed = parser->Parse () != 0 && !parser->tooDeep ();
  vtkXMLDataElement* const file = parser->GetRootElement ();
  if (!parsed || errors->failed () || file == nullptr)
    throw IoError ("the VTK file is not proper XML, or cut short");
  vtkXMLDataElement* const data = file->FindNestedElementWithName ("PolyData");
  if (attribute (*file, "type") != "PolyData" || data == nullptr)
    throw IoError ("the VTK file does not hold PolyData");
  const ArrayReader reader (bytes, *parser);
  PolygonSoup soup;
  for (int n = 0; n < data->GetNumberOfNestedElements (); ++n)
    if (std::string_view (data->GetNestedElement (n)->GetName ()) == "Piece")
      addPiece (reader, *data->GetNestedElement (n), soup);
  return soup;
}

} // namespace pcl::cosection
