// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/triangle_mesh.h>

#include <string>
#include <vector>

namespace pcl::cosection::test {

/** \brief Polygons and strips for VTK to write. */
struct Polygons
{
  std::vector<Eigen::Vector3f> points;
  std::vector<std::vector<int>> polygons;
  std::vector<std::vector<int>> strips;
};

enum class VtkFile
{
  PlyAscii,
  PlyLittleEndian,
  PlyBigEndian,
  StlAscii,
  StlBinary,
  Obj,
  LegacyAscii,
  LegacyBinary,
  OldLegacyAscii, ///< before VTK 9
  OldLegacyBinary,
  XmlAscii,
  XmlBinary,
  XmlAppended,
  XmlRaw, ///< appended, neither compressed nor in base 64
};

/** \brief All kinds of VtkFile. */
std::vector<VtkFile> vtkFiles ();

/** \brief The file name extension, such as ".ply". */
std::string extensionOf (VtkFile file);

/** \brief An OFF file, which VTK does not write. */
std::string tetrahedronOff ();

/** \brief Let VTK write a file. */
void writeWithVtk (const Polygons& polygons, VtkFile file, const std::string& path);

} // namespace pcl::cosection::test
