// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/network/read_rivers.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include <cpl_vsi.h>
#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/run/messages.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/crs/internal/into_metres.hpp>
#include <thalweg/io/crs/internal/units.hpp>
#include <thalweg/io/network/internal/read_network.hpp>
#include <thalweg/io/raster/polygons.hpp>

namespace thalweg::io {

namespace {

/// The rings of polygons as lines; null for other shapes.
std::unique_ptr<OGRGeometry> rings_of(OGRGeometry const& shape) {
    auto const flat = wkbFlatten(shape.getGeometryType());
    bool const is_area = OGR_GT_IsSubClassOf(flat, wkbSurface) != 0 || OGR_GT_IsSubClassOf(flat, wkbMultiSurface) != 0;
    if (!is_area) {
        return nullptr;
    }
    std::unique_ptr<OGRGeometry> const straight(shape.getLinearGeometry());
    auto rings = std::make_unique<OGRMultiLineString>();
    auto const add = [&](OGRGeometry const& part) {
        if (wkbFlatten(part.getGeometryType()) == wkbPolygon) {
            for (auto const* const ring : *part.toPolygon()) {
                OGRLineString line(*ring);
                rings->addGeometry(&line);
            }
        }
    };
    if (OGR_GT_IsSubClassOf(wkbFlatten(straight->getGeometryType()), wkbGeometryCollection) != 0) {
        for (auto const* const part : *straight->toGeometryCollection()) {
            add(*part);
        }
    } else {
        add(*straight);
    }
    return rings;
}

// The columns that a user may name, and the features of a layer as lines.
class LineReader {
public:
    LineReader(OGRLayer& layer, ReadRiversParams const& params, std::string const& name)
        : layer_(layer), name_(name), filter_(params.filter), rings_(params.rings),
          type_(column(params.type_field, "rosgen")), lambda_(column(params.lambda_field, "lambda")),
          height_(column(params.height_field)), fields_(layer),
          flow_(layer, {.id = column(params.id_field),
                        .down = column(params.down_field),
                        .from_node = column(params.from_field),
                        .to_node = column(params.to_field),
                        .direction = column(params.direction_field),
                        .rank = number_column(params.rank_field)}),
          natural_(layer), lake_(layer), attributes_(layer) {
        refuse_if<BadInput>(height_.is_there() && !height_.is_number(), "io.read_rivers",
                            "field {} of {} is not a number field: it holds no heights", params.height_field, name);
        if (!params.where.empty()) {
            where_ = std::make_unique<OGRFeatureQuery>();
            refuse_if<BadInput>(where_->Compile(&layer, params.where.c_str(), TRUE, nullptr) != OGRERR_NONE,
                                "io.read_rivers",
                                "network.lines.where = \"{}\" is no condition on fields of {}: {} ({})", params.where,
                                name, CPLGetLastErrorMsg(), listed(field_names(layer)));
        }
    }

    struct NotNatural {
        RiverLine line;
        Unnatural why;
    };

    void read(Run const& run) {
        for (auto const& feature : layer_) {
            run.check();
            if (where_ == nullptr || where_->Evaluate(feature.get()) != 0) {
                add(*feature);
            } else {
                pass(*feature);
            }
        }
        flow_.tell(lines);
        if (raised_ > 0) {
            findings.push_back({.kind = "heights_of_fields",
                                .amount = static_cast<double>(raised_),
                                .text = fmt::format("heights of {} lines come from their fields {}, linear in between",
                                                    raised_, flow_.names_of_heights())});
        }
        if (!flow_.has_any()) {
            std::vector<Finding> const unused = unused_fields(lines, attributes_.table());
            findings.insert(findings.end(), unused.begin(), unused.end());
        }
        for (std::vector<Finding> const& more : {shapes_.findings(), attributes_.findings()}) {
            findings.insert(findings.begin(), more.begin(), more.end());
        }
    }
    AttributeTable attributes() { return attributes_.take(); }
    /// By feature, once all are read: the one downstream.
    std::map<std::int64_t, std::int64_t> downs() const { return flow_.downs(); }
    std::string const& rank_name() const { return flow_.rank_name(); }

    std::vector<RiverLine> lines; ///< in coordinates of the layer
    std::vector<NotNatural> others;
    std::vector<Polygon> lakes;
    std::vector<Finding> findings;

private:
    /// The values of a key among the tags, where a feature has one.
    FileColumn column_of_tags(std::string const& key) const {
        FileColumn tags = FileColumn::of_tags(layer_, key);
        if (!tags.is_there()) {
            return tags;
        }
        bool found = false;
        layer_.ResetReading();
        for (OGRFeatureUniquePtr feature(layer_.GetNextFeature()); feature && !found;
             feature.reset(layer_.GetNextFeature())) {
            found = !tags.is_null(*feature);
        }
        layer_.ResetReading();
        return found ? tags : FileColumn();
    }

