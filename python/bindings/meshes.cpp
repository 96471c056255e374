// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "arrays.h"
#include "bindings.h"
#include "mesh_arrays.h"

#include <pcl/cosection/io/mesh_io.h>
#include <pcl/cosection/volume/signed_distance_field.h>

#include <pybind11/stl.h>

#include <cstring>
#include <utility>

namespace py = pybind11;
using namespace pcl::cosection;

TriangleMesh
toMesh (const DenseArray<float>& vertices, const DenseArray<std::uint32_t>& faces)
{
  TriangleMesh mesh;
  mesh.vertices.resize (static_cast<std::size_t> (vertices.shape (0)));
  mesh.triangles.resize (static_cast<std::size_t> (faces.shape (0)));
  std::memcpy (static_cast<void*> (mesh.vertices.data ()), vertices.data (),
               mesh.vertices.size () * sizeof (Eigen::Vector3f));
  std::memcpy (mesh.triangles.data (), faces.data (), mesh.triangles.size () * sizeof (TriangleMesh::Triangle));
  return mesh;
}

namespace {

using SharedMesh = std::shared_ptr<TriangleMesh>;

template <typename Scalar, typename Element>
auto
rowsProperty (std::vector<Element> TriangleMesh::*member)
{
  return [member] (const py::object& self) { return rowsOf<Scalar> (self.cast<const TriangleMesh&> ().*member, self); };
}

py::array
allRows (const py::object& self)
{
  const auto& mesh = self.cast<const TriangleMesh&> ();
  return viewOf<float> (mesh.vertices, {static_cast<py::ssize_t> (mesh.vertices.size ()), 3}, self);
}

py::array
allFaces (const py::object& self)
{
  const auto& mesh = self.cast<const TriangleMesh&> ();
  return viewOf<std::uint32_t> (mesh.triangles, {static_cast<py::ssize_t> (mesh.triangles.size ()), 3}, self);
}

void
bindMesh (py::module_& module)
{
  py::class_<TriangleMesh, SharedMesh> (module, "MeshData")
      .def (py::init ([] (const DenseArray<float>& vertices, const DenseArray<std::uint32_t>& faces) {
              return std::make_shared<TriangleMesh> (toMesh (vertices, faces));
            }),
            py::arg ("vertices"), py::arg ("faces"))
      .def_property_readonly ("vertices", allRows)
      .def_property_readonly ("faces", allFaces)
      .def_property_readonly ("normals", rowsProperty<float> (&TriangleMesh::normals))
      .def_property_readonly ("colours", rowsProperty<std::uint8_t> (&TriangleMesh::colours))
      .def_property_readonly ("intensity", rowsProperty<float> (&TriangleMesh::intensity))
      .def_property_readonly ("confidence", rowsProperty<float> (&TriangleMesh::confidence))
      .def_property_readonly ("sigma_m", rowsProperty<float> (&TriangleMesh::sigma_m))
      .def_property_readonly ("provenance", rowsProperty<std::uint8_t> (&TriangleMesh::provenance))
      .def_property_readonly ("is_closed",
                              [] (const TriangleMesh& mesh) { return computeTopology (mesh).closed_manifold; })
      .def ("mass_properties",
            [] (const TriangleMesh& mesh) {
              const MassProperties mass = computeMassProperties (mesh);
              return py::make_tuple (mass.volume_m3, toArray (mass.centroid_m), toArray (mass.inertia));
            })
      .def (
          "save",
          [] (const TriangleMesh& mesh, const std::string& path, const std::array<double, 3>& origin) {
            const py::gil_scoped_release unlocked;
            saveMesh (mesh, path, Eigen::Vector3d (origin[0], origin[1], origin[2]));
          },
          py::arg ("path"), py::arg ("origin"));
  module.def (
      "load_mesh",
      [] (const std::string& path) {
        const py::gil_scoped_release unlocked;
        return std::make_shared<TriangleMesh> (loadMesh (path));
      },
      py::arg ("path"));
}

void
bindField (py::module_& module)
{
  const auto shape = [] (const SignedDistanceField& field) {
    const Eigen::Vector3i& dims = field.grid.dims;
    return std::vector<py::ssize_t>{dims.z (), dims.y (), dims.x ()};
  };
  py::class_<SignedDistanceField, SignedDistanceField::Ptr> (module, "FieldData")
      .def_property_readonly ("values",
                              [shape] (const py::object& self) {
                                const auto& field = self.cast<const SignedDistanceField&> ();
                                return viewOf<float> (field.values, shape (field), self);
                              })
      .def_property_readonly ("supported",
                              [shape] (const py::object& self) -> py::object {
                                const auto& field = self.cast<const SignedDistanceField&> ();
                                if (field.supported.empty ())
                                  return py::none ();
                                return viewOf<std::uint8_t> (field.supported, shape (field), self);
                              })
      .def_property_readonly ("voxel_size_m", [] (const SignedDistanceField& field) { return field.grid.voxel_size_m; })
      .def_property_readonly ("origin_m",
                              [] (const SignedDistanceField& field) { return toArray (field.grid.origin_m); })
      .def (
          "sample",
          [] (const SignedDistanceField& field, const DenseArray<double>& points) {
            py::array_t<float> distances (points.shape (0));
            for (py::ssize_t n = 0; n < points.shape (0); ++n)
              distances.mutable_at (n) = field.sample ({points.at (n, 0), points.at (n, 1), points.at (n, 2)})
                                             .value_or (std::numeric_limits<float>::quiet_NaN ());
            return distances;
          },
          py::arg ("points"));
}

} // namespace

void
bindMeshes (py::module_& module)
{
  bindMesh (module);
  bindField (module);
}
