// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/crs/internal/crs.hpp>
#include <thalweg/io/gdal/internal/access.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>
#include <thalweg/io/network/internal/network_tables.hpp>
#include <thalweg/io/network/internal/table.hpp>

namespace thalweg::io {

namespace {

/// What is made, where: names are plain, so that they stand in SQL as they are.
struct Names {
    std::string schema; ///< of the database; "" for its default
    std::string name;

    std::string full(std::string const& relation) const { return schema.empty() ? relation : schema + "." + relation; }
    std::string edges() const { return name + "_edges"; }
};

bool is_plain_word(std::string_view word) {
    auto const letter = [](char c) { return (c >= 'a' && c <= 'z') || c == '_'; };
    constexpr std::size_t most = 50; // PostgreSQL cuts names after 63 bytes, ours get endings
    return !word.empty() && word.size() <= most && letter(word.front()) &&
           std::ranges::all_of(word, [&](char c) { return letter(c) || (c >= '0' && c <= '9'); });
}

Names names_of(std::string const& text) {
    std::size_t const dot = text.find('.');
    Names names{dot == std::string::npos ? "" : text.substr(0, dot),
                dot == std::string::npos ? text : text.substr(dot + 1)};
    refuse_if<BadParameter>((dot != std::string::npos && !is_plain_word(names.schema)) || !is_plain_word(names.name),
                            "io.write_postgis: '{}' is not a valid table name: write NAME or SCHEMA.NAME in lower-case "
                            "letters, digits and _, at most 50",
                            text);
    return names;
}

/// A database in a transaction, which is taken back unless commit() was called.
class Database {
public:
    Database(std::string const& connection, std::string what) : what_(std::move(what)) {
        std::array<char const*, 2> constexpr drivers{"PostgreSQL", nullptr};
        std::array<char const*, 2> constexpr options{"LIST_ALL_TABLES=NO", nullptr};
        dataset_.reset(
            GDALDataset::Open(connection.c_str(), GDAL_OF_VECTOR | GDAL_OF_UPDATE, drivers.data(), options.data()));
        if (dataset_ == nullptr) {
            std::string const reason = driver_.take();
            throw IoError(fmt::format("{} cannot be reached: {}", what_, reason.empty() ? "no reason given" : reason));
        }
        require(dataset_->StartTransaction() == OGRERR_NONE);
        open_ = true;
    }
    ~Database() {
        if (open_) {
            dataset_->RollbackTransaction();
        }
    }
    Database(Database const&) = delete;
    Database& operator=(Database const&) = delete;

    /// The first field of the first row that a query gives, "" for none.
    std::string ask(std::string const& sql) {
        OGRLayer* const result = dataset_->ExecuteSQL(sql.c_str(), nullptr, nullptr);
        driver_.check(what_);
        std::string answer;
        if (result != nullptr) {
            if (OGRFeatureUniquePtr const row{result->GetNextFeature()}; row != nullptr && row->GetFieldCount() > 0) {
                answer = row->GetFieldAsString(0);
            }
            dataset_->ReleaseResultSet(result);
        }
        return answer;
    }
    void write(Table const& table, OGRSpatialReference* reference, std::string const& schema, Run const& run) {
        write_layer({LayerFormat::postgresql, what_, driver_, *dataset_, reference, schema}, table, run);
        // The driver makes a table when its first row comes, or it is asked for what it holds.
        if (OGRLayer* const layer = dataset_->GetLayer(dataset_->GetLayerCount() - 1)) {
            require(layer->SyncToDisk() == OGRERR_NONE);
        }
    }
    void commit() {
        require(dataset_->CommitTransaction() == OGRERR_NONE);
        open_ = false;
        driver_.check(what_);
    }

private:
    void require(bool done) const {
        if (!done) {
            driver_.check(what_);
            throw IoError(what_ + " could not be written");
        }
    }

    std::string what_;
    Driver driver_;
    Connection connection_;
    Dataset dataset_;
    bool open_ = false;
};

/// The view that pgRouting takes.
std::string edges_view(Names const& names, std::string const& table, SchemaTable const& schema) {
    auto const column = [&](Quantity quantity) {
        std::string name(field_of(schema, quantity)->name);
        std::ranges::transform(name, name.begin(),
                               [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
        return name;
    };
    return fmt::format("CREATE VIEW {} AS SELECT {}::bigint AS id, {}::bigint AS source, {}::bigint AS target, {} AS "
                       "cost, -1.0::double precision AS reverse_cost, geom FROM {}",
                       names.full(names.edges()), column(Quantity::arc_id), column(Quantity::from_node),
                       column(Quantity::to_node), column(Quantity::length), names.full(table));
}

} // namespace

bool is_postgis(std::string const& name) {
    return name.starts_with("PG:") || name.starts_with("pg:");
}

std::vector<std::string> write_postgis(NetworkTables const& tables, std::string const& connection,
                                       WritePostgisParams const& params, Run const& run) {
    Names const names = names_of(params.name);
    std::string const what = "io.write_postgis: " + names.full(names.name);
    std::vector<Table> layers = network_layers(tables, params.schema, false, what);
    bool const routable = field_of(table_of(params.schema), Quantity::from_node) != nullptr;
    std::vector<std::string> relations;
    for (Table& layer : layers) {
        layer.name = layers.size() > 1 ? names.name + "_" + layer.name : names.name;
        relations.push_back(layer.name);
    }
    if (routable) {
        relations.push_back(names.edges());
    }

    Database database(connection, what);
    OGRSpatialReference reference;
    if (!tables.crs.empty()) {
        reference = read_reference(tables.crs);
    }
    refuse_if<BadInput>(
        !names.schema.empty() &&
            database.ask(fmt::format("SELECT 1 FROM pg_namespace WHERE nspname = '{}'", names.schema)).empty(),
        "{}: the database has no schema {}: create it first", what, names.schema);
    for (auto relation = relations.rbegin(); relation != relations.rend(); ++relation) { // the view before its table
        std::string const kind = database.ask(
            fmt::format("SELECT relkind FROM pg_class WHERE oid = to_regclass('{}')", names.full(*relation)));
        if (kind.empty()) {
            continue;
        }
        if (!params.overwrite) {
            throw BadInput(fmt::format("{}: {} already exists: give another name (--table) or use --overwrite", what,
                                       names.full(*relation)));
        }
        bool const is_view = routable && *relation == names.edges();
        if (kind != (is_view ? "v" : "r")) {
            throw BadInput(fmt::format("{}: {} is not a {} written by thalweg, and is not replaced", what,
                                       names.full(*relation), is_view ? "view" : "table"));
        }
        database.ask(fmt::format("DROP {} {}", is_view ? "VIEW" : "TABLE", names.full(*relation)));
    }
    for (Table const& layer : layers) {
        database.write(layer, tables.crs.empty() ? nullptr : &reference, names.schema, run);
    }
    if (routable) {
        database.ask(edges_view(names, layers.front().name, table_of(params.schema)));
    }
    database.commit();
    for (std::string& relation : relations) {
        relation = names.full(relation);
    }
    return relations;
}

} // namespace thalweg::io