    // A column that may be missing when it has its default name.
    FileColumn column(std::string const& field, std::string const& by_default = "") const {
        FileColumn found = field.empty() ? FileColumn() : FileColumn(layer_, {field});
        if (!field.empty() && !found.is_there()) {
            found = column_of_tags(field);
        }
        if (!field.empty() && !found.is_there() && field != by_default) {
            auto const names = field_names(layer_);
            throw BadInput("io.read_rivers", fmt::format("layer {} of {} has no field '{}'.{} ({})", layer_.GetName(),
                                                         name_, field, did_you_mean(field, names), listed(names)));
        }
        return found;
    }

    FileColumn number_column(std::string const& field) const {
        FileColumn found = column(field);
        refuse_if<BadInput>(found.is_there() && !found.is_number(), "io.read_rivers",
                            "field {} of {} is not a number field: it cannot rank rivers", field, name_);
        return found;
    }

    // Features keep their numbers and records in the layer.
    void pass(OGRFeature const& feature) {
        ++number_;
        attributes_.read(feature);
    }

    void add(OGRFeature const& feature) {
        RiverLine line;
        line.feature = ++number_;
        line.type = type_.text(feature);
        fields_.read(feature, line);
        flow_.read(feature, number_);
        attributes_.read(feature);
        if (!rings_ && lake_.take(feature, number_, lakes)) {
            return;
        }
        Unnatural const why = filter_ == LineFilter::natural ? natural_.of(feature) : Unnatural();
        OGRGeometry const* const drawn = feature.GetGeometryRef();
        std::int64_t const other_shapes = shapes_.count();
        std::vector<RiverLine> parts;
        if (drawn != nullptr && drawn->IsEmpty() == 0) {
            std::unique_ptr<OGRGeometry> const outline(rings_ ? rings_of(*drawn) : nullptr);
            parts = lines_of(outline ? *outline : *drawn, line);
        }
        if (height_.is_there()) {
            for (RiverLine& part : parts) {
                std::ranges::for_each(part.vertices, [&](Vec3& v) { v.z = height_.real(feature); });
            }
        }
        raised_ += parts.size() == 1 && flow_.raise(feature, parts.front().vertices) ? 1 : 0;
        if (parts.empty() && shapes_.count() == other_shapes) {
            findings.push_back(left_out(drawn));
        }
        for (RiverLine& part : parts) {
            part.lambda = lambda_of(feature, parts.front());
            if (why.reason.empty()) {
                lines.push_back(std::move(part));
            } else {
                others.push_back({std::move(part), why});
            }
        }
    }

    int lambda_of(OGRFeature const& feature, RiverLine const& line) const {
        if (lambda_.is_null(feature)) {
            return 0;
        }
        double const value = lambda_.real(feature);
        refuse_if<BadInput>(!(value >= 1.0 && value <= 50.0) || value != std::floor(value), "io.read_rivers",
                            "feature {} of {}, which begins at ({}, {}), has the {} '{}': a whole number from 1 to 50 "
                            "is required, or none",
                            number_, name_, line.vertices.front().x, line.vertices.front().y, lambda_.name(),
                            lambda_.text(feature));
        return static_cast<int>(value);
    }

    // A line for each part of some length.
    std::vector<RiverLine> lines_of(OGRGeometry const& shape, RiverLine const& feature) {
        std::vector<RiverLine> found;
        for (std::vector<Vec3>& part : parts_of(shape, number_, shapes_)) {
            for (std::size_t i = 0; i < part.size(); ++i) {
                Vec3 const& v = part[i];
                refuse_if<BadInput>(!is_finite(in_plan(v)) || std::isinf(v.z), "io.read_rivers",
                                    "vertex {} of feature {} of {} is not finite: ({}, {}, {}); correct the file",
                                    i + 1, number_, name_, v.x, v.y, v.z);
            }
            if (std::ranges::any_of(part, [&](Vec3 const& v) { return in_plan(v) != in_plan(part.front()); })) {
                found.push_back(feature);
                found.back().vertices = std::move(part);
            }
        }
        return found;
    }

