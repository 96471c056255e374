// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

/** \brief The bytes that letters stand for. */
inline std::vector<std::uint8_t>
fromBase64 (const std::string& letters)
{
  static const std::string alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::uint8_t> bytes;
  std::uint32_t group = 0;
  int bits = 0;
  for (const char letter : letters)
  {
    if (letter == '=')
      break;
    group = (group << 6) | static_cast<std::uint32_t> (alphabet.find (letter));
    bits += 6;
    if (bits < 8)
      continue;
    bits -= 8;
    bytes.push_back (static_cast<std::uint8_t> (group >> bits));
  }
  return (bytes);
}
