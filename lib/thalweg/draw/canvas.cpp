// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/draw/internal/canvas.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <malloc.h>
#include <memory>
#include <mutex>
#include <unordered_map>

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <cairo.h>
#include <fmt/format.h>
#include <fontconfig/fontconfig.h>
#include <png.h>

#include <thalweg/core/run/refuse.hpp>

namespace thalweg::draw {
namespace {

struct EndSurface {
    void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
};
struct EndCairo {
    void operator()(cairo_t* sheet) const { cairo_destroy(sheet); }
};
struct EndFontOptions {
    void operator()(cairo_font_options_t* options) const { cairo_font_options_destroy(options); }
};

cairo_status_t append(void* bytes, unsigned char const* data, unsigned int length) {
    try {
        static_cast<std::string*>(bytes)->append(reinterpret_cast<char const*>(data), length);
    } catch (std::exception const&) { // exceptions must not cross C frames
        return CAIRO_STATUS_NO_MEMORY;
    }
    return CAIRO_STATUS_SUCCESS;
}

void append_png(png_structp png, png_bytep data, std::size_t length) {
    if (append(png_get_io_ptr(png), data, static_cast<unsigned int>(length)) != CAIRO_STATUS_SUCCESS) {
        png_error(png, "out of memory");
    }
}

void leave_png(png_structp png, png_const_charp /*message*/) {
    png_longjmp(png, 1);
}

/// Encodes a sheet as PNG, several times as fast as Cairo does and a tenth to a quarter larger: one filter, and level 2
/// of zlib. Nothing in it has a destructor, as libpng leaves it by a jump.
cairo_status_t encode_png(cairo_surface_t* sheet, std::string* bytes) {
    constexpr int level = 2;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, leave_png, nullptr);
    png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);
    // NOLINTNEXTLINE(cert-err52-cpp): how libpng reports errors
    if (info == nullptr || setjmp(png_jmpbuf(png)) != 0) {
        png_destroy_write_struct(&png, &info);
        return CAIRO_STATUS_NO_MEMORY;
    }
    png_set_write_fn(png, bytes, append_png, nullptr);
    int const height = cairo_image_surface_get_height(sheet);
    png_set_IHDR(png, info, static_cast<png_uint_32>(cairo_image_surface_get_width(sheet)),
                 static_cast<png_uint_32>(height), 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_UP);
    png_set_compression_level(png, level);
    png_write_info(png, info);
    png_set_bgr(png);
    png_set_filler(png, 0, PNG_FILLER_AFTER);
    for (int row = 0; row < height; ++row) {
        png_write_row(png, cairo_image_surface_get_data(sheet) +
                               static_cast<std::ptrdiff_t>(row) * cairo_image_surface_get_stride(sheet));
    }
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    return CAIRO_STATUS_SUCCESS;
}

void require(cairo_status_t status) {
    if (status != CAIRO_STATUS_SUCCESS) {
        throw IoError("draw.paint", fmt::format("Cairo says '{}'; choose a smaller picture or free memory",
                                                cairo_status_to_string(status)));
    }
}

/// Loads the system's fonts early. Cairo loads them at the first text, and Fontconfig retries forever if there is no
/// memory for them.
void load_fonts() {
    [[maybe_unused]] static bool const is_loaded = [] {
        FcConfig* const fonts = FcInitLoadConfigAndFonts();
        bool const is_current = fonts != nullptr && FcConfigSetCurrent(fonts) == FcTrue;
        if (fonts != nullptr) {
            FcConfigDestroy(fonts); // the current one has its own reference
        }
        refuse_if<IoError>(!is_current, "draw.paint", "the system's fonts cannot be read: out of memory");
        return true;
    }();
}

/// While an object lives, the C library returns large blocks zeroed. If memory is refused, Cairo (1.16) jumps through a
/// buffer that it never initialised: with arbitrary bytes it may block the very signal that reports the fault.
class ZeroedBlocks {
public:
    ZeroedBlocks() {
        std::scoped_lock const lock(guard);
        if (alive++ == 0) {
            fill_with(0xFF); // the complement of the fill byte
        }
    }
    ~ZeroedBlocks() {
        std::scoped_lock const lock(guard);
        if (--alive == 0) {
            fill_with(0); // off
        }
    }
    ZeroedBlocks(ZeroedBlocks const&) = delete;
    ZeroedBlocks& operator=(ZeroedBlocks const&) = delete;

private:
    static void fill_with([[maybe_unused]] int byte) {
#ifdef M_PERTURB
        mallopt(M_PERTURB, byte);
#endif
    }

