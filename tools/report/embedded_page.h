// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

/** \brief A file that was compiled into the program. */
struct EmbeddedFile
{
  std::string_view text;
  std::string_view sha256; ///< of the text, in hexadecimal digits
};

extern const EmbeddedFile report_style;      ///< page/report.css
extern const EmbeddedFile report_drawing;    ///< page/drawing.js
extern const EmbeddedFile report_script;     ///< page/report.js
extern const EmbeddedFile report_scene_view; ///< page/scene_view.js
extern const EmbeddedFile three_library;     ///< three.js; empty if the program was built without
extern const EmbeddedFile orbit_controls;    ///< its OrbitControls
extern const EmbeddedFile three_notice;      ///< its licence, page/three_notice.txt
