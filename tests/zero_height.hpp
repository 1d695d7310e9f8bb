// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace test {

/// A river file in which one vertex between higher ones has the height 0, as writers do for a height that is missing.
inline std::string const zero_height =
    R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::32633"}},"features":[
{"type":"Feature","properties":{},"geometry":{"type":"LineString","coordinates":
[[500000,5000000,100],[501000,5000500,0],[502000,5001000,80]]}},
{"type":"Feature","properties":{},"geometry":{"type":"LineString","coordinates":
[[500000,5002000,110],[501000,5001500,95],[502000,5001000,80]]}},
{"type":"Feature","properties":{},"geometry":{"type":"LineString","coordinates":
[[502000,5001000,80],[503000,5001100,70],[504000,5001000,60]]}}]}
)";

} // namespace test
