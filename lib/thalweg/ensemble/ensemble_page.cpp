// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/numbers/ranks.hpp>
#include <thalweg/ensemble/internal/ensemble_page.hpp>
#include <thalweg/io/gdal/packed.hpp>
#include <thalweg/report/page.hpp>

namespace thalweg::ensemble {
namespace {

// The policy names the hash of this text, which a test computes again.
constexpr std::string_view ensemble_style = R"(
:root { color-scheme: light; --ink: #23262a; --faint: #5b6168; --rule: #d9d8d2; --bad: #b4541a; }
* { box-sizing: border-box; }
body { max-width: 1440px; margin: 0 auto; padding: 24px 28px 48px; overflow-x: clip; background: #fff; color: var(--ink);
  font: 14px/1.45 system-ui, 'Segoe UI', Roboto, 'DejaVu Sans', 'Noto Sans CJK SC', sans-serif; }
h1 { font-size: 24px; line-height: 1.25; margin: 0 0 4px; overflow-wrap: anywhere; }
h2 { font-size: 18px; margin: 36px 0 4px; border-bottom: 1px solid var(--rule); padding-bottom: 4px; }
h3 { font-size: 15px; margin: 20px 0 4px; }
p { margin: 4px 0; max-width: 100ch; }
.faint { color: var(--faint); }
nav a { margin-right: 16px; }
a { color: #1b5793; }
figure { margin: 8px 0 0; }
img { display: block; max-width: 100%; height: auto; }
svg { display: block; width: 103%; height: auto; margin: 0 -1.5%; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: 13px; margin-top: 8px; }
th, td { padding: 3px 10px; text-align: right; border-bottom: 1px solid var(--rule); white-space: nowrap; }
th { font-weight: 600; vertical-align: bottom; }
th:first-child, td.words { text-align: left; }
td.words { white-space: normal; overflow-wrap: anywhere; }
tbody th { font-weight: 400; white-space: normal; min-width: 24ch; }
tbody th[colspan] { font-weight: 700; padding-top: 14px; }
td.few { color: var(--bad); font-weight: 600; }
code { font: 13px ui-monospace, 'DejaVu Sans Mono', monospace; overflow-wrap: anywhere; }
@media print {
  body { max-width: none; padding: 0; font-size: 9pt; }
  nav { display: none; }
  figure, tr { break-inside: avoid; }
  h2, h3 { break-after: avoid; }
  table { font-size: 7pt; }
  th, td { padding: 1px 4px; }
  * { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
}
)";
constexpr std::string_view style_hash = "sha256-rojgUj+PiAvFKOVgYTprd/3BQPDGi+Yp2bGVkDzPhZw=";

constexpr std::size_t most_listed = 1000; // members in the list of failures
constexpr double few_inside = 0.5;        // below this share inside a range a number stands out

/// A number with four significant digits, without an exponent below a thousand million.
std::string page_number(double value) {
    if (std::isnan(value)) {
        return "";
    }
    double const size = std::fabs(value);
    if (size >= 1e9 || (size > 0.0 && size < 1e-6)) {
        return fmt::format("{:.3e}", value);
    }
    int decimals = size > 0.0 ? 9 : 0;
    for (double limit = 1e-5; decimals > 0 && size >= limit; limit *= 10.0) {
        --decimals;
    }
    std::string text = fmt::format("{:.{}f}", value, decimals);
    if (text.find('.') != std::string::npos) {
        text.erase(text.find_last_not_of('0') + 1);
        text.erase(text.find_last_not_of('.') + 1);
    }
    if (text == "-0") {
        return "0";
    }
    return text.starts_with('-') ? "\u2212" + text.substr(1) : text;
}

/// A picture of Cairo for a page: its styles become attributes, which the policy allows, and its ids begin with a word
/// of their own, since those of all pictures on a page share their names.
std::string svg_on_page(std::string const& svg, std::string const& label, std::string const& ids) {
    constexpr std::string_view style = "style=\"";
    constexpr std::array<std::string_view, 3> references = {" id=\"", "href=\"#", "url(#"};
    std::string out = fmt::format(R"(<svg role="img" aria-label="{}")", report::html_text(label));
    std::size_t i = svg.find("<svg");
    i = i == std::string::npos ? svg.size() : i + 4;
    while (i < svg.size()) {
        std::string_view const rest = std::string_view(svg).substr(i);
        if (rest.starts_with(style)) {
            std::size_t const end = std::min(rest.find('"', style.size()), rest.size());
            std::string_view rules = rest.substr(style.size(), end - style.size());
            while (!rules.empty()) {
                std::size_t const stop = std::min(rules.find(';'), rules.size());
                std::string_view const rule = rules.substr(0, stop);
                std::size_t const colon = rule.find(':');
                if (colon != std::string_view::npos) {
                    std::size_t const name = std::min(rule.find_first_not_of(' '), colon);
                    std::string value =
                        fmt::format(" {}=\"{}\"", rule.substr(name, colon - name), rule.substr(colon + 1));
                    for (std::size_t at = value.find("url(#"); at != std::string::npos;
                         at = value.find("url(#", at + 6)) {
                        value.insert(at + 5, ids);
                    }
                    out += value;
                }
                rules.remove_prefix(std::min(stop + 1, rules.size()));
            }
            i += std::min(end + 1, rest.size());
            continue;
        }
        auto const reference = std::find_if(references.begin(), references.end(),
                                            [&](std::string_view mark) { return rest.starts_with(mark); });
        if (reference != references.end()) {
            out += *reference;
            out += ids;
            i += reference->size();
            continue;
        }
        out += svg[i++];
    }
    return out;
}

/// The indices of each group, in order.
std::vector<std::vector<draw::Distribution>> groups_of(std::vector<draw::Distribution> const& indices) {
    std::vector<std::vector<draw::Distribution>> groups;
    for (draw::Distribution const& index : indices) {
        if (groups.empty() || groups.back().front().group != index.group) {
            groups.emplace_back();
        }
        groups.back().push_back(index);
    }
    return groups;
}

std::vector<draw::Distribution> without_group(std::vector<draw::Distribution> indices) {
    for (draw::Distribution& index : indices) {
        index.group.clear();
    }
    return indices;
}

std::string with_unit(draw::Distribution const& index) {
    return report::html_text(index.name) +
           (index.unit.empty() ? "" : fmt::format(" <span class=\"faint\">[{}]</span>", report::html_text(index.unit)));
}

std::vector<DrawnKey> numbers_of(std::vector<DrawnKey> keys) {
    std::erase_if(keys, [](DrawnKey const& key) { return !key.words.empty(); });
    return keys;
}

std::string table_row(draw::Distribution const& index, EnsembleView const& view) {
    draw::DistributionCounts const counts = draw::counts_of(index);
    std::string row = fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td>", with_unit(index), counts.known);
    for (double const share : {0.0, 0.05, 0.5, 0.95, 1.0}) {
        row += fmt::format("<td>{}</td>", page_number(quantile(index.values, share)));
    }
    if (counts.inside) {
        auto const known = static_cast<double>(std::max<std::int64_t>(counts.known, 1));
        double const share = static_cast<double>(*counts.inside) / known;
        row += fmt::format("<td>{} to {}</td><td{}>{}&nbsp;%</td>", page_number(*index.low), page_number(*index.high),
                           share < few_inside ? " class=\"few\"" : "", std::floor(share * 100.0 + 0.5));
    } else {
        row += "<td></td><td></td>";
    }
    for (DrawnKey const& key : numbers_of(view.parameters)) {
        double const rank = rank_correlation(key.values.values, index.values);
        std::string const text = std::isnan(rank) ? "" : fmt::format("{:.2f}", std::fabs(rank));
        row += fmt::format("<td>{}{}</td>", rank < 0.0 && text != "0.00" ? "\u2212" : "", text);
    }
    return row + "</tr>\n";
}

std::string table_of_numbers(EnsembleView const& view) {
    std::vector<DrawnKey> const numbers = numbers_of(view.parameters);
    std::string html =
        "<h2 id=\"numbers\">Numbers</h2>\n<p>Quantiles over the members that have the index. Inside: share "
        "of these members inside the natural range.";
    if (!numbers.empty()) {
        html += " ρ: Spearman’s rank correlation with a key that varies.";
    }
    html +=
        "</p>\n<div class=\"scroll\"><table>\n<thead><tr><th scope=\"col\">Index</th><th scope=\"col\">members</th>"
        "<th scope=\"col\">minimum</th><th scope=\"col\">5&nbsp;%</th><th scope=\"col\">median</th><th scope=\"col\">"
        "95&nbsp;%</th><th scope=\"col\">maximum</th><th scope=\"col\">natural range</th><th scope=\"col\">inside</th>";
    for (DrawnKey const& key : numbers) {
        html += fmt::format("<th scope=\"col\">ρ {}</th>", report::html_text(key.values.name));
    }
    html += "</tr></thead>\n<tbody>\n";
    for (auto const& group : groups_of(view.indices)) {
        html += fmt::format("<tr><th scope=\"rowgroup\" colspan=\"{}\">{}</th></tr>\n", 9 + numbers.size(),
                            report::html_text(group.front().group));
        for (draw::Distribution const& index : group) {
            html += table_row(index, view);
        }
    }
    return html + "</tbody></table></div>\n";
}

std::string table_of_failures(EnsembleView const& view) {
    MembersTable const& table = view.table;
    std::string rows;
    std::size_t count = 0;
    for (DrawnMember const& member : table.members) {
        if (member.status == DrawnStatus::ok || ++count > most_listed) {
            continue;
        }
        rows += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td>", member.number, report::html_text(member.seed));
        for (std::string const& value : member.values) {
            double const number = plain_number(value);
            rows += fmt::format("<td>{}</td>", std::isnan(number) ? report::html_text(value) : page_number(number));
        }
        rows += fmt::format("<td class=\"words\">{}</td><td class=\"words\">{}</td></tr>\n",
                            member.status == DrawnStatus::failed ? "not made" : "check failed",
                            report::html_text(member.reason));
    }
    std::string html = "<h2 id=\"failures\">Failures</h2>\n";
    if (count == 0) {
        return html + "<p>All members were made, and every check of them holds.</p>\n";
    }
    html += "<div class=\"scroll\"><table>\n<thead><tr><th scope=\"col\">member</th><th scope=\"col\">seed</th>";
    for (std::string const& key : table.keys) {
        html += fmt::format("<th scope=\"col\">{}</th>", report::html_text(key));
    }
    html += "<th scope=\"col\">status</th><th scope=\"col\">reason</th></tr></thead>\n<tbody>\n" + rows +
            "</tbody></table></div>\n";
    if (count > most_listed) {
        html += fmt::format("<p>The first {} of {} are listed; the table has all.</p>\n", most_listed, count);
    }
    return html;
}

/// A section of pictures, one for each group of indices.
template <class Draw> std::string figures_of(EnsembleView const& view, std::string const& ids, Draw const& draw_group) {
    std::string html;
    std::size_t number = 0;
    for (auto const& group : groups_of(view.indices)) {
        std::string const& name = group.front().group;
        html +=
            fmt::format("<figure><h3>{}</h3>{}</figure>\n", report::html_text(name),
                        svg_on_page(draw_group(without_group(group)).bytes, name, fmt::format("{}{}-", ids, ++number)));
    }
    return html;
}

} // namespace

std::string ensemble_page(EnsembleView const& view, EnsembleSheet const& sheet, std::string const& command,
                          Run const& run) {
    std::string const title = report::html_text(view.title);
    std::string html = fmt::format(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta http-equiv=\"Content-Security-"
        "Policy\" content=\"default-src 'none'; style-src '{}'; img-src data:; base-uri 'none'; form-action 'none'\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, "
        "initial-scale=1\">\n<title>{}</title>\n<style>{}</style>\n"
        "</head>\n<body>\n<h1>{}</h1>\n<p>{}</p>\n",
        style_hash, title, ensemble_style, title, report::html_text(view.summary));
    html += "<nav><p><a href=\"#distributions\">Distributions</a>";
    if (!view.parameters.empty()) {
        html += "<a href=\"#responses\">Responses</a>";
    }
    html +=
        "<a href=\"#numbers\">Numbers</a><a href=\"#failures\">Failures</a><a href=\"#members\">Members</a></p></nav>"
        "\n<h2 id=\"distributions\">Distributions</h2>\n<p>One diagram an index: how many members have which value. "
        "Natural ranges of the laws are published ones, those of relief lie around two reference DEMs.</p>\n";
    html += figures_of(view, "d", [](std::vector<draw::Distribution> const& group) {
        return draw::distributions(group, {.title = {}, .note = {}});
    });
    std::size_t number = 0;
    for (DrawnKey const& key : view.parameters) {
        run.check();
        html += fmt::format("<h2{}>Response to {}</h2>\n<p>Across: {}.{}</p>\n",
                            ++number == 1 ? " id=\"responses\"" : "", report::html_text(key.values.name),
                            with_unit(key.values), key.words.empty() ? " ρ: Spearman’s rank correlation." : "");
        html += figures_of(view, fmt::format("r{}-", number), [&](std::vector<draw::Distribution> const& group) {
            return draw::responses(key.values, group, {.title = {}, .note = {}, .words = key.words});
        });
    }
    html += table_of_numbers(view);
    html += table_of_failures(view);
    html += "<h2 id=\"members\">Members</h2>\n";
    if (sheet.png.empty()) {
        html += fmt::format("<p>{}.</p>\n", report::html_text(sheet.note));
    } else {
        html += fmt::format("<p>{}.</p>\n<figure><img alt=\"Hillshades of members\" src=\"data:image/png;base64,{}\">"
                            "</figure>\n",
                            report::html_text(sheet.note),
                            io::base64({reinterpret_cast<std::uint8_t const*>(sheet.png.data()), sheet.png.size()}));
    }
    if (!view.findings.empty()) {
        html += "<h2>Notes</h2>\n";
        for (std::string const& note : texts_of(view.findings)) {
            html += fmt::format("<p>{}.</p>\n", report::html_text(note));
        }
    }
    return html + fmt::format("<p class=\"faint\">Drawn again by <code>{}</code></p>\n</body>\n</html>\n",
                              report::html_text(command));
}

} // namespace thalweg::ensemble
