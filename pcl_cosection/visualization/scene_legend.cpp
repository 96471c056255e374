// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "scene_legend.h"

#include "pcl_cosection/evaluation/pictures/error_picture.h"
#include "pcl_cosection/rendering/picture.h"
#include "pcl_cosection/sequence/stamp_matching.h"

#include <algorithm>
#include <array>
#include <sstream>

namespace pcl::cosection {
namespace {

constexpr TriangleMesh::Colour plain = {200, 200, 200}; ///< where nothing is known
constexpr TriangleMesh::Colour background_grey = {225, 222, 216};

/** \brief ", cup"; nothing if that is not known. */
std::string
classIn (const RunScene& scene, int id)
{
  constexpr std::size_t longest = 20; // so that a legend stays narrow
  const auto found = scene.classes.find (id);
  if (found == scene.classes.end ())
    return "";
  const std::string& name = found->second;
  if (name.size () <= longest)
    return ", " + name;
  std::size_t end = longest;
  while (end > 0 && (static_cast<unsigned char> (name[end]) & 0xC0) == 0x80) // not within a letter of UTF-8
    --end;
  return ", " + name.substr (0, end) + "...";
}

} // namespace

TriangleMesh::Colour
instanceColour (int id)
{
  static constexpr std::array<TriangleMesh::Colour, 10> colours = {{{214, 84, 60},
                                                                    {66, 126, 190},
                                                                    {240, 180, 50},
                                                                    {94, 160, 84},
                                                                    {150, 104, 176},
                                                                    {80, 182, 190},
                                                                    {228, 134, 178},
                                                                    {150, 116, 84},
                                                                    {170, 190, 60},
                                                                    {96, 96, 130}}};
  if (id == RunScene::background)
    return background_grey;
  return colours[static_cast<std::size_t> (id - 1) % colours.size ()];
}

std::vector<TriangleMesh::Colour>
surfaceColours (const RunScene& scene, int id, SurfaceMode surface, ColourMode colour)
{
  const TriangleMesh& mesh = scene.surface (id, surface);
  const std::size_t count = mesh.vertices.size ();
  std::vector<TriangleMesh::Colour> colours (count, id == RunScene::background ? background_grey : plain);
  switch (colour)
  {
  case ColourMode::Real:
    if (mesh.colours.size () == count)
      colours = mesh.colours;
    break;
  case ColourMode::Instance:
    std::fill (colours.begin (), colours.end (), instanceColour (id));
    break;
  case ColourMode::Provenance:
    if (mesh.provenance.size () == count)
      colours = provenanceColours (mesh);
    break;
  case ColourMode::Confidence:
    if (mesh.confidence.size () == count)
      std::transform (mesh.confidence.begin (), mesh.confidence.end (), colours.begin (),
                      [] (float confidence) { return errorColour (1.0 - static_cast<double> (confidence)); });
    break;
  case ColourMode::Error:
    if (scene.surfaceErrors (id, surface).size () == count)
      colours = errorColours (scene.surfaceErrors (id, surface), scene.error_max_m);
    break;
  }
  return colours;
}

const std::vector<std::string>&
surfaceNames ()
{
  static const std::vector<std::string> names = {"completed", "tsdf", "points"};
  return names;
}

const std::vector<std::string>&
colourNames ()
{
  static const std::vector<std::string> names = {"real", "instance", "provenance", "confidence", "error"};
  return names;
}

ColourLegend
legendOf (const RunScene& scene, ColourMode colour)
{
  ColourLegend legend;
  switch (colour)
  {
  case ColourMode::Real:
    break;
  case ColourMode::Instance:
    legend.title = "instance";
    for (const SceneRecord::Object& object : scene.run.objects)
      legend.entries.push_back ({instanceColour (object.id), "object " + object.name + classIn (scene, object.id)});
    break;
  case ColourMode::Provenance:
  {
    legend.title = "provenance";
    TriangleMesh all;
    all.provenance = {0, 1, 2, 3};
    all.vertices.resize (all.provenance.size ());
    const std::vector<TriangleMesh::Colour> colours = provenanceColours (all);
    legend.entries = {{colours[0], "observed"},
                      {colours[1], "inferred"},
                      {colours[2], "bounded by free space"},
                      {colours[3], "bounded by a body"}};
    break;
  }
  case ColourMode::Confidence:
    legend.title = "confidence";
    legend.least = 1.0;
    legend.most = 0.0;
    break;
  case ColourMode::Error:
    legend.title = "error in mm";
    legend.most = 1000.0 * scene.error_max_m;
    legend.more = true;
    break;
  }
  return legend;
}

std::string
sceneCaption (const RunScene& scene, double stamp, SurfaceMode surface, ColourMode colour)
{
  const std::vector<double> stamps = scene.stamps ();
  std::ostringstream text;
  text.precision (12);
  if (const auto frame = nearestStamp (stamps, stamp, stampPeriod (stamps)))
    text << "frame " << *frame + 1 << " of " << stamps.size () << ", stamp " << stamps[*frame];
  else
    text << "stamp " << stamp;
  const auto known = std::count_if (
      scene.run.objects.begin (), scene.run.objects.end (),
      [&] (const SceneRecord::Object& object) { return scene.poseAt (object, stamp).has_value (); });
  text << ", " << known << (known == 1 ? " object" : " objects");
  text << (surface == SurfaceMode::Completed ? ", completed"
           : surface == SurfaceMode::Tsdf    ? ", as seen"
                                             : ", points of this frame");
  if (surface != SurfaceMode::Points && colour != ColourMode::Real)
    text << ", colour: " << colourNames ()[static_cast<std::size_t> (colour)];
  return text.str ();
}

} // namespace pcl::cosection
