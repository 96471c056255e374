// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

/** \brief From now on, the first SIGINT or SIGTERM only sets a flag; a second one ends the program at once. A file
 * larger than the system's limit is an error of writing. */
void catchInterruptions ();

/** \brief Whether a signal has asked the program to stop. */
bool interrupted ();
