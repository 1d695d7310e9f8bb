// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/check_files.hpp>

#include <algorithm>
#include <iterator>
#include <utility>

#include <thalweg/io/read_network.hpp>
#include <thalweg/measure/topology.hpp>

namespace thalweg::pipeline {

namespace {

template <class T> void append(std::vector<T>& to, std::vector<T> from) {
    to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

} // namespace

bool CheckedFiles::ok() const {
    return std::all_of(checks.begin(), checks.end(), [](Check const& c) { return c.ok; });
}

CheckedFiles check_files(CheckJob const& job, Run const& run) {
    NetworkFile const network = io::read_network(job.network, run);
    CheckedFiles checked;
    checked.arcs = static_cast<std::int64_t>(network.arcs.size());
    checked.nodes = static_cast<std::int64_t>(network.nodes.size());
    checked.findings = network.findings;

    measure::TopologyReport topology = measure::check_topology(network, {job.near_m}, run);
    append(checked.checks, std::move(topology.checks));
    append(checked.findings, std::move(topology.findings));

    // With a DEM: its drainage certificate, which the network's cells and this DEM's give.
    return checked;
}

} // namespace thalweg::pipeline