    static inline std::mutex guard;
    static inline int alive = 0; ///< on all threads
};

/// Cairo numbers surfaces and images by a process-wide counter: this renumbers them by their order in the text.
std::string renumber_ids(std::string const& svg) {
    std::string out;
    out.reserve(svg.size());
    std::unordered_map<std::string, std::size_t> numbers;
    for (std::size_t i = 0; i < svg.size();) {
        std::string_view const rest = std::string_view(svg).substr(i);
        std::string_view stem;
        for (std::string_view const mark :
             {"\"surface", "#surface", "\"image", "#image", "\"mask", "#mask", "\"source-", "#source-"}) {
            if (rest.starts_with(mark)) {
                stem = mark;
            }
        }
        std::size_t end = stem.size();
        while (end < rest.size() && std::isdigit(static_cast<unsigned char>(rest[end])) != 0) {
            ++end;
        }
        if (stem.empty() || end == stem.size()) {
            out += svg[i++];
            continue;
        }
        auto const known = numbers.try_emplace(std::string(rest.substr(1, end - 1)), numbers.size() + 1).first;
        out += fmt::format("{}{}", stem, known->second);
        i += end;
    }
    return out;
}

/// Code points of a text; invalid UTF-8 becomes U+FFFD.
std::vector<char32_t> code_points(std::string_view text) {
    std::vector<char32_t> out;
    for (std::size_t i = 0; i < text.size();) {
        auto const byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
        unsigned const lead = byte(i);
        std::size_t const length = lead < 0x80   ? 1
                                   : lead < 0xC2 ? 0
                                   : lead < 0xE0 ? 2
                                   : lead < 0xF0 ? 3
                                   : lead < 0xF5 ? 4
                                                 : 0;
        bool whole = length > 0 && i + length <= text.size();
        char32_t point = length <= 1 ? lead : lead & (0x7FU >> length);
        for (std::size_t k = 1; whole && k < length; ++k) {
            whole = (byte(i + k) & 0xC0U) == 0x80U;
            point = (point << 6U) | (byte(i + k) & 0x3FU);
        }
        bool const overlong = (length == 3 && point < 0x800) || (length == 4 && point < 0x10000);
        if (!whole || overlong || point > 0x10FFFF || (point >= 0xD800 && point < 0xE000)) {
            out.push_back(0xFFFD);
            ++i;
            continue;
        }
        bool const control = point < 0x20 || (point >= 0x7F && point < 0xA0) || point == 0xFFFE || point == 0xFFFF;
        out.push_back(control ? U' ' : point);
        i += length;
    }
    return out;
}

std::string utf8(char32_t point) {
    auto const tail = [&](unsigned shift) { return static_cast<char>(0x80U | ((point >> shift) & 0x3FU)); };
    if (point < 0x80) {
        return {static_cast<char>(point)};
    }
    if (point < 0x800) {
        return {static_cast<char>(0xC0U | (point >> 6U)), tail(0)};
    }
    if (point < 0x10000) {
        return {static_cast<char>(0xE0U | (point >> 12U)), tail(6), tail(0)};
    }
    return {static_cast<char>(0xF0U | (point >> 18U)), tail(12), tail(6), tail(0)};
}

/// Cairo's plain text uses a single font and draws boxes for missing characters; this checks several fonts in order.
constexpr std::array<char const*, 2> families = {"DejaVu Sans", "Noto Sans CJK SC"};

