// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/visualization/scene_lines.h"

#include "pcl_cosection/visualization/sdf_slices.h"
#include <pcl/cosection/common/image.h>
#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/visualization/scene_picture.h>

#include <vtkActor.h>
#include <vtkImageData.h>
#include <vtkMatrix4x4.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>

#include <Eigen/Geometry>

#include <vector>

namespace pcl::cosection {

/** \brief Triangles and normals, without colours. */
vtkSmartPointer<vtkPolyData> toPolyData (const TriangleMesh& mesh);

/** \brief One per point. */
vtkSmartPointer<vtkUnsignedCharArray> toColours (const std::vector<TriangleMesh::Colour>& colours);

vtkSmartPointer<vtkPolyData> toPolyData (const std::vector<SceneLine>& lines);

vtkSmartPointer<vtkPolyData> toPolyData (const FramePoints& points);

vtkSmartPointer<vtkMatrix4x4> toMatrix (const Eigen::Isometry3d& pose);

/** \brief An actor that shows the colours of its points as they are. */
vtkSmartPointer<vtkActor> makeActor (vtkPolyData* data);

/** \brief A picture in space, unlit. */
vtkSmartPointer<vtkActor> makeActor (const SdfSlice& slice);

} // namespace pcl::cosection
