// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/visualization/scene_colours.h"

#include <vtkLegendBoxActor.h>
#include <vtkRenderer.h>
#include <vtkScalarBarActor.h>
#include <vtkSmartPointer.h>
#include <vtkTextActor.h>

#include <string>

namespace pcl::cosection {

/** \brief What is written over the scene: caption, what colours mean, the keys. */
class WindowOverlay
{
public:
  explicit WindowOverlay (vtkRenderer& renderer);

  /** \brief What is shown; empty: nothing. */
  void setCaption (const std::string& text);

  /** \brief A line about what a key has done; empty: nothing. */
  void setMessage (const std::string& text);

  void setLegend (const ColourLegend& legend);

  void showHelp (bool shown);

private:
  vtkSmartPointer<vtkTextActor> caption_, message_, help_;
  vtkSmartPointer<vtkScalarBarActor> scale_;
  vtkSmartPointer<vtkLegendBoxActor> entries_;
};

} // namespace pcl::cosection