void select_family(cairo_t* sheet, std::size_t family, TextStyle const& style) {
    cairo_select_font_face(sheet, families[family],
                           style.slant == Slant::italic ? CAIRO_FONT_SLANT_ITALIC : CAIRO_FONT_SLANT_NORMAL,
                           style.weight == Weight::bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(sheet, style.size);
}

bool has_glyph(cairo_t* sheet, std::string const& letter) {
    cairo_glyph_t* glyphs = nullptr;
    int count = 0;
    cairo_status_t const status =
        cairo_scaled_font_text_to_glyphs(cairo_get_scaled_font(sheet), 0.0, 0.0, letter.data(),
                                         static_cast<int>(letter.size()), &glyphs, &count, nullptr, nullptr, nullptr);
    bool const found = status == CAIRO_STATUS_SUCCESS && count > 0 && glyphs[0].index != 0;
    cairo_glyph_free(glyphs);
    return found;
}

/// A stretch of text that one font can draw.
struct Stretch {
    std::size_t family = 0;
    std::string text;
};

std::vector<Stretch> split_by_font(cairo_t* sheet, std::string_view text, TextStyle const& style) {
    std::vector<Stretch> out;
    for (char32_t const point : code_points(text)) {
        std::string const letter = utf8(point);
        std::size_t family = 0;
        for (std::size_t k = 0; point >= 0x80 && k < families.size(); ++k) {
            select_family(sheet, k, style);
            if (has_glyph(sheet, letter)) {
                family = k;
                break;
            }
        }
        if (out.empty() || out.back().family != family) {
            out.push_back({family, {}});
        }
        out.back().text += letter;
    }
    return out;
}

double advance(cairo_t* sheet, Stretch const& stretch, TextStyle const& style) {
    select_family(sheet, stretch.family, style);
    cairo_text_extents_t extents;
    cairo_text_extents(sheet, stretch.text.c_str(), &extents);
    return extents.x_advance;
}

double advance(cairo_t* sheet, std::vector<Stretch> const& stretches, TextStyle const& style) {
    double sum = 0.0;
    for (Stretch const& stretch : stretches) {
        sum += advance(sheet, stretch, style);
    }
    return sum;
}

Vec2 towards(Vec2 from, Vec2 to, double by) {
    double const length = distance(from, to);
    double const share = length > 0.0 ? std::min(0.5, by / length) : 0.0;
    return {from.x + (to.x - from.x) * share, from.y + (to.y - from.y) * share};
}

/// The largest power of ten that is at most value.
double power_below(double value) {
    double power = 1.0;
    while (power > value) {
        power /= 10.0;
    }
    while (power <= value / 10.0) {
        power *= 10.0;
    }
    return power;
}

/// With a thin space between thousands if there are more than this many digits.
std::string grouped(double value, int decimals, std::size_t ungrouped) {
    std::string const digits = fmt::format("{:.{}f}", std::fabs(value), decimals);
    std::size_t const whole = std::min(digits.find('.'), digits.size());
    std::string out;
    for (std::size_t i = 0; i < digits.size(); ++i) {
        if (i > 0 && i < whole && whole > ungrouped && (whole - i) % 3 == 0) {
            out += "\u2009";
        }
        out += digits[i];
    }
    bool const zero = digits.find_first_not_of("0.") == std::string::npos;
    return value < 0.0 && !zero ? "\u2212" + out : out;
}

} // namespace

Picture paint(double width, double height, Format format, std::function<void(Cairo*)> const& fill) {
    load_fonts();
    ZeroedBlocks const zeroed;
    Picture picture{{}, format};
    std::unique_ptr<cairo_surface_t, EndSurface> surface;
    switch (format) {
    case Format::png:
        surface.reset(
            cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(width), static_cast<int>(height)));
        break;
    case Format::svg:
        surface.reset(cairo_svg_surface_create_for_stream(append, &picture.bytes, width, height));
        cairo_svg_surface_set_document_unit(surface.get(), CAIRO_SVG_UNIT_PX);
        break;
    case Format::pdf:
        surface.reset(cairo_pdf_surface_create_for_stream(append, &picture.bytes, width, height));
        cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE, "2000-01-01T00:00:00Z");
        break;
    }
    require(cairo_surface_status(surface.get()));
    std::unique_ptr<cairo_t, EndCairo> const sheet(cairo_create(surface.get()));
    // No hinting: letters must be the same at every size and on every screen.
    std::unique_ptr<cairo_font_options_t, EndFontOptions> const fonts(cairo_font_options_create());
    cairo_font_options_set_hint_style(fonts.get(), CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(fonts.get(), CAIRO_HINT_METRICS_OFF);
    cairo_font_options_set_antialias(fonts.get(), CAIRO_ANTIALIAS_GRAY);
    cairo_set_font_options(sheet.get(), fonts.get());
    cairo_set_line_join(sheet.get(), CAIRO_LINE_JOIN_ROUND);
    fill_box(sheet.get(), {0.0, 0.0, width, height}, paper);
    fill(sheet.get());
    require(cairo_status(sheet.get()));
    if (format == Format::png) {
        cairo_surface_flush(surface.get());
        require(encode_png(surface.get(), &picture.bytes));
    }
    cairo_surface_finish(surface.get());
    require(cairo_surface_status(surface.get()));
    if (format == Format::svg) {
        picture.bytes = renumber_ids(picture.bytes);
    }
    return picture;
}

