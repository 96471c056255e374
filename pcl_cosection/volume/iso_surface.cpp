// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
// Written by hand, because pcl::MarchingCubes gives every triangle its own three vertices, and neither it nor VTK's
// marching cubes promise a manifold.

#include "marching_cubes_cases.h"

#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/mesh/triangle_shape.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/volume/iso_surface.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl::cosection {
namespace {

using marching_cubes::Case;
using marching_cubes::caseTable;
using marching_cubes::edgeBegin;

/** \brief Vertices stay this far, in voxels, from the grid points. */
constexpr double min_edge_parameter = 1e-3;

constexpr std::uint32_t no_vertex = std::numeric_limits<std::uint32_t>::max ();

/** \brief Vertices on the edges that begin in one slice of grid points: for each point, those along
 * x, y and z. */
class SliceVertices
{
public:
  explicit SliceVertices (const Eigen::Vector3i& dims)
      : row_ (3 * static_cast<std::size_t> (dims.x ()))
      , ids_ (row_ * dims.y (), no_vertex)
  {}

  std::uint32_t& at (int i, int j, int axis) { return ids_[row_ * j + 3 * i + axis]; }

private:
  std::size_t row_;
  std::vector<std::uint32_t> ids_;
};

class Extractor
{
public:
  /** \param[in] supported one per voxel; nullptr: everywhere */
  Extractor (const SignedDistanceField& field, const IsoSurfaceOptions& options,
             const std::uint8_t* supported = nullptr)
      : field_ (field)
      , supported_ (supported)
      , grid_ (field.grid)
      , dims_ (field.grid.dims)
      , options_ (options)
      , inside_ (grid_.size ())
      , row_state_ (static_cast<std::size_t> (dims_.y ()) * dims_.z ())
  {}

  TriangleMesh run ()
  {
    const int slices = dims_.z ();
    parallelFor (0, slices, options_.threads, [this] (int k) { classifySlice (k); });
    // begin of each slice's vertices and triangles in the output
    vertex_begin_.assign (slices + 1, 0);
    triangle_begin_.assign (slices + 1, 0);
    parallelFor (0, slices, options_.threads, [this] (int k) { countSlice (k); });
    for (int k = 0; k < slices; ++k)
    {
      vertex_begin_[k + 1] += vertex_begin_[k];
      triangle_begin_[k + 1] += triangle_begin_[k];
    }
    if (vertex_begin_[slices] >= no_vertex)
      throw InvalidArgument ("the surface has more vertices than a 32-bit index can count");

    mesh_.vertices.resize (vertex_begin_[slices]);
    mesh_.normals.resize (vertex_begin_[slices]);
    mesh_.triangles.resize (triangle_begin_[slices]);
    parallelChunks (0, slices, options_.threads, [this] (int first, int last) { emitSlices (first, last); });
    repairNormals ();
    return std::move (mesh_);
  }

private:
  enum RowState : std::uint8_t
  {
    all_outside = 0,
    all_inside = 1,
    mixed = 2,
  };

  bool isBorder (int i, int j, int k) const
  {
    return i == 0 || j == 0 || k == 0 || i == dims_.x () - 1 || j == dims_.y () - 1 || k == dims_.z () - 1;
  }

  void classifySlice (int k)
  {
    const float lowest = std::numeric_limits<float>::lowest ();
    for (int j = 0; j < dims_.y (); ++j)
    {
      const std::size_t begin = grid_.index (0, j, k);
      const float* values = &field_.values[begin];
      std::uint8_t* inside = &inside_[begin];
      const bool border_row = options_.closed && (j == 0 || k == 0 || j == dims_.y () - 1 || k == dims_.z () - 1);
      int count = 0;
      if (!border_row)
      {
        for (int i = 0; i < dims_.x (); ++i)
          inside[i] = static_cast<std::uint8_t> (values[i] < 0.0f && values[i] >= lowest);
        if (options_.closed)
          inside[0] = inside[dims_.x () - 1] = 0;
        for (int i = 0; i < dims_.x (); ++i)
          count += inside[i];
      }
      row_state_[static_cast<std::size_t> (k) * dims_.y () + j] = (count == 0            ? all_outside
                                                                   : count == dims_.x () ? all_inside
                                                                                         : mixed);
    }
  }

  RowState rowState (int j, int k) const
  {
    return static_cast<RowState> (row_state_[static_cast<std::size_t> (k) * dims_.y () + j]);
  }

  /** \brief Are these two rows of grid points all outside or all inside? */
  bool uniform (RowState a, RowState b) const { return a == b && a != mixed; }

