// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/visualization/sdf_slices.h"
#include <pcl/cosection/visualization/run_scene.h>
#include <pcl/cosection/visualization/scene_picture.h>

#include <vtkActor.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include <array>
#include <map>
#include <memory>
#include <optional>

namespace pcl::cosection {

/** \brief Cuts through the signed distance of an object. */
struct SliceChoice
{
  bool shown = false;
  int object = 0;                                 ///< id
  std::array<bool, 3> axes = {true, true, true};  ///< planes across x, y, z
  std::array<double, 3> shares = {0.5, 0.5, 0.5}; ///< where they are
};

/** \brief The surfaces, points and lines of a run in a VTK renderer. */
class WindowScene
{
public:
  explicit WindowScene (vtkRenderer& renderer) : renderer_ (renderer) {}

  /** \brief Show other surfaces from now on. */
  void setScene (const RunScene& scene);

  /** \brief Show a frame. \param[in] points of it, for SurfaceMode::Points; may be null */
  void update (double stamp, const SceneView& view, const SliceChoice& slices,
               const std::shared_ptr<const FramePoints>& points, int threads);

private:
  struct Surface
  {
    vtkSmartPointer<vtkActor> actor;
    ColourMode colour = ColourMode::Real;
  };
  using Key = std::pair<int, SurfaceMode>; // object and mode

  /** \brief The actor of a surface, made when it is asked for; null: there is no such mesh. */
  vtkActor* surface (int id, SurfaceMode mode, ColourMode colour);
  /** \brief Show data with an actor, which is made when it is first needed. */
  void show (vtkPolyData* data, vtkSmartPointer<vtkActor>& actor);
  void showPoints (const std::shared_ptr<const FramePoints>& points);
  void showSlices (double stamp, const SliceChoice& slices, int threads);

  vtkRenderer& renderer_;
  const RunScene* scene_ = nullptr;
  std::map<Key, Surface> surfaces_;
  vtkSmartPointer<vtkActor> lines_, points_;
  std::shared_ptr<const FramePoints> shown_points_;
  std::array<vtkSmartPointer<vtkActor>, 3> slice_actors_;
  std::optional<SdfSlices> sdf_;
  int sdf_object_ = 0;
  SliceChoice drawn_slices_;
};

} // namespace pcl::cosection