    // A feature that holds no line.
    Finding left_out(OGRGeometry const* drawn) const {
        OGREnvelope box;
        if (drawn != nullptr && drawn->IsEmpty() == 0) {
            drawn->getEnvelope(&box);
        }
        return {"left_out", number_, box.IsInit() != 0 ? Vec2{box.MinX, box.MinY} : nowhere, 0.0,
                fmt::format("feature {} {}; it is left out", number_,
                            drawn == nullptr ? "has no geometry" : "has no line of any length")};
    }

    OGRLayer& layer_;
    std::string const& name_;
    LineFilter filter_;
    bool rings_;
    std::unique_ptr<OGRFeatureQuery> where_;
    FileColumn type_;
    FileColumn lambda_;
    FileColumn height_;
    RiverFields fields_;
    FlowFields flow_;
    NaturalFilter natural_;
    LakeFilter lake_;
    AttributeReader attributes_;
    OtherShapes shapes_;
    std::int64_t number_ = 0; ///< of the feature in hand, from 1
    std::int64_t raised_ = 0; ///< lines whose heights come from fields
};

void require_any(LineReader const& read, About const& about, std::string const& where) {
    if (!read.lines.empty()) {
        return;
    }
    if (!read.others.empty()) {
        throw BadInput(about.where, fmt::format("{} holds no natural watercourse: {} lines are left out, the first of "
                                                "them for {}; set network.lines.filter = \"none\" to take them all",
                                                about.name, read.others.size(), read.others.front().why.reason));
    }
    auto const why = std::ranges::find_if(read.findings, [](Finding const& f) {
        return f.kind == FindingKind("not_a_line") || f.kind == FindingKind("left_out");
    });
    refuse_if<BadInput>(!where.empty() && why == read.findings.end(), about.where,
                        "{}: no feature meets network.lines.where = \"{}\"", about.name, where);
    throw BadInput(about.where, why == read.findings.end()
                                    ? about.name + " is empty"
                                    : fmt::format("{} holds no line: {}", about.name, why->text));
}

/// Brings a line into metres.
struct Bring {
    IntoMetres const& metres;
    double height_unit;
    std::string const& name;
    Driver const& driver;

