// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "window_overlay.h"

#include "pcl_cosection/evaluation/pictures/error_picture.h"

#include <vtkCoordinate.h>
#include <vtkLookupTable.h>
#include <vtkNew.h>
#include <vtkPlaneSource.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkProperty2D.h>
#include <vtkTextProperty.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace pcl::cosection {
namespace {

constexpr std::array<double, 3> ink = {0.15, 0.15, 0.15};
constexpr std::array<double, 3> paper = {1.0, 1.0, 1.0};
constexpr double veil = 0.8;
constexpr int text_px = 16;
constexpr int scale_colours = 256;

vtkSmartPointer<vtkTextActor>
makeText (vtkRenderer& renderer, double x, double y, bool below)
{
  auto text = vtkSmartPointer<vtkTextActor>::New ();
  vtkTextProperty* property = text->GetTextProperty ();
  property->SetFontSize (text_px);
  property->SetColor (ink[0], ink[1], ink[2]);
  property->SetBackgroundColor (paper[0], paper[1], paper[2]);
  property->SetBackgroundOpacity (veil);
  if (below)
    property->SetVerticalJustificationToTop ();
  text->GetPositionCoordinate ()->SetCoordinateSystemToNormalizedViewport ();
  text->GetPositionCoordinate ()->SetValue (x, y);
  text->VisibilityOff ();
  renderer.AddViewProp (text);
  return text;
}

} // namespace

WindowOverlay::WindowOverlay (vtkRenderer& renderer, const std::string& help)
    : caption_ (makeText (renderer, 0.012, 0.1, false))
    , message_ (makeText (renderer, 0.012, 0.15, false))
    , help_ (makeText (renderer, 0.012, 0.98, true))
    , scale_ (vtkSmartPointer<vtkScalarBarActor>::New ())
    , entries_ (vtkSmartPointer<vtkLegendBoxActor>::New ())
{
  help_->GetTextProperty ()->SetFontFamilyToCourier ();
  help_->GetTextProperty ()->SetFontSize (text_px - 1);
  help_->SetInput (help.c_str ());

  scale_->SetPosition (0.9, 0.3);
  scale_->SetWidth (0.08);
  scale_->SetHeight (0.42);
  scale_->SetNumberOfLabels (5);
  scale_->SetLabelFormat ("%.3g");
  scale_->UnconstrainedFontSizeOn ();
  for (vtkTextProperty* property :
       {scale_->GetTitleTextProperty (), scale_->GetLabelTextProperty (), entries_->GetEntryTextProperty ()})
  {
    property->SetColor (ink[0], ink[1], ink[2]);
    property->BoldOff ();
    property->ItalicOff ();
    property->ShadowOff ();
  }
  scale_->GetTitleTextProperty ()->SetFontSize (text_px);
  scale_->GetLabelTextProperty ()->SetFontSize (text_px);
  scale_->DrawBackgroundOn ();
  scale_->GetBackgroundProperty ()->SetColor (paper[0], paper[1], paper[2]);
  scale_->GetBackgroundProperty ()->SetOpacity (veil);
  scale_->VisibilityOff ();
  renderer.AddViewProp (scale_);

  entries_->UseBackgroundOn ();
  const std::array<double, 4> behind = {paper[0], paper[1], paper[2], veil};
  entries_->SetBackgroundColor (behind.data ());
  entries_->SetBackgroundOpacity (veil);
  entries_->BorderOff ();
  entries_->ScalarVisibilityOn ();
  entries_->SetPadding (4);
  entries_->VisibilityOff ();
  renderer.AddViewProp (entries_);
}

void
WindowOverlay::setText (vtkTextActor& actor, const std::string& text)
{
  actor.SetInput (text.empty () ? " " : (" " + text + " ").c_str ());
  actor.SetVisibility (!text.empty ());
}

void
WindowOverlay::setLegend (const ColourLegend& legend)
{
  scale_->SetVisibility (legend.hasScale ());
  entries_->SetVisibility (!legend.hasScale () && !legend.entries.empty ());
  if (legend.hasScale ())
  {
    const bool is_upside_down = legend.most < legend.least; // a table goes from small to large
    vtkNew<vtkLookupTable> table;
    table->SetNumberOfTableValues (scale_colours);
    table->SetTableRange (std::min (legend.least, legend.most), std::max (legend.least, legend.most));
    for (int n = 0; n < scale_colours; ++n)
    {
      const double share = static_cast<double> (n) / (scale_colours - 1);
      const TriangleMesh::Colour colour = errorColour (is_upside_down ? 1.0 - share : share);
      table->SetTableValue (n, colour[0] / 255.0, colour[1] / 255.0, colour[2] / 255.0);
    }
    scale_->SetLookupTable (table);
    scale_->SetTitle (legend.title.c_str ());
    return;
  }
  constexpr double line_share = 0.042, width_share = 0.2, margin = 0.012;
  const auto count = static_cast<int> (std::min<std::size_t> (legend.entries.size (), 16));
  entries_->SetNumberOfEntries (count);
  std::array<double, 3> text_colour = ink;
  for (int n = 0; n < count; ++n)
  {
    const LegendEntry& entry = legend.entries[static_cast<std::size_t> (n)];
    vtkNew<vtkPlaneSource> square; // which has the colour: that of the entry is the text's, too
    square->Update ();
    vtkNew<vtkUnsignedCharArray> colours;
    colours->SetNumberOfComponents (3);
    for (int corner = 0; corner < 4; ++corner)
      colours->InsertNextTypedTuple (entry.colour.data ());
    square->GetOutput ()->GetPointData ()->SetScalars (colours);
    entries_->SetEntry (n, square->GetOutput (), entry.text.c_str (), text_colour.data ());
  }
  entries_->GetPositionCoordinate ()->SetCoordinateSystemToNormalizedViewport ();
  entries_->GetPositionCoordinate ()->SetValue (1.0 - margin - width_share, 1.0 - margin - line_share * count);
  entries_->GetPosition2Coordinate ()->SetCoordinateSystemToNormalizedViewport ();
  entries_->GetPosition2Coordinate ()->SetValue (width_share, line_share * count);
}

} // namespace pcl::cosection
