// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "picture.h"

#include "pcl_cosection/common/files.h"
#include "pcl_cosection/io/mesh/vtk_errors.h"

#include <pcl/cosection/common/error.h>

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>

namespace pcl::cosection {
namespace {

constexpr double ambient_light = 0.25; ///< the rest comes from the head light

void
checkPicture (const Picture& picture)
{
  if (picture.width < 1 || picture.height < 1 ||
      picture.pixels.size () != static_cast<std::size_t> (picture.width) * picture.height)
    throw InvalidArgument ("picture: there must be width * height pixels");
}

} // namespace

Picture
shade (const RasterImage& image, const PinholeCamera& camera, const std::array<std::uint8_t, 3>& background)
{
  if (image.width != camera.width || image.height != camera.height)
    throw InvalidArgument ("shade: the image was not taken by this camera");
  Picture picture (image.width, image.height, background);
  for (int v = 0; v < image.height; ++v)
    for (int u = 0; u < image.width; ++u)
    {
      const std::size_t pixel = static_cast<std::size_t> (v) * image.width + u;
      if (!std::isfinite (image.depth[pixel]))
        continue;
      const Eigen::Vector3d to_camera = -camera.unproject (u, v, 1.0).normalized ();
      const double cosine = std::max (0.0, to_camera.dot (image.normals[pixel].cast<double> ()));
      const double light = ambient_light + (1.0 - ambient_light) * cosine;
      for (int channel = 0; channel < 3; ++channel)
        picture.pixels[pixel][channel] = static_cast<std::uint8_t> (
            std::lround (std::min (1.0, light) * image.colours[pixel][channel]));
    }
  return picture;
}

PinholeCamera
fittingCamera (const std::vector<const TriangleMesh*>& meshes, const Eigen::Isometry3d& T_world_camera, int size_px,
               double filled)
{
  const Eigen::Isometry3d T_camera_world = T_world_camera.inverse ();
  Eigen::AlignedBox2d box;
  for (const TriangleMesh* mesh : meshes)
    for (const Eigen::Vector3f& vertex : mesh->vertices)
      box.extend ((T_camera_world * vertex.cast<double> ()).hnormalized ());
  const double focal_length = filled * size_px / std::max (box.sizes ().maxCoeff (), 1e-9);
  const Eigen::Vector2d middle = Eigen::Vector2d::Constant (0.5 * (size_px - 1)) - focal_length * box.center ();
  return {size_px, size_px, focal_length, focal_length, middle.x (), middle.y ()};
}

std::vector<std::array<std::uint8_t, 3>>
provenanceColours (const TriangleMesh& mesh)
{
  static constexpr std::array<std::array<std::uint8_t, 3>, 4> colours = {{
      {190, 190, 190}, // Observed
      {240, 150, 50},  // Inferred
      {80, 130, 220},  // Hull
      {90, 180, 90},   // Intersection
  }};
  std::vector<std::array<std::uint8_t, 3>> result (mesh.vertices.size (), colours[0]);
  if (!mesh.provenance.empty () && mesh.provenance.size () != mesh.vertices.size ())
    throw InvalidArgument ("provenanceColours: there must be one value per vertex");
  for (std::size_t v = 0; v < mesh.provenance.size (); ++v)
    if (mesh.provenance[v] < colours.size ())
      result[v] = colours[mesh.provenance[v]];
  return result;
}

Picture
beside (const std::vector<Picture>& pictures, int gap_px)
{
  if (pictures.empty ())
    return {};
  if (gap_px < 0)
    throw InvalidArgument ("beside: the gap must not be negative");
  int width = gap_px * (static_cast<int> (pictures.size ()) - 1);
  for (const Picture& picture : pictures)
  {
    checkPicture (picture);
    if (picture.height != pictures[0].height)
      throw InvalidArgument ("beside: the pictures must have equal height");
    width += picture.width;
  }
  Picture result (width, pictures[0].height, {255, 255, 255});
  int left = 0;
  for (const Picture& picture : pictures)
  {
    for (int v = 0; v < picture.height; ++v)
      std::copy_n (&picture.at (0, v), picture.width, &result.at (left, v));
    left += picture.width + gap_px;
  }
  return result;
}

void
writePng (const Picture& picture, const std::string& path)
{
  checkPicture (picture);
  vtkNew<vtkImageData> image;
  image->SetDimensions (picture.width, picture.height, 1);
  image->AllocateScalars (VTK_UNSIGNED_CHAR, 3);
  auto* out = static_cast<std::uint8_t*> (image->GetScalarPointer ());
  for (int v = picture.height - 1; v >= 0; --v) // VTK's first row is the lowest
    for (int u = 0; u < picture.width; ++u)
      out = std::copy_n (picture.at (u, v).begin (), 3, out);

  writeAtomically (path, [&] (const std::string& temporary) {
    vtkNew<vtkPNGWriter> writer;
    const auto errors = VtkErrors::observe (*writer);
    writer->SetInputData (image);
    writer->WriteToMemoryOn ();
    writer->Write ();
    vtkUnsignedCharArray* encoded = writer->GetResult ();
    if (errors->failed () || encoded == nullptr)
      throw IoError ("cannot write '" + path + "': VTK could not encode the picture");
    writeBytes (temporary, std::string (reinterpret_cast<const char*> (encoded->GetPointer (0)),
                                        static_cast<std::size_t> (encoded->GetNumberOfValues ())));
  });
}

} // namespace pcl::cosection