void set_colour(Cairo* sheet, Colour colour) {
    cairo_set_source_rgba(sheet, colour.red, colour.green, colour.blue, colour.alpha);
}

void fill_box(Cairo* sheet, Box box, Colour colour) {
    set_colour(sheet, colour);
    cairo_rectangle(sheet, box.x, box.y, box.width, box.height);
    cairo_fill(sheet);
}

void frame_box(Cairo* sheet, Box box, double line_width, Colour colour) {
    set_colour(sheet, colour);
    cairo_set_line_width(sheet, line_width);
    cairo_rectangle(sheet, box.x, box.y, box.width, box.height);
    cairo_stroke(sheet);
}

void draw_line(Cairo* sheet, Vec2 from, Vec2 to, double line_width, Colour colour) {
    set_colour(sheet, colour);
    cairo_set_line_width(sheet, line_width);
    cairo_move_to(sheet, from.x, from.y);
    cairo_line_to(sheet, to.x, to.y);
    cairo_stroke(sheet);
}

Vec2 near_sheet(Vec2 p) {
    return {std::clamp(p.x, -1e6, 1e6), std::clamp(p.y, -1e6, 1e6)};
}

void trace_line(Cairo* sheet, std::vector<Vec2> const& line, double corner_px) {
    std::vector<Vec2> kept;
    for (std::size_t i = 0; i < line.size(); ++i) {
        Vec2 const p = near_sheet(line[i]);
        if (i + 1 == line.size() && kept.size() > 1 && distance(kept.back(), p) < 0.25) {
            kept.back() = p; // the end is always kept
        } else if (kept.empty() || i + 1 == line.size() || distance(kept.back(), p) >= 0.25) {
            kept.push_back(p);
        }
    }
    if (kept.empty()) {
        return;
    }
    cairo_move_to(sheet, kept.front().x, kept.front().y);
    for (std::size_t i = 1; i + 1 < kept.size(); ++i) {
        if (corner_px <= 0.0) {
            cairo_line_to(sheet, kept[i].x, kept[i].y);
            continue;
        }
        Vec2 const in = towards(kept[i], kept[i - 1], corner_px);
        Vec2 const out = towards(kept[i], kept[i + 1], corner_px);
        auto const control = [&](Vec2 end) { // a quadratic curve with its control point at the vertex
            return Vec2{end.x + (kept[i].x - end.x) * 2.0 / 3.0, end.y + (kept[i].y - end.y) * 2.0 / 3.0};
        };
        cairo_line_to(sheet, in.x, in.y);
        cairo_curve_to(sheet, control(in).x, control(in).y, control(out).x, control(out).y, out.x, out.y);
    }
    cairo_line_to(sheet, kept.back().x, kept.back().y);
}

void draw_ground(Cairo* sheet, std::vector<Vec2> const& line, double base_y, Colour fill, Colour colour,
                 double line_width) {
    trace_line(sheet, line, 0.0);
    cairo_line_to(sheet, line.back().x, base_y);
    cairo_line_to(sheet, line.front().x, base_y);
    cairo_close_path(sheet);
    set_colour(sheet, fill);
    cairo_fill(sheet);
    trace_line(sheet, line, 0.0);
    set_colour(sheet, colour);
    cairo_set_line_width(sheet, line_width);
    cairo_stroke(sheet);
}

