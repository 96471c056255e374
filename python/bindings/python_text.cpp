// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "python_text.h"

#include <algorithm>
#include <cctype>

std::string
inPython (const std::string& message)
{
  const auto isNamePart = [] (char c) { return std::islower (static_cast<unsigned char> (c)) || c == '-'; };
  const auto isNumberPart = [] (char c) { return std::isdigit (static_cast<unsigned char> (c)) || c == '.'; };
  std::string text;
  for (std::size_t i = 0; i < message.size ();)
  {
    const bool starts = (i == 0 || !std::isalnum (static_cast<unsigned char> (message[i - 1]))) &&
                        message.compare (i, 2, "--") == 0 && i + 2 < message.size () &&
                        std::islower (static_cast<unsigned char> (message[i + 2]));
    if (!starts)
    {
      text += message[i++];
      continue;
    }
    i += 2;
    for (; i < message.size () && isNamePart (message[i]); ++i)
      text += message[i] == '-' ? '_' : message[i];
    if (i + 1 < message.size () && message[i] == ' ' && std::isdigit (static_cast<unsigned char> (message[i + 1])))
    {
      text += '=';
      for (++i; i < message.size () && isNumberPart (message[i]); ++i)
        text += message[i];
    }
  }
  return text;
}
