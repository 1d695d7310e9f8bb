// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// A terrain → its folder: files, report.json, report page, pictures; and such a folder → what can be drawn of it.
#include <thalweg/report/landmarks.hpp>
#include <thalweg/report/live_page.hpp>
#include <thalweg/report/page.hpp>
#include <thalweg/report/pictures.hpp>
#include <thalweg/report/read_scene.hpp>
#include <thalweg/report/report.hpp>
