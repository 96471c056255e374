// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace pcl::cosection
{

/** \brief Union-find over 0 ... size - 1; the representative of a set is its smallest element. */
class DisjointSets
{
public:
  explicit DisjointSets (std::size_t size) : parent_ (size)
  {
    std::iota (parent_.begin (), parent_.end (), std::size_t{0});
  }

  std::size_t find (std::size_t element)
  {
    while (parent_[element] != element)
    {
      parent_[element] = parent_[parent_[element]];
      element = parent_[element];
    }
    return element;
  }

  void unite (std::size_t a, std::size_t b)
  {
    a = find (a);
    b = find (b);
    if (b < a)
      std::swap (a, b);
    parent_[b] = a;
  }

private:
  std::vector<std::size_t> parent_;
};

} // namespace pcl::cosection