  /** \brief Call visit (i, j, axis) for each cut edge that begins in slice \a k, in a fixed order. */
  template <typename Visit> void forEachCutEdge (int k, Visit&& visit) const
  {
    const std::size_t step_y = dims_.x ();
    const std::size_t step_z = step_y * dims_.y ();
    for (int j = 0; j < dims_.y (); ++j)
    {
      const bool has_y = j + 1 < dims_.y ();
      const bool has_z = k + 1 < dims_.z ();
      const RowState state = rowState (j, k);
      const bool cut_x = state == mixed;
      const bool cut_y = has_y && !uniform (state, rowState (j + 1, k));
      const bool cut_z = has_z && !uniform (state, rowState (j, k + 1));
      if (!cut_x && !cut_y && !cut_z)
        continue;
      const std::uint8_t* row = &inside_[grid_.index (0, j, k)];
      const std::uint8_t* next_y = cut_y ? row + step_y : row;
      const std::uint8_t* next_z = cut_z ? row + step_z : row;
      for (int i = 0; i < dims_.x (); ++i)
      {
        if (i + 1 < dims_.x () && row[i] != row[i + 1])
          visit (i, j, 0);
        if (row[i] != next_y[i])
          visit (i, j, 1);
        if (row[i] != next_z[i])
          visit (i, j, 2);
      }
    }
  }

  /** \brief Call visit (i, j, case) for each cell between slices \a k and k + 1 that has triangles. */
  template <typename Visit> void forEachCutCell (int k, Visit&& visit) const
  {
    if (k + 1 >= dims_.z ())
      return;
    const auto& table = caseTable ();
    for (int j = 0; j + 1 < dims_.y (); ++j)
    {
      const RowState state = rowState (j, k);
      if (uniform (state, rowState (j + 1, k)) && uniform (state, rowState (j, k + 1)) &&
          uniform (state, rowState (j + 1, k + 1)))
        continue;
      const std::uint8_t* row00 = &inside_[grid_.index (0, j, k)];
      const std::uint8_t* row10 = row00 + dims_.x ();
      const std::uint8_t* row01 = &inside_[grid_.index (0, j, k + 1)];
      const std::uint8_t* row11 = row01 + dims_.x ();
      // bits 0, 2, 4, 6: the four corners at the cell's lower x
      const auto column = [&] (int i) {
        return static_cast<unsigned> (row00[i] | (row10[i] << 2) | (row01[i] << 4) | (row11[i] << 6));
      };
      unsigned lower = column (0);
      for (int i = 0; i + 1 < dims_.x (); ++i)
      {
        const unsigned upper = column (i + 1);
        const unsigned code = lower | (upper << 1);
        lower = upper;
        if (code != 0 && code != 255 && isSupported (i, j, k))
          visit (i, j, table[code]);
      }
    }
  }

  /** \brief Are all corners of this cell? */
  bool isSupported (int i, int j, int k) const
  {
    if (!supported_)
      return true;
    for (int corner = 0; corner < 8; ++corner)
      if (supported_[grid_.index (i + (corner & 1), j + ((corner >> 1) & 1), k + (corner >> 2))] == 0)
        return false;
    return true;
  }

  void countSlice (int k)
  {
    std::size_t vertices = 0;
    std::size_t triangles = 0;
    forEachCutEdge (k, [&] (int, int, int) { ++vertices; });
    forEachCutCell (k, [&] (int, int, const Case& c) { triangles += c.triangle_count; });
    vertex_begin_[k + 1] = vertices;
    triangle_begin_[k + 1] = triangles;
  }

  void emitSlices (int first, int last)
  {
    SliceVertices here (dims_);
    SliceVertices above (dims_);
    numberVertices (first, above);
    for (int k = first; k < last; ++k)
    {
      std::swap (here, above);
      if (k + 1 < dims_.z ())
        numberVertices (k + 1, above);
      std::uint32_t id = static_cast<std::uint32_t> (vertex_begin_[k]);
      forEachCutEdge (k, [&] (int i, int j, int axis) { emitVertex (i, j, k, axis, id++); });
      std::size_t triangle = triangle_begin_[k];
      forEachCutCell (k, [&] (int i, int j, const Case& c) {
        for (int t = 0; t < c.triangle_count; ++t)
        {
          auto& out = mesh_.triangles[triangle++];
          for (int n = 0; n < 3; ++n)
          {
            const int edge = c.triangles[t][n];
            const int corner = edgeBegin (edge);
            SliceVertices& slice = (corner & 4) ? above : here;
            out[n] = slice.at (i + (corner & 1), j + ((corner >> 1) & 1), edge / 4);
          }
        }
      });
    }
  }

  /** \brief Entries of edges that are not cut keep whatever they were: no triangle refers to them. */
  void numberVertices (int k, SliceVertices& slice) const
  {
    std::uint32_t id = static_cast<std::uint32_t> (vertex_begin_[k]);
    forEachCutEdge (k, [&] (int i, int j, int axis) { slice.at (i, j, axis) = id++; });
  }

