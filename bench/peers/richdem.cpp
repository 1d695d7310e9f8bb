// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// RichDEM, filling by Zhou's algorithm, and D8 with accumulation of terrain that drains: richdem SIDE RELIEF DRAINED
#include <richdem/common/Array2D.hpp>
#include <richdem/depressions/Zhou2016.hpp>
#include <richdem/methods/flow_accumulation.hpp>

#include "peer.hpp"

namespace {

richdem::Array2D<float> array(std::vector<float> const& values, std::size_t side) {
    richdem::Array2D<float> dem(static_cast<int>(side), static_cast<int>(side));
    for (std::size_t i = 0; i < values.size(); ++i) {
        dem(static_cast<richdem::Array2D<float>::i_t>(i)) = values[i];
    }
    dem.setNoData(-9999.0F);
    return dem;
}

} // namespace

int main(int, char** words) {
    std::freopen("/dev/null", "w", stderr); // RichDEM tells of its progress there
    std::size_t const side = peer::size_of(words[1]);
    auto const relief = array(peer::read(words[2], side), side);
    auto const drained = array(peer::read(words[3], side), side);
    peer::measure(
        "richdem_fill", side, 3, [&] { return relief; },
        [](richdem::Array2D<float>& dem) { richdem::PriorityFlood_Zhou2016(dem); });
    peer::measure(
        "richdem_d8", side, 3, [&] { return 0; },
        [&](int) {
            richdem::Array2D<double> area(drained, 1.0);
            richdem::FA_D8(drained, area);
        });
}
