// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "polygon_soup.h"

#include "pcl_cosection/mesh/mesh_cleaning.h"
#include "pcl_cosection/mesh/mesh_orientation.h"

#include <pcl/cosection/common/error.h>

#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolygon.h>

#include <limits>
#include <string>

namespace pcl::cosection {
namespace {

void
check (const PolygonSoup& soup)
{
  if (soup.points.size () > std::numeric_limits<std::uint32_t>::max () ||
      soup.ends.size () > std::numeric_limits<std::uint32_t>::max ())
    throw IoError ("it has more vertices or faces than a 32-bit index can count");
  const auto count = static_cast<std::int64_t> (soup.points.size ());
  for (const std::int64_t corner : soup.corners)
  {
    if (corner < 0 || corner >= count)
      throw IoError ("a face refers to a vertex that does not exist");
    if (!soup.points[static_cast<std::size_t> (corner)].allFinite ())
      throw IoError ("vertex " + std::to_string (corner) + " (from 0) is not finite");
  }
}

/** \brief Divides polygons into triangles; polygons may be concave. */
class Triangulator
{
public:
  /** \brief Append the triangles of the polygon with the corners [begin, end) of \a soup. */
  void add (const PolygonSoup& soup, std::size_t begin, std::size_t end, std::vector<TriangleMesh::Triangle>& triangles)
  {
    const std::size_t size = end - begin;
    const auto corner = [&] (std::size_t n) { return static_cast<std::uint32_t> (soup.corners[begin + n]); };
    if (size == 3)
      triangles.push_back ({corner (0), corner (1), corner (2)});
    if (size <= 3)
      return;
    polygon_->GetPoints ()->SetNumberOfPoints (static_cast<vtkIdType> (size));
    polygon_->GetPointIds ()->SetNumberOfIds (static_cast<vtkIdType> (size));
    for (std::size_t n = 0; n < size; ++n)
    {
      const Eigen::Vector3d p = soup.points[corner (n)].cast<double> ();
      polygon_->GetPoints ()->SetPoint (static_cast<vtkIdType> (n), p.data ());
      polygon_->GetPointIds ()->SetId (static_cast<vtkIdType> (n), static_cast<vtkIdType> (n));
    }
    if (polygon_->Triangulate (found_) == 0 || found_->GetNumberOfIds () != static_cast<vtkIdType> (3 * (size - 2)))
    {
      for (std::size_t n = 2; n < size; ++n) // it crosses itself or has no area
        triangles.push_back ({corner (0), corner (n - 1), corner (n)});
      return;
    }
    for (vtkIdType n = 0; n < found_->GetNumberOfIds (); n += 3)
    {
      const auto at = [&] (vtkIdType m) { return corner (static_cast<std::size_t> (found_->GetId (n + m))); };
      triangles.push_back ({at (0), at (1), at (2)});
    }
  }

private:
  vtkNew<vtkPolygon> polygon_;
  vtkNew<vtkIdList> found_;
};

} // namespace

void
PolygonSoup::addStrip (const std::vector<std::int64_t>& strip)
{
  for (std::size_t n = 2; n < strip.size (); ++n)
  {
    const bool turned = n % 2 != 0;
    for (const std::size_t m : {n - 2, turned ? n : n - 1, turned ? n - 1 : n})
      corners.push_back (strip[m]);
    endPolygon ();
  }
}

TriangleMesh
makeMesh (const PolygonSoup& soup)
{
  check (soup);
  TriangleMesh mesh;
  mesh.vertices = soup.points;
  mesh.triangles.reserve (soup.ends.size ());
  Triangulator triangulator;
  for (std::size_t n = 0; n < soup.ends.size (); ++n)
    triangulator.add (soup, n == 0 ? 0 : soup.ends[n - 1], soup.ends[n], mesh.triangles);
  if (mesh.empty ())
    throw IoError ("it has no triangles");
  mesh = cleanMesh (mesh);
  if (mesh.empty ())
    throw IoError ("all its triangles are without area");
  orientTriangles (mesh);
  return mesh;
}

} // namespace pcl::cosection
