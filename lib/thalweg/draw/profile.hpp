// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/stream_network.hpp>
#include <thalweg/draw/picture.hpp>

namespace thalweg::draw {

struct ProfileParams {
    int width_px = 1000; ///< [200, 8000]
    int height_px = 560;
    Format format = Format::svg;
};

/// Long profiles: height against distance from the outlet of every stream, the main stem (Hack 1) emphasised.
Picture profile(RaisedNetwork const& network, NetworkOrders const& orders, ProfileParams const& params = {});

} // namespace thalweg::draw