    void operator()(RiverLine& line) const {
        auto const done = metres.apply(line.vertices);
        for (std::size_t i = 0; i < done.size(); ++i) {
            Vec3& v = line.vertices[i];
            if (done[i] == 0) {
                throw BadInput("io.read_rivers",
                               fmt::format("vertex {} of feature {} of {}, ({}, {}), cannot be reprojected to {}: {}",
                                           i + 1, line.feature, name, v.x, v.y, metres.crs(), driver.take()));
            }
            v = {rounded(v.x), rounded(v.y), height_unit * v.z};
        }
    }
    void operator()(Finding& finding) const {
        Vec3 at{finding.where.x, finding.where.y, 0.0};
        bool const has_place = is_finite(finding.where);
        finding.where = has_place && metres.apply({&at, 1}).front() != 0 ? in_plan(at) : nowhere;
    }
};

struct HeightsOfLines {
    bool complete = true;
    bool differ = false;
    double first_m = nan;
};

HeightsOfLines heights_of(std::vector<RiverLine> const& lines) {
    HeightsOfLines heights{.first_m = lines.front().vertices.front().z};
    for (RiverLine const& line : lines) {
        for (Vec3 const& v : line.vertices) {
            heights.complete = heights.complete && !std::isnan(v.z);
            heights.differ = heights.differ || v.z != heights.first_m;
        }
    }
    return heights;
}

void require_halves(ReadRiversParams const& params) {
    refuse_if<BadParameter>(params.id_field.empty() != params.down_field.empty(), "io.read_rivers",
                            "the field '{}' is named without its other half: links need the field of a line's id and "
                            "that of the id downstream",
                            params.id_field.empty() ? params.down_field : params.id_field);
    refuse_if<BadParameter>(params.from_field.empty() != params.to_field.empty(), "io.read_rivers",
                            "the field '{}' is named without its other half: nodes need the field of that from which "
                            "water comes and that of the one to which it goes",
                            params.from_field.empty() ? params.to_field : params.from_field);
}

/// The lakes of a file's other layers. Of OpenStreetMap one layer is read at a time.
std::vector<Polygon> other_lakes(ReadRiversParams const& params, GDALDataset& data, std::vector<OGRLayer*> const& read,
                                 IntoMetres const& metres, OGRSpatialReference const& own, Run const& run) {
    if (!is_osm_file(data)) {
        return lakes_of_layers(data, read, metres, own, run);
    }
    Dataset const again = open_unchanged(params.path, GDAL_OF_VECTOR);
    if (!again) {
        return {};
    }
    read_osm_layer(*again, "multipolygons");
    return lakes_of_layers(*again, {}, metres, own, run);
}

} // namespace

RiverLines read_rivers(ReadRiversParams const& params, Run const& run) {
    require_halves(params);
    std::string const& path = params.path.name();
    Driver const driver;
    RiverLines rivers;
    rivers.name = std::filesystem::path(path).filename().string();
    Dataset const data = open_unchanged(params.path, GDAL_OF_VECTOR);
    if (!data) {
        auto const words = driver.take();
        VSIStatBufL status;
        refuse_if<BadInput>(path.empty() || VSIStatL(path.c_str(), &status) != 0, "io.read_rivers",
                            "there is no file '{}'{}", path, words.empty() ? "" : " (" + words + ")");
        refuse_folder(path, {"io.read_rivers", path});
        throw BadInput("io.read_rivers", fmt::format("{} is not a vector file that GDAL can read ({})", path, words));
    }
    forget_archive(path, driver);
    std::vector<OGRLayer*> const layers = params.rings && params.layer.empty()
                                              ? layers_of_areas(*data, {"io.read_rivers", rivers.name})
                                              : rivers_layers(*data, params.layer, {"io.read_rivers", rivers.name});
    ChosenLayer const chosen = as_one(layers, {"io.read_rivers", rivers.name});
    OGRLayer& layer = *chosen.layer;
    About const about{"io.read_rivers", fmt::format("layer {} of {}", chosen.name, rivers.name)};
    LineReader read(layer, params, rivers.name);
    read.read(run);
    driver.check("io.read_rivers", path);
    if (params.may_be_empty && read.lines.empty() && read.others.empty() && read.findings.empty()) {
        rivers.crs = params.crs;
        return rivers;
    }
    require_any(read, about, params.where);
    std::string const source_crs = params.source_crs.value_or("");
    OGRSpatialReference const own = crs_of_layer(layer.GetSpatialRef(), source_crs);
    refuse_if<BadInput>(own.IsEmpty() != 0, about.where, "{} has no CRS; assign one (ogr2ogr -a_srs EPSG:n){}",
                        about.name, params.source_crs ? " or name it (--source-crs EPSG:n)" : "");
    FilePlaces places;
    for (auto const& line : read.lines) {
        for (auto const& v : line.vertices) {
            places.add(v.x, v.y);
        }
    }
    IntoMetres const metres(own, params.crs, places.box(), rivers.name);
    if (auto const doubt = degrees_as_metres(own, places.box(), rivers.name)) {
        read.findings.push_back(*doubt);
    }
    Bring const bring{metres, height_unit_of(layer, source_crs), rivers.name, driver};
    for (auto& line : read.lines) {
        run.check();
        bring(line);
    }
    auto const downs = read.downs();
    for (auto& [line, why] : read.others) {
        run.check();
        bring(line);
        if (why.is_channel && !why.is_coast) {
            line.down = downs.contains(line.feature) ? downs.at(line.feature) : 0;
            line.artificial = std::move(why.reason);
            rivers.channels.push_back(std::move(line));
        } else {
            rivers.secondary.push_back({line.feature, std::move(line.vertices), std::move(why.reason), line.feature,
                                        why.is_coast ? LeftOut::coast : LeftOut::filter});
        }
    }
    for (Finding& finding : read.findings) {
        bring(finding);
    }
    rivers.lines = std::move(read.lines);
    rivers.findings = std::move(read.findings);
    if (params.layer.empty()) {
        std::vector<Finding> const others =
            layers_not_read(*data, layers, metres.crs(), source_crs, {about.where, rivers.name});
        rivers.findings.insert(rivers.findings.end(), others.begin(), others.end());
    }
    rivers.lakes = into_metres(std::move(read.lakes), metres);
    for (Polygon& lake : other_lakes(params, *data, layers, metres, own, run)) {
        rivers.lakes.push_back(std::move(lake));
    }
    drop_surroundings(rivers.lakes, rivers.lines, rivers.findings);
    rivers.lakes = united(std::move(rivers.lakes), gap_between_sheets_m);
    rivers.attributes = read.attributes();
    rivers.rank_field = read.rank_name();
    rivers.crs = metres.crs();
    HeightsOfLines const heights = heights_of(rivers.lines);
    rivers.has_z = heights.complete && heights.differ;
    if (heights.complete && !heights.differ && heights.first_m != 0.0) {
        rivers.findings.push_back(
            {.kind = "same_heights",
             .amount = heights.first_m,
             .text = fmt::format("all heights of {} are {} m: they count as none", rivers.name, heights.first_m)});
    }
    return rivers;
}

} // namespace thalweg::io
