// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "common/small_meshes.h"

#include "pcl_cosection/physics/physical_scene.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <locale>
#include <sstream>
#include <string>
#include <vector>

namespace pcl::cosection::test {

/** \brief A box of two parts, a ball, a flat static surface, an endless plane and a tilted one with an end. */
inline PhysicalScene
sceneToWrite ()
{
  PhysicalScene scene;
  scene.name = "a <scene> & \"more\"";
  scene.T_result_scene = Eigen::Translation3d (1.0, 2.0, 3.0) * Eigen::AngleAxisd (0.3, Eigen::Vector3d::UnitX ());
  scene.gravity = {0.1, 0.0, -9.7};
  scene.warnings = {"not UTF-8: \xff"};

  PhysicalBody box;
  box.name = "box_1";
  box.id = 1;
  box.T_scene_body = Eigen::Translation3d (0.3, -0.2, 0.03) * Eigen::AngleAxisd (0.7, Eigen::Vector3d::UnitZ ());
  box.visual = boxMesh ({-0.05f, -0.04f, -0.03f}, {0.05f, 0.04f, 0.03f});
  for (std::uint8_t v = 0; v < 8; ++v)
    box.visual.colours.push_back ({std::uint8_t (30 * v), std::uint8_t (255 - 20 * v), 100});
  box.parts = {boxMesh ({-0.05f, -0.04f, -0.03f}, {0.01f, 0.04f, 0.03f}),
               boxMesh ({0.01f, -0.04f, -0.03f}, {0.05f, 0.04f, 0.03f})};
  box.mass_kg = 0.24;
  box.centre_m = {0.001, 0.002, -1.0 / 300.0};
  box.inertia << 2e-4, 1e-5, 2e-6, 1e-5, 2.7e-4, -3e-6, 2e-6, -3e-6, 3.3e-4;
  box.stands_on = 0;

  PhysicalBody ball;
  ball.name = "ball_2";
  ball.id = 2;
  ball.T_scene_body.translation () << -0.3, 0.0, 0.04;
  ball.visual = sphereMesh (0.04, 12);
  ball.parts = {sphereMesh (0.04, 6)};
  ball.mass_kg = 0.2;
  ball.inertia = 1.28e-4 * Eigen::Matrix3d::Identity ();

  PhysicalBody wall;
  wall.name = "wall";
  wall.visual = sheetMesh (3, [] (double, double) { return true; });
  wall.parts = {boxMesh ({0.0f, 0.0f, -0.1f}, {1.0f, 1.0f, 0.0f})};
  wall.convex = false;
  scene.bodies = {box, ball, wall};

  PhysicalPlane table;
  table.name = "table";
  table.half_size_m = {1.0, 0.8};
  PhysicalPlane shelf = table;
  shelf.name = "shelf";
  shelf.T_scene_plane = Eigen::Translation3d (2.0, 0.0, 0.5) * Eigen::AngleAxisd (0.2, Eigen::Vector3d::UnitX ());
  shelf.endless = false;
  scene.planes = {table, shelf};
  return scene;
}

/** \brief The numbers of a text, between spaces, commas or brackets. */
inline std::vector<double>
numbersOf (std::string text)
{
  std::replace_if (
      text.begin (), text.end (), [] (char c) { return std::strchr ("(),", c) != nullptr; }, ' ');
  std::istringstream in (text);
  in.imbue (std::locale::classic ());
  std::vector<double> numbers;
  for (double number; in >> number;)
    numbers.push_back (number);
  return numbers;
}

inline std::vector<double>
asVector (const Eigen::Ref<const Eigen::VectorXd>& values)
{
  return {values.data (), values.data () + values.size ()};
}

inline Eigen::Quaterniond
quaternionOf (const std::vector<double>& xyzw)
{
  return {xyzw[3], xyzw[0], xyzw[1], xyzw[2]};
}

} // namespace pcl::cosection::test
