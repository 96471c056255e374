// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

/** \brief What a browser makes of a page. */
struct BrowsedPage
{
  std::string document; ///< after its scripts have run
  std::string console;  ///< lines that they, or the browser about them, wrote
};

/** \brief Whether there is a browser to open pages with. */
bool hasBrowser ();

/** \brief Open a page in a browser without network and without a display.
 * \param[in] folder of the page; the browser notes what the page asks for in net.json there
 * \param[in] name of the page, with what may follow a #
 * \param[in] more arguments of the browser */
BrowsedPage browse (const std::string& folder, const std::string& name, const std::vector<std::string>& more);

/** \brief A document without its scripts and their data: what a reader may see. */
std::string withoutScripts (const std::string& document);
