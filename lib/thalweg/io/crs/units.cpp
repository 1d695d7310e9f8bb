// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/crs/internal/units.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/crs/internal/into_metres.hpp>
#include <thalweg/io/files/internal/files.hpp>
#include <thalweg/io/gdal/driver.hpp>

namespace thalweg::io {
namespace {

constexpr double us_survey_foot_m = 1200.0 / 3937.0;

constexpr double foot_m = 0.3048;

double vertical_unit(OGRSpatialReference const* reference) {
    return has_vertical_unit(reference) ? reference->GetTargetLinearUnits("VERT_CS") : 1.0;
}

} // namespace

std::optional<double> unit_named(std::string_view name) {
    static constexpr std::array<std::pair<std::string_view, double>, 43> names{{
        {"m", 1.0},
        {"metre", 1.0},
        {"meter", 1.0},
        {"km", 1000.0},
        {"kilometre", 1000.0},
        {"kilometer", 1000.0},
        {"dm", 0.1},
        {"decimetre", 0.1},
        {"decimeter", 0.1},
        {"cm", 0.01},
        {"centimetre", 0.01},
        {"centimeter", 0.01},
        {"mm", 0.001},
        {"millimetre", 0.001},
        {"millimeter", 0.001},
        {"ft", foot_m},
        {"foot", foot_m},
        {"feet", foot_m},
        {"internationalfoot", foot_m},
        {"internationalfeet", foot_m},
        {"footinternational", foot_m},
        {"ftintl", foot_m},
        {"ftus", us_survey_foot_m},
        {"usft", us_survey_foot_m},
        {"usfoot", us_survey_foot_m},
        {"usfeet", us_survey_foot_m},
        {"footus", us_survey_foot_m},
        {"feetus", us_survey_foot_m},
        {"ussurveyfoot", us_survey_foot_m},
        {"ussurveyfeet", us_survey_foot_m},
        {"ussurveyft", us_survey_foot_m},
        {"surveyfoot", us_survey_foot_m},
        {"surveyfeet", us_survey_foot_m},
        {"footsurveyus", us_survey_foot_m},
        {"yd", 0.9144},
        {"yds", 0.9144},
        {"yard", 0.9144},
        {"in", 0.0254},
        {"inch", 0.0254},
        {"inches", 0.0254},
        {"fathom", 1.8288},
        {"ftm", 1.8288},
        {"fm", 1.8288},
    }};
    auto const length_of = [](std::string_view wanted) -> std::optional<double> {
        auto const at = std::ranges::find(names, wanted, [](auto const& row) { return row.first; });
        return at == names.end() ? std::nullopt : std::optional(at->second);
    };
    std::string const own = simple_name(name);
    constexpr std::size_t shortest_word = 5; // "yards"; "ms" is none
    bool const is_plural = own.size() >= shortest_word && own.back() == 's';
    auto const found = length_of(own);
    return found || !is_plural ? found : length_of(own.substr(0, own.size() - 1));
}

std::string words_for_unit(double metres) {
    auto const is = [metres](double unit) { return std::fabs(metres - unit) < 1e-9; };
    return is(1.0)                ? "metres"
           : is(1000.0)           ? "kilometres"
           : is(1.8288)           ? "fathoms"
           : is(us_survey_foot_m) ? "US survey feet"
           : is(foot_m)           ? "feet"
                                  : fmt::format("units of {:.10g} m", metres);
}

bool has_vertical_unit(OGRSpatialReference const* reference) {
    return reference != nullptr && reference->IsEmpty() == 0 && reference->IsCompound() != 0;
}

double height_unit_of(OGRLayer& layer, std::string const& source_crs) {
    int const field = layer.GetLayerDefn()->GetFieldIndex("z_unit");
    if (field < 0 || layer.GetLayerDefn()->GetFieldDefn(field)->GetType() != OFTString) {
        OGRSpatialReference const reference = crs_of_layer(layer.GetSpatialRef(), source_crs);
        return vertical_unit(&reference);
    }
    Driver const driver;
    layer.ResetReading();
    OGRFeatureUniquePtr const first(layer.GetNextFeature());
    layer.ResetReading();
    driver.check("io.height_unit_of", fmt::format("layer {}", layer.GetName()));
    std::string const name = first && first->IsFieldSetAndNotNull(field) != 0 ? first->GetFieldAsString(field) : "m";
    auto const unit = unit_named(name);
    if (!unit) {
        throw BadInput("io.height_unit_of",
                       fmt::format("layer {}: the field z_unit holds '{}', which is not a unit of length (m, ft)",
                                   layer.GetName(), name));
    }
    return *unit;
}

} // namespace thalweg::io