double text_width(Cairo* sheet, std::string_view text, TextStyle const& style) {
    return advance(sheet, split_by_font(sheet, text, style), style);
}

void draw_text(Cairo* sheet, Vec2 at, std::string_view text, TextStyle const& style, Anchor anchor, Vec2 along) {
    std::vector<Stretch> const stretches = split_by_font(sheet, text, style);
    double const share = anchor == Anchor::start ? 0.0 : anchor == Anchor::middle ? 0.5 : 1.0;
    cairo_save(sheet);
    double const length = distance({0.0, 0.0}, along);
    cairo_matrix_t turn;
    cairo_matrix_init(&turn, along.x / length, along.y / length, -along.y / length, along.x / length, at.x, at.y);
    cairo_transform(sheet, &turn);
    double const start = -share * advance(sheet, stretches, style);
    if (style.halo_px > 0.0) {
        double x = start;
        for (Stretch const& stretch : stretches) {
            select_family(sheet, stretch.family, style);
            cairo_move_to(sheet, x, 0.0);
            cairo_text_path(sheet, stretch.text.c_str());
            x += advance(sheet, stretch, style);
        }
        set_colour(sheet, {1.0, 1.0, 1.0, 0.75});
        cairo_set_line_width(sheet, 2.0 * style.halo_px);
        cairo_stroke(sheet);
    }
    set_colour(sheet, style.colour);
    double x = start;
    for (Stretch const& stretch : stretches) {
        select_family(sheet, stretch.family, style);
        cairo_move_to(sheet, x, 0.0);
        cairo_show_text(sheet, stretch.text.c_str());
        x += advance(sheet, stretch, style);
    }
    cairo_new_path(sheet);
    cairo_restore(sheet);
}

void draw_text_within(Cairo* sheet, Vec2 at, std::string_view text, TextStyle style, double room, Anchor anchor) {
    double const width = text_width(sheet, text, style);
    if (width <= room) {
        draw_text(sheet, at, text, style, anchor);
        return;
    }
    style.size *= std::max(0.6, 0.999 * room / width);
    if (text_width(sheet, text, style) <= room) {
        draw_text(sheet, at, text, style, anchor);
        return;
    }
    double used = text_width(sheet, "…", style);
    std::string cut;
    for (char32_t const point : code_points(text)) {
        std::string const letter = utf8(point);
        used += text_width(sheet, letter, style);
        if (used > room) {
            break;
        }
        cut += letter;
    }
    draw_text(sheet, at, cut + "…", style, anchor);
}

std::vector<std::string> lines_within(std::vector<std::string> const& texts, TextStyle const& style, double room) {
    std::vector<std::string> lines;
    paint(1.0, 1.0, Format::png, [&](Cairo* sheet) {
        for (std::string const& text : texts) {
            std::string const longer = lines.empty() ? text : lines.back() + " · " + text;
            if (lines.empty() || text_width(sheet, longer, style) > room) {
                lines.push_back(text);
            } else {
                lines.back() = longer;
            }
        }
    });
    return lines;
}

double round_down(double value) {
    double const power = power_below(value);
    return value >= 5.0 * power ? 5.0 * power : value >= 2.0 * power ? 2.0 * power : power;
}

int decimals_of(double step) {
    int decimals = 0;
    while (step < 1.0 - 1e-9 && decimals < 9) {
        step *= 10.0;
        ++decimals;
    }
    return decimals;
}

Ticks ticks_between(double low, double high, int most) {
    double const span = high - low;
    // Below this, doubles cannot distinguish ticks.
    double const least = std::max({std::fabs(low) * 1e-12, std::fabs(high) * 1e-12, 1e-9});
    if (!(span > least) || !std::isfinite(span)) {
        return {{low}, 1.0, low == std::floor(low) ? 0 : 2};
    }
    double const count = std::max(1, most);
    double const power = power_below(span / count);
    double step = 10.0 * power;
    for (double const factor : {5.0, 2.0, 1.0}) {
        step = span <= count * factor * power * (1.0 + 1e-9) ? factor * power : step;
    }
    Ticks ticks{{}, step, decimals_of(step)};
    double const first = std::ceil(low / step - 1e-9);
    for (double k = first; k <= high / step + 1e-9; k += 1.0) {
        ticks.values.push_back(k * step);
    }
    return ticks;
}

