// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/visualization/scene_legend.h"

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
  /** \param[in] help what showHelp () shows */
  WindowOverlay (vtkRenderer& renderer, const std::string& help);

  /** \brief What is shown; empty: nothing. */
  void setCaption (const std::string& text) { setText (*caption_, text); }

  /** \brief A line about what a key has done; empty: nothing. */
  void setMessage (const std::string& text) { setText (*message_, text); }

  void setLegend (const ColourLegend& legend);

  void showHelp (bool shown) { help_->SetVisibility (shown); }

private:
  static void setText (vtkTextActor& actor, const std::string& text);

  vtkSmartPointer<vtkTextActor> caption_, message_, help_;
  vtkSmartPointer<vtkScalarBarActor> scale_;
  vtkSmartPointer<vtkLegendBoxActor> entries_;
};

} // namespace pcl::cosection
