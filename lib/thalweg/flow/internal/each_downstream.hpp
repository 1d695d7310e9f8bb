// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/flow/direction.hpp>
#include <thalweg/flow/internal/row_bands.hpp>

namespace thalweg::flow {

/// Follows water from each cell without donors as long as all donors have arrived: inside bands at the same time, and
/// serially from band to band.
template <class Visit> class Downstream {
public:
    Downstream(Raster<Direction> const& direction, Visit visit)
        : offsets_(d8_offsets(direction.grid())), way_(direction.values().data()), awaited_by_(direction.grid()),
          awaited_(awaited_by_.values().data()), visit_(std::move(visit)) {}

    void follow(RowBands const& bands, Run const& run) {
        leaving_.resize(bands.count());
        bands.each(run, [&](RowBand const& band) { count_donors(band); });
        for (auto const& leaving : leaving_) {
            for (std::int64_t const at : leaving) {
                ++awaited_[receiver(at)];
            }
        }
        bands.each(run, [&](RowBand const& band) {
            for (std::int64_t i = band.begin; i < band.end; ++i) {
                if (i % cells_between_checks == 0) {
                    run.check();
                }
                follow_from(i, band);
            }
        });
        RowBand const all{0, awaited_by_.cells(), 0};
        for (auto const& leaving : leaving_) {
            for (std::int64_t const at : leaving) {
                if (awaited_[at] == waits) { // else it comes after water of another band
                    awaited_[at] = done;
                    arrive(at, receiver(at));
                    follow_from(receiver(at), all);
                }
            }
        }
    }

private:
    static constexpr std::uint8_t done = 255;
    static constexpr std::uint8_t waits = 254; ///< to run on into another band

    std::int64_t receiver(std::int64_t cell) const { return cell + offsets_[index_of(way_[cell])]; }

    void count_donors(RowBand const& band) {
        for (std::int64_t i = band.begin; i < band.end; ++i) {
            if (!goes_on(way_[i])) {
                continue;
            }
            std::int64_t const next = receiver(i);
            if (band.contains(next)) {
                ++awaited_[next];
            } else {
                leaving_[band.number].push_back(i);
            }
        }
    }
    void arrive(std::int64_t cell, std::int64_t next) {
        visit_(cell, next);
        --awaited_[next];
    }
    void follow_from(std::int64_t at, RowBand const& band) {
        while (awaited_[at] == 0) {
            awaited_[at] = done;
            if (!goes_on(way_[at])) {
                return;
            }
            std::int64_t const next = receiver(at);
            if (!band.contains(next)) {
                awaited_[at] = waits;
                return;
            }
            arrive(at, next);
            at = next;
        }
    }

    std::array<std::int64_t, 8> offsets_;
    Direction const* way_;
    Raster<std::uint8_t> awaited_by_; // donors whose water has not arrived yet
    std::uint8_t* awaited_;
    std::vector<std::vector<std::int64_t>> leaving_; // by band: cells whose water runs into another
    Visit visit_;
};

/// Calls visit(cell, receiver) for every cell with a receiver, after all its donors.
/// \param direction on the grid, without cycles
/// \param visit called as visit(std::int64_t, std::int64_t), for several receivers at the same time; may read what
///        belongs to the cell and change what belongs to the receiver. The order of a receiver's donors, which depends
///        on the number of threads, must not matter.
///
/// Source: \cite braun2013.
template <class Visit> void each_downstream(Raster<Direction> const& direction, Run const& run, Visit visit) {
    Downstream(direction, std::move(visit)).follow({direction.grid(), run}, run);
}

/// The same serially, in one order whatever the number of threads.
template <class Visit> void each_downstream_in_order(Raster<Direction> const& direction, Run run, Visit visit) {
    run.threads = 1;
    each_downstream(direction, run, std::move(visit));
}

} // namespace thalweg::flow
