// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// A terrain → files for game engines, 3D programs, printers and the web. Its namespace is `exports`: `export` is a
/// word of C++.
#include <thalweg/export/export.hpp>