std::string number(double value, int decimals) {
    return std::fabs(value) >= 1e9 ? fmt::format("{:.4g}", value) : grouped(value, decimals, 4);
}

std::string figures(double value, int digits) {
    double const size = std::fabs(value); // halves are rounded up, as browsers do
    if (!std::isfinite(value) || size >= 1e9) {
        return fmt::format("{:.4g}", value);
    }
    int const before = size > 0.0 ? static_cast<int>(std::floor(std::log10(size))) : 0;
    int const decimals = std::clamp(digits - 1 - before, 0, 6);
    double const power = std::pow(10.0, decimals);
    std::string out = grouped(std::copysign(std::floor(size * power + 0.5) / power, value), decimals, 3);
    if (out.find('.') != std::string::npos) {
        out.erase(out.find_last_not_of('0') + 1);
        out.erase(out.find_last_not_of('.') + 1);
    }
    return out;
}

void settle_scales(Plot& plot) {
    auto const widen = [](double& low, double& high) {
        double const least = std::max({std::fabs(low) * 1e-6, std::fabs(high) * 1e-6, 1e-9});
        if (high - low < least) {
            double const pad = std::max(least, 0.5);
            low -= pad;
            high += pad;
        }
    };
    widen(plot.x_low, plot.x_high);
    widen(plot.y_low, plot.y_high);
    double const step = ticks_between(plot.y_low, plot.y_high, 6).step;
    plot.y_low = std::floor(plot.y_low / step + 1e-9) * step;
    plot.y_high = std::ceil(plot.y_high / step - 1e-9) * step;
}

void draw_axes(Cairo* sheet, Plot const& plot, std::string const& x_name, std::string const& y_name, double unit) {
    constexpr Colour grid_line{0.88, 0.88, 0.89};
    TextStyle const small{unit, faint_ink};
    TextStyle const name{1.05 * unit, ink};
    Box const& box = plot.box;
    double const hair = 0.07 * unit;
    Ticks const x_ticks =
        ticks_between(plot.x_low, plot.x_high, std::clamp(static_cast<int>(box.width / (6.0 * unit)), 1, 10));
    Ticks const y_ticks =
        ticks_between(plot.y_low, plot.y_high, std::clamp(static_cast<int>(box.height / (2.5 * unit)), 1, 8));
    double widest = 0.0;
    for (double const x : x_ticks.values) {
        double const px = plot.at(x, plot.y_low).x;
        draw_line(sheet, {px, box.y}, {px, box.bottom()}, hair, grid_line);
        draw_line(sheet, {px, box.bottom()}, {px, box.bottom() + 0.4 * unit}, hair, faint_ink);
        draw_text(sheet, {px, box.bottom() + 1.6 * unit}, number(x, x_ticks.decimals), small, Anchor::middle);
    }
    for (double const y : y_ticks.values) {
        double const py = plot.at(plot.x_low, y).y;
        draw_line(sheet, {box.x, py}, {box.right(), py}, hair, grid_line);
        draw_line(sheet, {box.x - 0.4 * unit, py}, {box.x, py}, hair, faint_ink);
        std::string const label = number(y, y_ticks.decimals);
        widest = std::max(widest, text_width(sheet, label, small));
        draw_text(sheet, {box.x - 0.7 * unit, py + 0.36 * unit}, label, small, Anchor::end);
    }
    draw_line(sheet, {box.x, box.bottom()}, {box.right(), box.bottom()}, 1.6 * hair, ink);
    draw_line(sheet, {box.x, box.y}, {box.x, box.bottom()}, 1.6 * hair, ink);
    draw_text(sheet, {box.x + 0.5 * box.width, box.bottom() + 3.4 * unit}, x_name, name, Anchor::middle);
    draw_text(sheet, {box.x - widest - 1.5 * unit, box.y + 0.5 * box.height}, y_name, name, Anchor::middle,
              Vec2{0.0, -1.0});
}

} // namespace thalweg::draw
