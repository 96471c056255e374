// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief What a key can make a window do. */
enum class WindowAction
{
  Play,
  Forward,
  Back,
  FarForward,
  FarBack,
  First,
  Last,
  NextSurface,
  NextColour,
  Follow,
  Overview,
  Behind,
  SaveViewpoint,
  LoadViewpoint,
  Background,
  Boxes,
  Lines,
  NextObject,
  Slices,
  SliceX,
  SliceY,
  SliceZ,
  SliceForward,
  SliceBack,
  SavePicture,
  Help,
  Quit,
};

/** \brief By the name that X gives a key; nothing if it does nothing. */
std::optional<WindowAction> actionOf (const std::string& key);

struct KeyHelp
{
  std::string keys;
  std::string meaning;
};

/** \brief All keys, as people call them. */
const std::vector<KeyHelp>& keyHelp ();

} // namespace pcl::cosection
