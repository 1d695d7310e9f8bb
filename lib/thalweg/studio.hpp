// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// A folder with a recipe and its inputs ↔ a document that is edited, its terrain, and a page that shows both.
#include <thalweg/studio/document.hpp>
#include <thalweg/studio/document_folder.hpp>
#include <thalweg/studio/drawing.hpp>
#include <thalweg/studio/drawing_files.hpp>
#include <thalweg/studio/engine.hpp>
#include <thalweg/studio/studio.hpp>
