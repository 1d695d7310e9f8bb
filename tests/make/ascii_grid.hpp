// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fstream>
#include <string>

/// The place of an ESRI grid in EPSG:32631.
struct AsciiGrid {
    int width = 0;
    int height = 0;
    int cell = 0;
    int west = 0;
    int south = 0;
};

/// Writes NAME.asc, with value(column, row), and NAME.prj.
template <class Value> void write_ascii_grid(std::string const& path, AsciiGrid const& grid, Value const& value) {
    std::ofstream out(path);
    out << "ncols " << grid.width << "\nnrows " << grid.height << "\nxllcorner " << grid.west << "\nyllcorner "
        << grid.south << "\ncellsize " << grid.cell << "\nNODATA_value -9999\n";
    for (int r = 0; r < grid.height; ++r) {
        for (int c = 0; c < grid.width; ++c) {
            out << value(c, r) << " ";
        }
        out << "\n";
    }
    std::ofstream(path.substr(0, path.rfind('.')) + ".prj")
        << "PROJCS[\"WGS 84 / UTM zone 31N\",GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,"
           "298.257223563]],PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]],PROJECTION["
           "\"Transverse_Mercator\"],PARAMETER[\"latitude_of_origin\",0],PARAMETER[\"central_meridian\",3],"
           "PARAMETER[\"scale_factor\",0.9996],PARAMETER[\"false_easting\",500000],PARAMETER[\"false_northing\",0],"
           "UNIT[\"metre\",1],AUTHORITY[\"EPSG\",\"32631\"]]";
}
