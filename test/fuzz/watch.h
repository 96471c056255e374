// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace fuzz {

/** \brief Make crashes, hangs and absurd allocations end the program with a message, after saving the
 * input that is being read. To be called once.
 *
 * Without a sanitizer memory is limited by RLIMIT_AS, so that an allocation beyond it throws
 * std::bad_alloc; with AddressSanitizer by its own limits. */
void startWatching (const std::string& program);

/** \brief \a input is read from now on; it must stay alive until watchEnd ().
 * \param[in] name file of the working directory to which it is saved if it fails; empty: it is not
 * saved, as it is a file already */
void watchBegin (const std::string& input, const std::string& name);

void watchEnd ();

} // namespace fuzz
