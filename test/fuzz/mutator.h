// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace fuzz {

/** \brief Spoils inputs: bits, bytes, numbers, words, lines and columns of a header, at random but
 * the same for the same seed. */
class Mutator
{
public:
  /** \param[in] seeds inputs to begin with, at least one
   * \param[in] dictionary words to put in */
  Mutator (const std::vector<std::string>& seeds, const std::vector<std::string>& dictionary);

  /** \brief The input number \a run of the sequence \a seed: one of the seeds after one to eight changes. */
  std::string make (std::uint64_t seed, std::uint64_t run);

private:
  struct Span
  {
    std::size_t begin, end;
  };

  std::size_t below (std::size_t limit);

  /** \brief A place in \a text, half of the time in its beginning, where headers are. */
  std::size_t place (const std::string& text);

  std::string word ();

  Span lineAt (const std::string& text, std::size_t i) const;

  Span tokenAt (const std::string& text, std::size_t i) const;

  void change (std::string& text);

  void changeBytes (std::string& text);

  void changeTokens (std::string& text);

  void changeLines (std::string& text);

  void changeColumn (std::string& text);

  const std::vector<std::string> seeds_;
  const std::vector<std::string> dictionary_;
  std::mt19937_64 random_;
};

} // namespace fuzz
