// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "room_regions.h"

#include <map>
#include <utility>
#include <vector>

namespace pcl::cosection {

/** \brief What is known of a piece of the scene as a whole. */
struct Piece
{
  int pixels = 0;
  int edge_pixels = 0;   ///< on the border of what is seen in the image
  float area_m2 = 0.0f;  ///< as the sensor sees it
  float length_m = 0.0f; ///< of the box along its principal axes
  float carried = 0.0f;  ///< share of its pixels above a support surface
  float lowest_m = 1e9f; ///< height above the surface nearest below
  float highest_m = -1e9f;
  float sigma_m = 0.0f;   ///< largest noise of its readings
  float convexity = 0.0f; ///< correlation of place and normal: 1 for a ball from outside, -1 from inside
  float turning = 0.0f;   ///< standard deviation of its normals: 0 for a plane
};

/** \brief How two pieces meet in the image. */
struct Border
{
  int touching = 0;               ///< pixels where one continues the other
  float touching_height_m = 0.0f; ///< sum of their heights above the support
  int first_front = 0;            ///< pixels where the first one is nearer, with a step in depth
  int second_front = 0;
};

using Borders = std::map<std::pair<int, int>, Border>; ///< of pairs of pieces, the smaller number first

/** \brief How the outline of a piece goes on in the image, in pixels. */
struct PieceOutline
{
  int free = 0; ///< what is seen beside it is farther away, or lower
  int held = 0; ///< it touches the room, on which it stands, or of which it is a part
  int edge = 0; ///< of these: it falls off behind the surface that it touches
};

// In all of these, piece_of has one per pixel: its piece, -1 for none.

std::vector<Piece> describePieces (const DepthGrid& grid, const std::vector<SupportSurface>& surfaces,
                                   const std::vector<int>& piece_of);

/** \brief Where pieces meet along rows and columns, with at most a few pixels of no piece, or the shadow of the nearer
 * one, between. */
Borders findBorders (const DepthGrid& grid, const std::vector<SupportSurface>& surfaces,
                     const std::vector<int>& piece_of);

/** \param[in] pieces number of them */
std::vector<PieceOutline> outlinePieces (const DepthGrid& grid, const Room& room, const std::vector<int>& piece_of,
                                         std::size_t pieces);

} // namespace pcl::cosection
