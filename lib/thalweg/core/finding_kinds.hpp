// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>

namespace thalweg {

/// How much a finding matters. note: what was done, or a fact. warning: the result may not be what was meant. error: a
/// fault that makes a check fail.
enum class Severity : std::uint8_t { note, warning, error };

/// "note", "warning" or "error".
constexpr char const* name_of(Severity severity) {
    return severity == Severity::note ? "note" : severity == Severity::warning ? "warning" : "error";
}

/// Whether a kind has one finding in a run, which is printed, or one a feature, which are listed.
enum class Printed : std::uint8_t { always, verbose };

/// What is the same for all findings of a kind; docs/findings.md is written from these rows.
struct FindingRow {
    std::string_view kind; ///< snake_case, unique
    Severity severity;
    Printed printed;
    std::string_view unit;    ///< of Finding::amount, "1" for a share; "": the amount has no meaning
    std::string_view meaning; ///< a sentence
    std::string_view remedy;  ///< a sentence; "": there is nothing to do
};

/// All kinds of findings, in the order of their names.
inline constexpr auto finding_rows = [] {
    using enum Severity;
    using enum Printed;
    auto rows = std::to_array<FindingRow>({
        // Files of lines and networks, as they are read.
        {"as_text", note, verbose, "", "Fields have a type that is kept as text.", ""},
        {"bridged", note, verbose, "arcs", "An arc is linked across a gap in the file's ids.", ""},
        {"by_feature", note, verbose, "arcs", "Arcs have no ids in the file and get the numbers of their features.",
         ""},
        {"curve", note, verbose, "vertices", "A curve is drawn by straight segments.", ""},
        {"cut_below", note, verbose, "arcs", "An arc links to one that the file does not hold, and ends there.", ""},
        {"heights_converted", note, verbose, "1", "Heights are converted to metres by this factor.", ""},
        {"heights_of_fields", note, always, "lines", "Heights of lines come from fields of their ends.", ""},
        {"layers_not_read", note, always, "m", "Other layers of the file hold lines that are not read.",
         "network.lines.layer (check, convert: --layer) takes several, separated by commas."},
        {"left_out", note, verbose, "vertices", "A feature, or its vertices without finite coordinates, are left out.",
         "Repair the geometry in the file if the river is wanted."},
        {"measures", note, verbose, "lines", "Measures (M) of lines are left out.", ""},
        {"missing_field", note, verbose, "fields", "The file lacks fields of its schema.",
         "Name the fields with --field QUANTITY=NAME."},
        {"missing_nodes", note, verbose, "", "The file has no layer of nodes; they are made of the ends of arcs.", ""},
        {"multi_part", note, verbose, "parts", "A feature of several parts becomes several arcs.", ""},
        {"no_crs", note, always, "", "A file has no coordinate reference system; its coordinates count as metres.",
         "Name the system with --source-crs EPSG:N, or write it into the file."},
        {"no_heights", note, verbose, "features", "Features have no heights, or all are 0.",
         "Take heights from a DEM, or let network.heights set them."},
        {"not_a_line", note, always, "features", "Features that are not lines are passed over.", ""},
        {"not_utf8", note, verbose, "values", "Bytes of texts that are not UTF-8 are kept as \\xNN.",
         "Write the encoding into the file (.cpg of a Shapefile)."},
        {"not_a_number", note, verbose, "", "A field that holds whole numbers has something else.", ""},
        {"null_number", note, verbose, "", "A feature has no value in a field of numbers.", ""},
        {"reprojected", note, verbose, "", "Coordinates of a file are reprojected.", ""},
        {"in_degrees", note, always, "", "A network is written as GeoJSON, in degrees.", ""},
        {"same_heights", note, always, "m", "All lines have one and the same height, which counts as none.",
         "Give them heights that fall downstream, or let network.heights set them."},
        {"text_number", note, verbose, "", "A field of texts is read as numbers.", ""},
        {"unused_fields", note, always, "lines",
         "Fields look like links, nodes or directions of lines, and no known data set has them.",
         "Name them with --field QUANTITY=NAME."},
        {"turned", note, verbose, "arcs", "The schema draws arcs upstream; they are turned.", ""},
        // Rivers of a file, as they become a network.
        {"captured", note, verbose, "cells",
         "Two arcs meet in cells where neither ends: the water of one goes on in the other.",
         "Make grid.cell smaller to keep them apart."},
        {"connector", note, verbose, "m",
         "A canal or ditch is part of the network because rivers reach their outlet by it only.", ""},
        {"cut", note, verbose, "m", "The part of a line that another one covers is left out.", ""},
        {"duplicate", note, verbose, "m", "A line that lies on another one is left out.", ""},
        {"few_vertices", note, always, "m",
         "Half of the length of given lines is straight pieces of more than ten cells: generalised rivers, which show "
         "in the terrain as they are.",
         "network.meander = 1 bends them; they leave their lines."},
        {"height", note, verbose, "m", "Lines have different heights where they meet; the node gets one of them.", ""},
        {"lake_crossed", note, verbose, "m",
         "Rivers that end at the shore of a lake run on through it, to its outflow or to the river in it.", ""},
        {"joined", note, verbose, "m",
         "Two ends become one node, as the line between them vanishes in the snap distance.", ""},
        {"lowered", note, verbose, "m", "Heights of a river that rise downstream are lowered.", ""},
        {"removed", note, verbose, "vertices", "Vertices or lines without length are removed.", ""},
        {"reversed", note, verbose, "m", "A line is drawn upstream and is reversed.",
         "network.lines.orientation sets what decides directions."},
        {"secondary", note, verbose, "m",
         "A line is not part of the network: a side branch, a coastline, or one that the filter leaves out.",
         "network.lines.divergences and network.lines.filter decide this."},
        {"snapped", note, verbose, "m", "An end is moved to the node, line or end beside it.",
         "network.lines.snap sets the distance."},
        {"split", note, verbose, "", "A line is split where another one meets it.", ""},
        // Directions of lines.
        {"conflicting_direction", note, verbose, "1",
         "Evidence for two outlets of a part of the network is nearly equal.",
         "Set network.lines.dem, or network.lines.orientation."},
        {"contradicted_direction", note, verbose, "1", "A direction contradicts a part of the evidence.",
         "Set network.lines.dem, or network.lines.orientation."},
        {"directions", note, always, "m",
         "Lines were drawn upstream and are reversed: how much, and by which evidence.",
         "network.lines.orientation sets what decides directions."},
        {"doubtful_directions", warning, always, "",
         "The evidence for directions of lines is weak or contradicts itself.",
         "Set network.lines.dem=FILE or --dem FILE, or network.lines.orientation."},
        {"second_outlet", note, verbose, "1", "A part of the network may have a second outlet.",
         "Set network.lines.dem, or network.lines.orientation."},
        {"turned_rank", note, always, "1",
         "A rank rises downstream by this share of what else the file says, and counts the other way round.",
         "network.lines.orientation = \"rank\" takes it as it is."},
        {"uncertain_direction", note, verbose, "1", "The evidence for the directions of a part of the network is weak.",
         "Set network.lines.dem, or network.lines.orientation."},
        // Outlets.
        {"added_outlet", note, verbose, "", "An outlet is added for land without one.", ""},
        {"carried_outlet", note, verbose, "m", "An outlet inside the grid is extended to its border or to the coast.",
         "network.inland says where rivers may end."},
        {"closed_basin", note, verbose, "", "An outlet stays inside the grid: every way out meets a river.", ""},
        {"crowded_outlet", note, verbose, "",
         "An outlet is left out: it is too close to another river, or the land is too narrow.", ""},
        {"dry_land", note, verbose, "cells", "An island has no room for a river.", ""},
        {"joined_outlet", note, verbose, "m", "An outlet inside the grid is extended to another river.",
         "network.inland says where rivers may end."},
        {"moved_outlet", note, verbose, "m", "An outlet off the coast is moved to it.", ""},
        {"pruned_outlet", note, verbose, "", "A river is pruned away with its outlet: its branches are too short.",
         "Set network.prune to a smaller length."},
        // Lakes and rivers in equilibrium with terrain.
        {"lake_cut", note, verbose, "cells",
         "Cells are taken off a lake at the grid's edge, beside the sea, another lake or a passing river.", ""},
        {"lake_left_out", note, verbose, "cells", "A lake is left out: no river runs through it, or it covers no cell.",
         "Draw a river through it, or make grid.cell smaller."},
        {"lake_level", note, verbose, "m", "A lake has another level than the file sets.", ""},
        {"lake_outlets", note, verbose, "", "Rivers leave a lake besides its one outlet and are cut there.", ""},
        {"lakes_off_levels", warning, always, "", "Lakes do not have the levels that the file sets.",
         "Mend the levels in the file: a lake lies above what it drains to."},
        {"lakes_unseen", warning, always, "lakes", "Lakes with levels cover no cell of the grid.",
         "Make grid.cell smaller, or leave these lakes out."},
        {"shortened", note, verbose, "m", "The tip of a river stood above its surroundings and is cut.", ""},
        {"walled_cell", error, verbose, "m",
         "A river stands on a wall above the terrain beside it; the amount is its height.",
         "network.heights = \"graded\" lets rivers sink into the terrain."},
        // The recipe and its input, as plan and stages see them.
        {"close_points", warning, always, "1",
         "Points are nearly as dense as random points can be; the amount is their density.",
         "Set a smaller skeleton.spacing or skeleton.scatter."},
        {"coarse_like", warning, always, "m",
         "The DEM of surface.like has coarser cells than the grid, so that slopes and texture come out too gentle.",
         "Take a finer DEM, or a larger grid.cell."},
        {"converted", note, always, "", "Units or coordinates of an input file are converted.", ""},
        {"crowded_rivers", warning, always, "1", "River cells lie beside another river; the amount is their share.",
         "Make grid.cell smaller, or take a part of the rivers."},
        {"deep_cut", warning, always, "m", "A river is cut deeper into the DEM than surface.max_cut.",
         "If its water sinks there: --set network.inland=sink; else look whether river and DEM fit together."},
        {"degrees_as_metres", warning, always, "m", "Coordinates look like degrees, but count as metres.",
         "Assign the CRS in which they are: --source-crs EPSG:4326."},
        {"extended_rivers", warning, always, "m",
         "Many rivers end inside the grid and are extended far beyond the data.",
         "Set network.inland = \"coast\" if they end at the sea, \"sink\" if their water sinks in; give the outlines "
         "of lakes (surface.lakes)."},
        {"filled_heights", warning, always, "lines",
         "Lines lack heights and get some from the rest of their own and from the lines they meet.",
         "Give every vertex a height, or set network.heights."},
        {"gaps", note, always, "cells", "Cells without data in the DEM are no land.", ""},
        {"gentle_land", warning, always, "deg",
         "By its rivers the land is so gentle that they tell little of its slope.",
         "Set surface.mean_slope, or --like DEM."},
        {"given", note, always, "m",
         "How much of the length of the input rivers is in the network, and why the rest is not.", ""},
        {"grid", note, always, "m", "Size of the grid and its cells, and why.", ""},
        {"high_lake", warning, always, "m",
         "A lake's level raises a river that enters or leaves it above the DEM by more than surface.max_cut.",
         "Look whether its level is in metres above the same zero as the DEM."},
        {"high_terrain", warning, always, "m", "The terrain is higher than any on Earth.",
         "Set surface.mean_slope or surface.relief."},
        {"jumping_increment", warning, always, "m", "surface.increment jumps, which makes a scarp along every river.",
         "Use a continuous expression."},
        {"key_without_effect", warning, always, "", "A key of the recipe is not used in this case.", "Leave it out."},
        {"land_below_rivers", warning, always, "1",
         "Much of the land lies lower than the river nearest to it: rivers stand on walls.",
         "Set surface.mean_slope, or --like DEM."},
        {"heights_invented", note, always, "m^0.9",
         "Nothing says how high the land is: its heights follow from a usual slope, and from a usual steepness of "
         "rivers.",
         "surface.relief or surface.like (--like DEM) give it the heights of the place."},
        {"like", note, always, "1", "What the terrain takes from the DEM of surface.like.", ""},
        {"links_without_room", warning, always, "links", "Links of a grown network found no room.",
         "Make the grid larger, or network.tokunaga.spacing or order smaller."},
        {"placeholder_heights", warning, always, "vertices",
         "Heights of 0 beside higher ones, or of -9999 and less, count as missing.",
         "Remove these heights from the file, or write those that are meant."},
        {"points_off_grid", warning, always, "points", "Points lie off the grid and are left out.",
         "Make the grid larger, or leave them out of the file."},
        {"points_without_room", warning, always, "points", "Random points found no room.",
         "Set a smaller skeleton.spacing or skeleton.scatter."},
        {"rank_deficient", warning, always, "terms", "The points do not determine all terms of the regression.",
         "Give more points, or a lower degree."},
        {"resampled", note, always, "", "A DEM is resampled to the grid.", ""},
        {"rills", warning, always, "km2",
         "Half of the rivers begin where very little drains: they are rills, whose slope tells little of the land's.",
         "Set surface.mean_slope, or --like DEM."},
        {"rising_heights", warning, always, "m", "Heights in the file rise downstream and are lowered there.",
         "Mend them in the file if the rivers are drawn the right way."},
        {"rivers_in_sea", warning, always, "cells", "Rivers lie on both sides of coastlines, also where the sea is.",
         "Set network.lines.coastlines = \"none\" to leave the coastlines out."},
        {"small_grid", warning, always, "cells", "The grid is too small for the length that statistics.length sets.",
         "Make the grid larger, or the length smaller."},
        {"stretched", warning, always, "1", "Metres of the grid's reference system are not metres on the ground there.",
         "Name another system with --crs EPSG:N."},
        {"target_missed", warning, always, "", "The relief or mean slope that the recipe sets cannot be reached.",
         "Leave it out, or change what contradicts it."},
        {"texture_missed", warning, always, "1",
         "The texture of the DEM of surface.like cannot be reached by surface.roughness alone.", ""},
        {"below_lake", warning, always, "m",
         "Rivers end far below the lake that they reach, by the heights of the file, and are not led through it.",
         "Correct these heights, or set network.heights = \"graded\"."},
        {"lake_outflows", warning, always, "rivers",
         "Rivers leave a lake besides its outflow, and nothing but the drawn direction says so.",
         "Turn them round in the file if they flow into the lake."},
        {"lake_without_outflow", warning, always, "lakes", "Rivers end at the shore of lakes that none leaves.",
         "Draw the outflow to the shore; or set network.inland = \"sink\" if the water stays in the lake."},
        {"lake_without_outline", warning, always, "rivers",
         "Rivers end around a place where another one begins, as at a lake whose outline is not given.",
         "Give its outline: surface.lakes = FILE, or as a polygon in the river file; or draw the river through it."},
        {"unjoined_ends", warning, always, "rivers",
         "Rivers end close to another one, or to where one begins, without meeting it.",
         "Set network.lines.snap if they should meet, or draw what is missing."},
        {"gentle_layers", warning, always, "1",
         "No layer of rock at the surface may be as steep as the mean slope asked.",
         "Raise cliff of a layer, or lower surface.mean_slope."},
        {"held_back_slopes", warning, always, "cells",
         "Beds of rock climb to the greatest height that land in layers may have.",
         "Open the edge, let a river run there, or lower the dip."},
        {"thin_layers", warning, always, "layers", "Layers of rock are thinner than their beds rise over one cell.",
         "Make cells smaller, or the layers thicker."},
        {"unseen_layers", note, always, "layers", "Layers of rock of the recipe lie nowhere at the surface.",
         "Move strata.base, or change the relief."},
        {"walled_rivers", warning, always, "cells", "River cells stand on walls above the terrain.",
         "network.heights = \"graded\" lets rivers sink into the terrain."},
        // What the finished terrain says of its input.
        {"areas", note, always, "1", "How drained areas agree with those that the file gives.", ""},
        {"features", note, always, "m", "How the terrain meets the points and ridges of the recipe.", ""},
        {"heights", note, always, "m", "How dem.tif meets the heights of the file.", ""},
        {"heights_missed", warning, always, "m", "dem.tif differs from heights of the file.", ""},
        {"point_missed", error, verbose, "m", "The terrain misses the height of a point.", ""},
        {"points_missed", warning, always, "points", "The terrain misses heights of points.",
         "Remove points that contradict the rivers, or one another."},
        {"ridges_crossed", warning, always, "ridges", "Water crosses ridges of the recipe, or they lie at rivers.",
         "Move these ridges off the rivers."},
        {"rivers_missing", warning, always, "m", "Length of the input rivers is not in the network.",
         "Layer secondary of network.gpkg holds what is missing, and says why."},
        {"unusual_relief", warning, always, "",
         "The land has what real land has not: its texture, forms, canals or walls.", ""},
        // Faults of a network: check.
        {"bad_arc_id", error, verbose, "", "arc_id is below 1.", "Number the arcs from 1; check --fix does."},
        {"basin_mismatch", error, verbose, "", "basin_id differs within a basin, or is that of another one.",
         "check --fix computes it."},
        {"column_mismatch", error, verbose, "", "A column of an arc differs from what its line and the network say.",
         "check --fix computes it."},
        {"crossing", error, verbose, "", "Two arcs cross without a node; the amount is the other arc.",
         "check --fix makes a node there."},
        {"cycle", error, verbose, "arcs", "Arcs run in a circle.", "Reverse or remove one of them."},
        {"dangling_end", error, verbose, "m", "An end lies close to another arc without meeting it.",
         "check --fix --near D snaps it."},
        {"ds_arc_mismatch", error, verbose, "", "ds_arc is not the arc that begins where this one ends.",
         "check --fix computes it."},
        {"duplicate_arc_id", error, verbose, "arcs", "Several arcs have the same arc_id.",
         "Number the arcs; check --fix does."},
        {"duplicate_geometry", error, verbose, "", "Two arcs have the same line.", "check --fix removes one."},
        {"duplicate_node_id", error, verbose, "nodes", "Several nodes have the same node_id.",
         "check --fix makes nodes anew."},
        {"empty", error, verbose, "", "The file holds no arcs.", ""},
        {"end_mismatch", error, verbose, "m", "The end of an arc is not where its node is.",
         "check --fix puts it there."},
        {"isolated_node", error, verbose, "", "No arc begins or ends in a node.", "check --fix removes it."},
        {"missing_node", error, verbose, "", "An arc names a node that is not there.", "check --fix makes nodes anew."},
        {"nan", error, verbose, "vertices", "A vertex has a coordinate that is not a finite number.",
         "check --fix leaves it out."},
        {"no_outlet", error, verbose, "arcs", "A part of the network has no outlet.", ""},
        {"node_column_mismatch", error, verbose, "", "A column of a node differs from what the network says.",
         "check --fix computes it."},
        {"null_geometry", error, verbose, "", "An arc has no line, or a line of one vertex.",
         "check --fix draws it straight between its nodes, or leaves it out."},
        {"overlap", error, verbose, "m", "Two arcs lie on one another.", "check --fix makes one of them."},
        {"repeated_vertex", error, verbose, "vertices", "Consecutive vertices are the same.",
         "check --fix removes them."},
        {"self_touching", error, verbose, "places", "An arc touches or crosses itself.", "check --fix splits it."},
        {"several_outflows", error, verbose, "arcs", "Several arcs leave a node.",
         "check --fix keeps one of them in the network."},
        {"shreve_mismatch", error, verbose, "", "The Shreve magnitude is another.", "check --fix computes it."},
        {"spike", error, verbose, "", "An arc goes back along itself.", "check --fix removes the spike."},
        {"strahler_mismatch", error, verbose, "", "The Strahler order is another.", "check --fix computes it."},
        {"touches", error, verbose, "",
         "The end of an arc lies on another one without a common node; the amount is the other arc.",
         "check --fix makes a node there."},
        {"wrong_direction", error, verbose, "m", "An arc is drawn against the direction that its columns give.",
         "check --fix turns it."},
        {"z_rising", error, verbose, "m", "Heights of an arc rise downstream.", "check --fix lowers them."},
        {"zero_length", error, verbose, "", "An arc has no length.",
         "check --fix draws it straight between its nodes, or leaves it out."},
        // Copies that check --fix writes.
        {"areas_overlap", note, always, "arcs",
         "Inflows have more contributing area together than the arc into which they run.",
         "Right where rivers divide above; else an area is wrong."},
        {"area_raised", note, verbose, "m2", "A contributing area is raised to that of a larger inflow.",
         "Compare it with the file: one of the two is wrong."},
        {"drawn", note, verbose, "m", "An arc without a line is drawn straight between its nodes.", ""},
        {"mended", note, verbose, "", "Faults of one kind are repaired in the copy.", ""},
        {"level", note, verbose, "vertices", "Vertices without a height are interpolated between their neighbours.",
         ""},
        {"moved", note, verbose, "m", "An end is put onto its node.", ""},
        {"no_certificate", note, always, "", "Drainage on the DEM is not checked.", ""},
        {"not_honoured", note, always, "cells",
         "Cells of rivers lie where the DEM has other heights, and are not checked.", ""},
        {"not_mended", note, always, "", "No repaired copy is written.", ""},
        {"shortened_field", note, always, "", "A column has a shorter name in a Shapefile.", ""},
        // DEMs and meshes, as they are read.
        {"assumed_degrees", note, always, "", "Longitudes and latitudes without a CRS count as those of WGS 84.",
         "Write the CRS into the file (gdal_edit.py -a_srs) if it is another."},
        {"bands", note, always, "bands", "One of several bands or variables is used, by its name.",
         "Name another with --band."},
        {"cloud_classes", note, always, "points", "Points of these classes are read from a point cloud.",
         "--classes names others, where the command has that option."},
        {"cloud_thinned", note, always, "m",
         "A point cloud is thinned to one point in each cell; the amount is the side of the cells.",
         "--thin sets another side and --thin 0 keeps all points, where the command has that option."},
        {"cloud_unclassified", warning, always, "points",
         "No point of a point cloud is classified: roofs and trees count as terrain.",
         "Classify its ground (pdal ground IN.las OUT.las)."},
        {"dem_reprojected", note, always, "m", "A DEM is warped to square cells in metres; the amount is their side.",
         ""},
        {"depths", note, always, "", "Numbers that grow downwards are depths; heights are their negatives.", ""},
        {"doubtful_direction", warning, always, "",
         "Names and attributes of a file do not agree on whether its numbers grow upwards, or do not say it.",
         "Turn heights round if they are wrong (gdal_edit.py -scale -1)."},
        {"heightmap", note, always, "m", "Numbers of a heightmap become heights; the amount is the step between two.",
         "--raw-heights sets the heights of the lowest and the highest number."},
        {"heights_in_metres", note, always, "1",
         "Heights are converted to metres by this factor, or count as metres where nothing names their unit.", ""},
        {"named_nodata", note, always, "cells", "Cells of the value that --nodata names are no-data.", ""},
        {"nan_cells", note, always, "cells", "Cells are NaN and count as no-data.", ""},
        {"site_grid", note, always, "1",
         "A CRS of a site has no place on the Earth: coordinates are metres without a CRS; the amount is its unit.",
         ""},
        {"mesh_turned", note, always, "", "Y is up in a mesh, which is turned: -z is north, y the height.", ""},
        {"welded", note, always, "vertices", "Vertices of a mesh at one place are one.", ""},
        {"split_faces", note, always, "faces", "Faces with more than three corners are cut into triangles.", ""},
        {"transparent_cells", note, always, "cells", "Cells that the alpha band makes transparent are no-data.", ""},
        {"turned_raster", note, always, "m", "A raster is turned to north-up squares.", ""},
        {"unknown_unit", warning, always, "m", "A file names a unit of heights or coordinates that is none of length.",
         "Name the unit in the file (gdal_edit.py -units m), or scale the heights."},
        {"zero_heights", warning, always, "cells",
         "Cells of 0, or single ones of 32767 or 65535, lie far from all other heights.",
         "Add --nodata 0 if they are none, where the command has that option, or declare it (gdal_edit.py -a_nodata "
         "0)."},
        // Drainage on a DEM: the certificate.
        {"border_cell", note, verbose, "", "A river runs along the border of the DEM.", ""},
        {"depression", error, verbose, "m", "Water does not leave a depression.", "Fill or breach it: surface.drain."},
        {"outside_dem", note, verbose, "cells", "Cells of an arc have no height in the DEM.", ""},
        {"source_astray", error, verbose, "m", "Water from the source of an arc does not come to its outlet.", ""},
        {"water_leaves", error, verbose, "m", "Water leaves a river in this cell.",
         "Condition the DEM with this network: surface.drain = \"carve\"."},
        // Pictures, exports, measures of files.
        {"arcs_off_dem", note, always, "arcs", "Arcs leave the DEM or lie outside it.", ""},
        {"columns_left_out", note, always, "columns", "Columns of a table have nothing to draw.", ""},
        {"contact_sheet", note, always, "", "What the contact sheet shows, or why there is none.", ""},
        {"dry_lowland", note, always, "cells", "Cells below the level of the sea are enclosed by land and stay dry.",
         ""},
        {"flat", note, always, "", "The terrain is flat.", ""},
        {"heights_not_falling", note, always, "",
         "Heights of a file do not fall all the way; the rivers take those of the DEM.", ""},
        {"holes", note, always, "cells", "Cells have no data.", ""},
        {"level_sea", note, always, "m", "The sea lies level in the export.", ""},
        {"low_relief", note, always, "mm", "The relief of the print is low.", "Set a larger --exaggeration."},
        {"no_catchment", note, always, "arcs", "Arcs have no catchment: other arcs own their cells.", ""},
        {"no_rivers", note, always, "", "There are no rivers to draw or export.", ""},
        {"off_dem", note, always, "points", "Points of rivers lie outside the DEM.", ""},
        {"print_size", note, always, "mm", "Scale and size of the print.", ""},
        {"reduced", note, always, "cells", "A raster is reduced to fewer cells or samples.",
         "--size sets another size."},
        {"renumbered", note, always, "", "Arcs are numbered from 1; the file numbers them otherwise.", ""},
        {"rim", note, always, "cells", "Cells without data along the border are cut off or filled.",
         "--rim chooses: cut, nearest, minimum or sea."},
        {"sea_of_dem", note, always, "cells", "Cells of a DEM lie under the sea, by --sea-level.", ""},
        {"some_rivers", note, always, "",
         "The page holds the rivers from this Strahler order on; the amount is the order.", ""},
        {"water_without_river", note, always, "cells", "Water of cells leaves the DEM before it meets a river.", ""},
        {"zoom_levels", note, always, "", "Zoom levels end before every cell is shown; the amount is the last level.",
         ""},
        // Ensembles.
        {"members_failed", warning, always, "members", "Members of an ensemble failed, or a check of theirs.",
         "Column reason of table.csv says why; the same command tries failed members again."},
        {"members_warned", warning, always, "members", "Members of an ensemble have warnings.",
         "Column warnings of table.csv counts them; make of one member prints them."},
        {"rows_damaged", warning, always, "rows", "Rows of an ensemble's journals are damaged.",
         "Nothing to do: the members are made again. Rows of an older version of thalweg count as damaged too."},
        {"share_in_use", warning, always, "", "Another process works on the same share of an ensemble.",
         "Give each process a share of its own."},
    });
    std::ranges::sort(rows, {}, &FindingRow::kind);
    return rows;
}();

/// The kind of a finding: one of finding_rows. A literal that is not one does not compile.
class FindingKind {
public:
    consteval FindingKind(char const* kind) : row_(find(kind)) { // implicit: {"crossing", feature, ...}
        if (row_ == nullptr) {
            throw "finding_rows has no such kind";
        }
    }

    /// \return the kind of this name; throws BadParameter when there is none
    static FindingKind named(std::string_view kind);

    constexpr FindingRow const& row() const { return *row_; }
    constexpr std::string_view name() const { return row_->kind; }
    constexpr operator std::string_view() const { return name(); }
    operator std::string() const { return std::string(name()); }
    friend constexpr bool operator==(FindingKind const& a, std::string_view b) { return a.name() == b; }
    template <std::same_as<FindingKind> Kind> friend constexpr bool operator==(FindingKind const& a, Kind const& b) {
        return a.row_ == b.row_;
    }
    friend constexpr bool operator<(FindingKind const& a, FindingKind const& b) { return a.name() < b.name(); }

private:
    explicit constexpr FindingKind(FindingRow const* row) : row_(row) {}

    static constexpr FindingRow const* find(std::string_view kind) {
        auto const* const row = std::ranges::lower_bound(finding_rows, kind, {}, &FindingRow::kind);
        return row != finding_rows.end() && row->kind == kind ? row : nullptr;
    }

    FindingRow const* row_;
};

} // namespace thalweg
