// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// All public headers of the module.
#include <thalweg/studio/document.hpp>
#include <thalweg/studio/document_folder.hpp>
#include <thalweg/studio/drawing.hpp>
#include <thalweg/studio/drawing_files.hpp>
#include <thalweg/studio/engine.hpp>
#include <thalweg/studio/studio.hpp>
