// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace pcl::cosection {

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

  /** \brief The number of each element's set, in the order of their first elements.
   * \param[in] counts (element): whether it has a number, else -1; the same for all of a set */
  template <typename Counts> std::vector<int> numbers (Counts&& counts)
  {
    std::vector<int> numbers (parent_.size (), -1);
    int next = 0;
    for (std::size_t i = 0; i < numbers.size (); ++i)
      if (counts (i))
      {
        const std::size_t first = find (i);
        numbers[i] = first == i ? next++ : numbers[first];
      }
    return numbers;
  }

  std::vector<int> numbers ()
  {
    return numbers ([] (std::size_t) { return true; });
  }

private:
  std::vector<std::size_t> parent_;
};

} // namespace pcl::cosection
