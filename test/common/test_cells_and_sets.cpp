// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "pcl_cosection/common/disjoint_sets.h"
#include "pcl_cosection/common/lattice_cells.h"
#include "pcl_cosection/common/robust_weights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

using namespace pcl::cosection;

TEST (CellKey, CellsAreNumberedFromMinusInfinity)
{
  EXPECT_EQ (CellIndex (-1, 0, 2), *cellOf ({-0.5, 0.5, 2.0}));
  EXPECT_FALSE (cellOf ({0.0, 2.0 * farthest_cell, 0.0}));
  EXPECT_FALSE (cellOf ({std::numeric_limits<double>::quiet_NaN (), 0.0, 0.0}));
}

TEST (CellKey, NeighboursHaveDifferentKeysAlsoAcrossZero)
{
  std::set<std::uint64_t> keys;
  for (const CellIndex& cell : {CellIndex (0, 0, 0), CellIndex (100, -100, 7)})
    for (int n = 0; n < 27; ++n)
    {
      EXPECT_LE ((neighbourOf (cell, n) - cell).cwiseAbs ().maxCoeff (), 1);
      keys.insert (keyOf (neighbourOf (cell, n)));
    }
  EXPECT_EQ (54u, keys.size ());
  EXPECT_EQ (CellIndex (5, 6, 7), neighbourOf ({5, 6, 7}, 13));
}

TEST (OccupiedCells, AreNumberedAsTheyComeAndKnowTheirNeighbours)
{
  OccupiedCells cells;
  EXPECT_EQ (0u, cells.add ({0, 0, 0}));
  EXPECT_EQ (1u, cells.add ({-1, 1, 0}));
  EXPECT_EQ (2u, cells.add ({2, 0, 0}));
  EXPECT_EQ (1u, cells.add ({-1, 1, 0}));
  EXPECT_EQ (3u, cells.size ());
  std::set<std::size_t> beside;
  cells.forNeighbours (0, [&] (std::size_t number) { beside.insert (number); });
  EXPECT_EQ ((std::set<std::size_t>{0, 1}), beside);
}

TEST (DisjointSets, AreNumberedInTheOrderOfTheirFirstElements)
{
  DisjointSets sets (6);
  sets.unite (4, 1);
  sets.unite (5, 4);
  sets.unite (2, 3);
  EXPECT_EQ ((std::vector<int>{0, 1, 2, 2, 1, 1}), sets.numbers ());
  EXPECT_EQ ((std::vector<int>{-1, 0, 1, 1, 0, 0}), sets.numbers ([] (std::size_t i) { return i > 0; }));
}

TEST (RobustWeights, HubersWeightIsTheSlopeOfItsFunction)
{
  const double bound = 0.3, step = 1e-6;
  for (const double size : {0.01, 0.1, 0.29, 0.31, 1.0, 10.0})
    EXPECT_NEAR ((huberCost (size + step, bound) - huberCost (size - step, bound)) / (2.0 * step),
                 huberWeight (size, bound) * size, 1e-6);
}

TEST (RobustWeights, FallFromOne)
{
  EXPECT_EQ (1.0, cauchyWeight (0.0));
  EXPECT_EQ (0.5, cauchyWeight (1.0));
  EXPECT_EQ (1.0, tukeyWeight (0.0));
  EXPECT_EQ (0.0, tukeyWeight (1.0));
  EXPECT_EQ (1.0f, huberWeight (0.0f, 0.1f));
}
