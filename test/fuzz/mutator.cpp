// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "mutator.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <sstream>

namespace fuzz {
namespace {

constexpr std::size_t header_bytes = 400;
constexpr std::size_t max_bytes = 1 << 16;
constexpr std::size_t max_changes = 8;

const std::array<const char*, 34> numbers = {"0",
                                             "-0",
                                             "1",
                                             "-1",
                                             "2",
                                             "3",
                                             "7",
                                             "8",
                                             "127",
                                             "255",
                                             "256",
                                             "65535",
                                             "65536",
                                             "2147483647",
                                             "2147483648",
                                             "-2147483649",
                                             "4294967295",
                                             "4294967296",
                                             "1073741824",
                                             "18446744073709551615",
                                             "9223372036854775807",
                                             "99999999999999999999999",
                                             "1e308",
                                             "-1e308",
                                             "1e999",
                                             "1e-310",
                                             "nan",
                                             "-nan",
                                             "inf",
                                             "-inf",
                                             "0x10",
                                             "1.5",
                                             "1e38",
                                             ""};

constexpr std::array<std::uint32_t, 12> integers = {0,      1,      2,       16,         255,        256,
                                                    0x7fff, 0xffff, 0x10000, 0x7fffffff, 0x80000000, 0xffffffff};

bool
isSpace (char c)
{
  return (c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == ',' || c == '=');
}

std::vector<std::string>
splitWords (const std::string& line)
{
  std::istringstream stream (line);
  std::vector<std::string> words;
  for (std::string w; stream >> w;)
    words.push_back (w);
  return (words);
}

} // namespace

Mutator::Mutator (const std::vector<std::string>& seeds, const std::vector<std::string>& dictionary)
    : seeds_ (seeds)
    , dictionary_ (dictionary)
{}

std::string
Mutator::make (std::uint64_t seed, std::uint64_t run)
{
  std::seed_seq sequence{seed, seed >> 32, run, run >> 32};
  random_.seed (sequence);
  std::string text = seeds_[below (seeds_.size ())];
  for (std::size_t n = 1 + below (1 + below (max_changes)); n > 0; --n) // more often few than many
    change (text);
  if (text.size () > max_bytes)
    text.resize (max_bytes);
  return (text);
}

std::size_t
Mutator::below (std::size_t limit)
{
  return (limit == 0 ? 0 : static_cast<std::size_t> (random_ () % limit));
}

std::size_t
Mutator::place (const std::string& text)
{
  return (below (below (2) == 0 ? std::min (text.size (), header_bytes) : text.size ()));
}

std::string
Mutator::word ()
{
  if (dictionary_.empty () || below (2) == 0)
    return (numbers[below (numbers.size ())]);
  return (dictionary_[below (dictionary_.size ())]);
}

Mutator::Span
Mutator::lineAt (const std::string& text, std::size_t i) const
{
  const std::size_t before = i == 0 ? std::string::npos : text.rfind ('\n', i - 1);
  const std::size_t after = text.find ('\n', i);
  return {before == std::string::npos ? 0 : before + 1, after == std::string::npos ? text.size () : after + 1};
}

Mutator::Span
Mutator::tokenAt (const std::string& text, std::size_t i) const
{
  Span token = {i, i};
  while (token.begin > 0 && !isSpace (text[token.begin - 1]))
    --token.begin;
  while (token.end < text.size () && !isSpace (text[token.end]))
    ++token.end;
  return (token);
}

void
Mutator::change (std::string& text)
{
  switch (below (10))
  {
  case 0:
  case 1:
  case 2:
    return (changeBytes (text));
  case 3:
  case 4:
  case 5:
    return (changeTokens (text));
  case 6:
  case 7:
    return (changeLines (text));
  case 8:
    return (changeColumn (text));
  default:
    break;
  }
  const std::string& other = seeds_[below (seeds_.size ())];
  switch (below (3))
  {
  case 0: // the beginning of one and the end of the other
    text = text.substr (0, place (text)) + other.substr (below (other.size ()));
    break;
  case 1: // a part of the other
    text.insert (place (text), other.substr (below (other.size ()), below (256)));
    break;
  default:
    text.resize (place (text));
  }
}

void
Mutator::changeBytes (std::string& text)
{
  if (text.empty ())
    return;
  const std::size_t i = place (text);
  switch (below (6))
  {
  case 0:
    text[i] = static_cast<char> (text[i] ^ (1 << below (8)));
    break;
  case 1:
    text[i] = static_cast<char> (random_ ());
    break;
  case 2:
    text.insert (i, 1 + below (8), static_cast<char> (random_ ()));
    break;
  case 3:
    text.erase (i, 1 + below (16));
    break;
  case 4:
    text.insert (i, text.substr (i, 1 + below (64)));
    break;
  default:
    const std::uint32_t value = integers[below (integers.size ())];
    if (i + sizeof (value) <= text.size ())
      std::memcpy (&text[i], &value, sizeof (value));
  }
}

void
Mutator::changeTokens (std::string& text)
{
  const Span token = tokenAt (text, place (text));
  const std::string old = text.substr (token.begin, token.end - token.begin);
  const auto replace = [&] (const std::string& fresh) { text.replace (token.begin, old.size (), fresh); };
  switch (below (5))
  {
  case 0:
  case 1:
    return (replace (word ()));
  case 2: // a little off
    if (!old.empty () && old.find_first_not_of ("0123456789") == std::string::npos && old.size () < 18)
      replace (std::to_string (std::strtoll (old.c_str (), nullptr, 10) + static_cast<long long> (below (5)) - 2));
    return;
  case 3:
    return (replace (old + " " + word ()));
  default:
    const Span other = tokenAt (text, place (text));
    if (other.begin < token.end)
      return;
    const std::string fresh = text.substr (other.begin, other.end - other.begin);
    text.replace (other.begin, fresh.size (), old);
    replace (fresh);
  }
}

void
Mutator::changeLines (std::string& text)
{
  const Span line = lineAt (text, place (text));
  const std::string content = text.substr (line.begin, line.end - line.begin);
  const std::size_t elsewhere = lineAt (text, place (text)).begin;
  switch (below (5))
  {
  case 0:
    text.erase (line.begin, content.size ());
    break;
  case 1:
    text.insert (line.begin, content);
    break;
  case 2:
    text.insert (elsewhere, content);
    break;
  case 3: // move
    text.erase (line.begin, content.size ());
    text.insert (std::min (lineAt (text, std::min (elsewhere, text.size ())).begin, text.size ()), content);
    break;
  default:
    text.insert (line.begin, word () + " " + word () + "\n");
  }
}

/** \brief Remove, repeat or replace one word of each of the lines that have the same number of words,
 * as the lines FIELDS, SIZE, TYPE and COUNT of a PCD file have. */
void
Mutator::changeColumn (std::string& text)
{
  Span line = lineAt (text, place (text));
  const std::size_t columns = splitWords (text.substr (line.begin, line.end - line.begin)).size ();
  if (columns < 2)
    return;
  const std::size_t column = 1 + below (columns - 1);
  const std::size_t kind = below (3);
  const std::string fresh = word ();
  constexpr int most_lines = 4;
  for (int n = 0; n < most_lines; ++n)
  {
    std::vector<std::string> words = splitWords (text.substr (line.begin, line.end - line.begin));
    if (words.size () != columns)
      return;
    if (kind == 0)
      words.erase (words.begin () + static_cast<std::ptrdiff_t> (column));
    else if (kind == 1)
      words.insert (words.begin () + static_cast<std::ptrdiff_t> (column), std::string (words[column]));
    else
      words[column] = fresh;
    std::string changed;
    for (const std::string& w : words)
      changed += (changed.empty () ? "" : " ") + w;
    changed += "\n";
    text.replace (line.begin, line.end - line.begin, changed);
    if (line.begin + changed.size () >= text.size ())
      return;
    line = lineAt (text, line.begin + changed.size ());
  }
}

} // namespace fuzz
