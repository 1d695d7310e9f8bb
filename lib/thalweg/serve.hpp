// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// Requests of a browser on this machine → a page, files, messages of a WebSocket.
#include <thalweg/serve/serve.hpp>
