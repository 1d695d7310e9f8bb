// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "help/roff.hpp"

#include "help/describe.hpp"

namespace thalweg::tools {

std::string roff(std::string const& text) {
    std::string out;
    bool line_begins = true;
    for (char const c : text) {
        if (line_begins && (c == '.' || c == '\'')) {
            out += "\\&";
        }
        line_begins = c == '\n';
        switch (c) {
        case '\\': out += "\\e"; break;
        case '-': out += "\\-"; break;
        case '\'': out += "\\(aq"; break;
        case '"': out += "\\(dq"; break;
        case '`': out += "\\(ga"; break;
        case '^': out += "\\(ha"; break;
        case '~': out += "\\(ti"; break;
        default: out += c;
        }
    }
    return out;
}

std::string bold_line(std::string const& text) {
    return ".B " + roff(text) + "\n";
}

std::string verbatim(std::string const& lines) {
    return ".RS 4\n.nf\n" + roff(lines) + ".fi\n.RE\n";
}

std::string tagged(std::string const& tag, std::string const& text) {
    return ".TP\n" + tag + "\n" + roff(wrapped(text, 76, 0)) + "\n";
}

std::string paragraph(std::string const& text) {
    return roff(wrapped(text, 76, 0)) + "\n";
}

std::string section(std::string const& name) {
    return ".SH " + name + "\n";
}

} // namespace thalweg::tools
