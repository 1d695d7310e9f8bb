// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/commands/check_files.hpp>
#include <thalweg/pipeline/report/internal/report.hpp>
#include <thalweg/pipeline/report/report.hpp>

#include <nlohmann/json.hpp>

namespace thalweg::pipeline {

std::string as_json(CheckedFiles const& checked) {
    using nlohmann::ordered_json;
    ordered_json out{{"ok", checked.ok()},
                     {"arcs", checked.arcs},
                     {"nodes", checked.nodes},
                     {"schema", checked.schema},
                     {"checks", ordered_json::parse(checks_json(checked.checks))},
                     {"findings", ordered_json::parse(findings_json(checked.findings))},
                     {"notes", ordered_json::parse(findings_json(checked.notes))},
                     {"mended", ordered_json::parse(findings_json(checked.mended))},
                     {"written", checked.written}};
    if (checked.certificate) {
        out["certificate"] = ordered_json::parse(certificate_json(*checked.certificate));
    }
    return out.dump(-1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

} // namespace thalweg::pipeline
