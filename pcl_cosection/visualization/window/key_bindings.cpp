// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "key_bindings.h"

#include <map>

namespace pcl::cosection {

std::optional<WindowAction>
actionOf (const std::string& key)
{
  static const std::map<std::string, WindowAction> actions = {
      {"space", WindowAction::Play},      {"Right", WindowAction::Forward},   {"Left", WindowAction::Back},
      {"Next", WindowAction::FarForward}, // page down
      {"Prior", WindowAction::FarBack},   // page up
      {"Home", WindowAction::First},      {"End", WindowAction::Last},        {"m", WindowAction::NextSurface},
      {"c", WindowAction::NextColour},    {"f", WindowAction::Follow},        {"o", WindowAction::Overview},
      {"b", WindowAction::Behind},        {"v", WindowAction::SaveViewpoint}, {"l", WindowAction::LoadViewpoint},
      {"g", WindowAction::Background},    {"k", WindowAction::Boxes},         {"t", WindowAction::Lines},
      {"Tab", WindowAction::NextObject},  {"s", WindowAction::Slices},        {"x", WindowAction::SliceX},
      {"y", WindowAction::SliceY},        {"z", WindowAction::SliceZ},        {"Up", WindowAction::SliceForward},
      {"Down", WindowAction::SliceBack},  {"p", WindowAction::SavePicture},   {"h", WindowAction::Help},
      {"q", WindowAction::Quit},          {"Escape", WindowAction::Quit}};
  const auto found = actions.find (key);
  if (found == actions.end ())
    return std::nullopt;
  return found->second;
}

const std::vector<KeyHelp>&
keyHelp ()
{
  static const std::vector<KeyHelp> help = {{"space", "play, pause"},
                                            {"left, right", "one frame back, on"},
                                            {"page up, down", "ten frames back, on"},
                                            {"Home, End, 0-9", "first, last frame, tenths of the run"},
                                            {"m", "surfaces: completed, as seen, points of the frame"},
                                            {"c", "colours: real, instance, provenance, confidence, error"},
                                            {"mouse", "left: turn, middle: shift, right or wheel: zoom"},
                                            {"f", "follow the camera, or let go of it"},
                                            {"o, b", "overview, the same from behind"},
                                            {"v, l", "save the viewpoint, load it"},
                                            {"g", "background"},
                                            {"k", "bounding volumes"},
                                            {"t", "path of the camera and what it sees"},
                                            {"s", "slices of the signed distance of an object"},
                                            {"Tab", "the next object"},
                                            {"x, y, z", "one of the slices: hide it, or choose it again"},
                                            {"up, down", "move the chosen slice"},
                                            {"p", "save a picture of the window"},
                                            {"h", "this help"},
                                            {"q, Escape", "close the window"}};
  return help;
}

} // namespace pcl::cosection
