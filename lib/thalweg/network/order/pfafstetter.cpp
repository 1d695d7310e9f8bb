// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/order/pfafstetter.hpp>

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <utility>

#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>

namespace thalweg::network {
namespace {

using Link = std::size_t;

std::vector<std::vector<Link>> inflows_of(std::vector<std::int64_t> const& down, char const* who) {
    std::vector<std::vector<Link>> inflows(down.size());
    for (Link a = 0; a < down.size(); ++a) {
        refuse_if<BadInput>(down[a] >= std::ssize(down), who, "link {} flows into link {} of {}", a, down[a],
                            down.size());
        if (down[a] >= 0) {
            inflows[static_cast<Link>(down[a])].push_back(a);
        }
    }
    return inflows;
}

/// Links, each before those upstream of it.
std::vector<Link> upstream_order(std::vector<std::int64_t> const& down, std::vector<std::vector<Link>> const& inflows,
                                 char const* who) {
    std::vector<Link> order;
    for (Link a = 0; a < down.size(); ++a) {
        if (down[a] < 0) {
            order.push_back(a);
        }
    }
    for (std::size_t next = 0; next < order.size(); ++next) {
        std::vector<Link> const& above = inflows[order[next]];
        order.insert(order.end(), above.begin(), above.end());
    }
    refuse_if<BadInput>(order.size() < down.size(), who, "{} links run in a circle", down.size() - order.size());
    return order;
}

/// A main stem's reach, upstream, and its tributaries.
struct Part {
    /// A tributary that ends at the upper end of a link of the stem.
    struct Tributary {
        std::size_t at = 0; ///< position in the stem
        Link mouth = 0;
    };
    std::vector<Link> stem;
    std::vector<Tributary> tributaries; ///< in upstream order
    int digits = 0;                     ///< of the code of its links
};

class Codes {
public:
    Codes(std::vector<std::vector<Link>> const& inflows, std::vector<double> const& area_m2)
        : inflows_(inflows), area_m2_(area_m2), codes_(area_m2.size()) {}

    std::vector<std::string> take() { return std::move(codes_); }

    void code_basin(Link mouth, int levels) {
        std::vector<Part> open{part_above(mouth, 0)};
        while (!open.empty()) {
            Part const part = std::move(open.back());
            open.pop_back();
            if (part.tributaries.empty() || part.digits == levels) {
                continue;
            }
            for (Part& piece : divide(part)) {
                open.push_back(std::move(piece));
            }
        }
    }

private:
    double area(Link a) const { return area_m2_[a] > 0.0 ? area_m2_[a] : 0.0; }

    Part part_above(Link mouth, int digits) const {
        Part part{{mouth}, {}, digits};
        while (!inflows_[part.stem.back()].empty()) {
            std::vector<Link> const& in = inflows_[part.stem.back()];
            Link const main = *std::ranges::max_element(in, [&](Link a, Link b) { return area(a) < area(b); });
            for (Link const a : in) {
                if (a != main) {
                    part.tributaries.push_back({part.stem.size() - 1, a});
                }
            }
            part.stem.push_back(main);
        }
        return part;
    }

    void add_digit(Part const& part, int digit) {
        std::vector<Link> links = part.stem;
        for (Part::Tributary const& t : part.tributaries) {
            links.push_back(t.mouth);
            for (std::size_t next = links.size() - 1; next < links.size(); ++next) {
                std::vector<Link> const& above = inflows_[links[next]];
                links.insert(links.end(), above.begin(), above.end());
            }
        }
        for (Link const a : links) {
            codes_[a] += static_cast<char>('0' + digit);
        }
    }

    std::vector<Part> divide(Part const& part) {
        std::vector<std::size_t> largest(part.tributaries.size());
        for (std::size_t i = 0; i < largest.size(); ++i) {
            largest[i] = i;
        }
        std::ranges::stable_sort(largest, [&](std::size_t a, std::size_t b) {
            return area(part.tributaries[a].mouth) > area(part.tributaries[b].mouth);
        });
        largest.resize(std::min<std::size_t>(largest.size(), 4));
        std::ranges::sort(largest);
        std::vector<Part> pieces;
        std::size_t begin = 0; // of the stem's next reach
        std::size_t next = 0;  // tributary
        int digit = 1;
        for (std::size_t k = 0; k <= largest.size(); ++k, digit += 2) {
            bool const is_last = k == largest.size();
            std::size_t const end = is_last ? part.stem.size() : part.tributaries[largest[k]].at + 1;
            Part reach{{part.stem.begin() + static_cast<std::ptrdiff_t>(begin),
                        part.stem.begin() + static_cast<std::ptrdiff_t>(end)},
                       {},
                       part.digits + 1};
            for (; next < part.tributaries.size() && part.tributaries[next].at < end; ++next) {
                if (std::ranges::find(largest, next) == largest.end()) {
                    reach.tributaries.push_back({part.tributaries[next].at - begin, part.tributaries[next].mouth});
                }
            }
            if (!reach.stem.empty()) {
                add_digit(reach, digit);
                pieces.push_back(std::move(reach));
            }
            if (!is_last) {
                pieces.push_back(part_above(part.tributaries[largest[k]].mouth, part.digits + 1));
                add_digit(pieces.back(), digit + 1);
            }
            begin = end;
        }
        return pieces;
    }

    std::vector<std::vector<Link>> const& inflows_;
    std::vector<double> const& area_m2_;
    std::vector<std::string> codes_;
};

} // namespace

LinkOrders order_links(std::vector<std::int64_t> const& down) {
    auto const inflows = inflows_of(down, "network.order_links");
    std::vector<Link> const order = upstream_order(down, inflows, "network.order_links");
    LinkOrders orders{std::vector<int>(down.size(), 1), std::vector<std::int64_t>(down.size(), 1)};
    for (auto a = order.rbegin(); a != order.rend(); ++a) {
        int highest = 0;
        int equals = 0;
        std::int64_t sources = 0;
        for (Link const in : inflows[*a]) {
            equals = orders.strahler[in] > highest ? 1 : equals + (orders.strahler[in] == highest ? 1 : 0);
            highest = std::max(highest, orders.strahler[in]);
            sources += orders.shreve[in];
        }
        orders.strahler[*a] = std::max(1, highest + (equals > 1 ? 1 : 0));
        orders.shreve[*a] = std::max<std::int64_t>(1, sources);
    }
    return orders;
}

std::vector<std::string> pfafstetter(std::vector<std::int64_t> const& down, std::vector<double> const& area_m2,
                                     PfafstetterParams const& params) {
    constexpr char const* self = "network.pfafstetter";
    require_in(self, "levels", params.levels, Range::between(1, 18));
    refuse_if<BadInput>(area_m2.size() != down.size(), self, "{} areas for {} links; give one a link", area_m2.size(),
                        down.size());
    auto const inflows = inflows_of(down, self);
    std::ignore = upstream_order(down, inflows, self);
    Codes codes(inflows, area_m2);
    for (Link a = 0; a < down.size(); ++a) {
        if (down[a] < 0) {
            codes.code_basin(a, params.levels);
        }
    }
    return codes.take();
}

} // namespace thalweg::network
