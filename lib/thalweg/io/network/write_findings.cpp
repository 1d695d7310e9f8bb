// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/network/write_findings.hpp>

#include <cmath>

#include <thalweg/io/network/table.hpp>

namespace thalweg::io {

void write_findings(std::vector<Finding> const& findings, std::string const& crs, std::string const& path,
                    Run const& run) {
    auto const at = [&](std::size_t row) -> Finding const& { return findings[row]; };
    auto const finite = [](double value) { return std::isfinite(value) ? value : 0.0; };
    Table table{"findings", Table::Shape::point, findings.size(), {}, {}};
    table.shape_at = [=](std::size_t row) {
        return std::vector<Vec3>{{finite(at(row).where.x), finite(at(row).where.y), 0.0}};
    };
    table.columns = {{"kind", Column::Kind::text, 0, [=](std::size_t row) { return at(row).kind; }},
                     {"feature", Column::Kind::wide_integer, 0, [=](std::size_t row) { return at(row).feature; }},
                     {"amount", Column::Kind::real, 0, [=](std::size_t row) { return finite(at(row).amount); }},
                     {"text", Column::Kind::text, 0, [=](std::size_t row) { return at(row).text; }}};
    write_tables({table}, crs, path, run);
}

} // namespace thalweg::io