  /** \brief Gradient at a grid point in values per voxel; one-sided at the border of the grid. */
  Eigen::Vector3d gradient (const Eigen::Vector3i& p) const
  {
    Eigen::Vector3d g;
    for (int axis = 0; axis < 3; ++axis)
    {
      Eigen::Vector3i lower = p;
      Eigen::Vector3i upper = p;
      lower[axis] = std::max (p[axis] - 1, 0);
      upper[axis] = std::min (p[axis] + 1, dims_[axis] - 1);
      g[axis] = (static_cast<double> (value (upper)) - value (lower)) / (upper[axis] - lower[axis]);
    }
    return g;
  }

  float value (const Eigen::Vector3i& p) const { return field_.values[grid_.index (p.x (), p.y (), p.z ())]; }

  void emitVertex (int i, int j, int k, int axis, std::uint32_t id)
  {
    const Eigen::Vector3i begin (i, j, k);
    const Eigen::Vector3i end = begin + Eigen::Vector3i::Unit (axis);
    const double a = value (begin);
    const double b = value (end);
    // Where one end is outside only because it is the border or not finite, its value says nothing.
    const bool measured = std::isfinite (a) && std::isfinite (b) && (a < 0.0) != (b < 0.0);
    const double t = std::clamp (measured ? a / (a - b) : 0.5, min_edge_parameter, 1.0 - min_edge_parameter);
    Eigen::Vector3d position = begin.cast<double> ();
    position[axis] += t;
    mesh_.vertices[id] = (grid_.origin_m + grid_.voxel_size_m * position).cast<float> ();

    Eigen::Vector3d normal = Eigen::Vector3d::Zero (); // zero: to be repaired
    if (measured)
    {
      const Eigen::Vector3d g = (1.0 - t) * gradient (begin) + t * gradient (end);
      const double norm = g.norm ();
      const bool outward = (b > a ? g[axis] >= 0.0 : g[axis] <= 0.0);
      if (std::isfinite (norm) && norm > 0.0 && outward)
        normal = g / norm;
    }
    mesh_.normals[id] = normal.cast<float> ();
  }

  /** \brief Where the gradient gave no outward normal: the area-weighted mean of the triangles'. */
  void repairNormals ()
  {
    std::vector<bool> missing (mesh_.normals.size (), false);
    bool any = false;
    for (std::size_t v = 0; v < missing.size (); ++v)
      if (mesh_.normals[v].isZero (0.0f))
        missing[v] = any = true;
    if (!any)
      return;
    std::vector<Eigen::Vector3d> sums (mesh_.normals.size (), Eigen::Vector3d::Zero ());
    for (const auto& triangle : mesh_.triangles)
    {
      if (!missing[triangle[0]] && !missing[triangle[1]] && !missing[triangle[2]])
        continue;
      const auto corner = [&] (int n) { return mesh_.vertices[triangle[n]].cast<double> (); };
      const Eigen::Vector3d area = areaVector (corner (0), corner (1), corner (2));
      for (const auto v : triangle)
        sums[v] += area;
    }
    for (std::size_t v = 0; v < missing.size (); ++v)
      if (missing[v])
        mesh_.normals[v] = (sums[v].norm () > 0.0 ? sums[v].normalized () : Eigen::Vector3d (0, 0, 1)).cast<float> ();
  }

  const SignedDistanceField& field_;
  const std::uint8_t* supported_;
  const VoxelGrid& grid_;
  const Eigen::Vector3i dims_;
  const IsoSurfaceOptions options_;
  std::vector<std::uint8_t> inside_;
  std::vector<std::uint8_t> row_state_; // of the rows along x
  std::vector<std::size_t> vertex_begin_;
  std::vector<std::size_t> triangle_begin_;
  TriangleMesh mesh_;
};

void
checkField (const SignedDistanceField& field)
{
  if (field.grid.dims.minCoeff () < 1 || field.values.size () != field.grid.size ())
    throw InvalidArgument ("iso surface: the field must have one value per voxel");
  if (!(field.grid.voxel_size_m > 0.0))
    throw InvalidArgument ("iso surface: the voxel size must be positive");
}

} // namespace

TriangleMesh
extractIsoSurface (const SignedDistanceField& field, const IsoSurfaceOptions& options)
{
  checkField (field);
  return Extractor (field, options).run ();
}

TriangleMesh
extractOpenIsoSurface (const SignedDistanceField& field, const std::vector<std::uint8_t>& supported, int threads)
{
  checkField (field);
  if (supported.size () != field.grid.size ())
    throw InvalidArgument ("iso surface: there must be one mark of support per voxel");
  IsoSurfaceOptions options;
  options.closed = false;
  options.threads = threads;
  const TriangleMesh mesh = Extractor (field, options, supported.data ()).run ();
  return extractTriangles (mesh, std::vector<bool> (mesh.triangles.size (), true));
}

} // namespace pcl::cosection
