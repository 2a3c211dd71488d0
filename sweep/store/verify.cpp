// Reports damage: as text for the user, and before any data are used.
#include "sweep/store/archive.hpp"
#include "sweep/store/file_checksum.hpp"
#include "sweep/store/soundness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <future>
#include <iterator>
#include <map>
#include <utility>

namespace grainsweep::store {

namespace {

std::string campaign_name(const Connection& db, std::int64_t campaign) {
    return db.value<std::string>("SELECT name FROM campaign NOT INDEXED WHERE campaign_id = ?", campaign).value_or("");
}

/// The campaigns whose designs hold the case, "a, b".
std::string campaigns_of(const Connection& db, std::int64_t key) {
    std::string text;
    auto rows = db.ask(
        "SELECT DISTINCT g.name FROM campaign_case AS p NOT INDEXED JOIN campaign AS g ON g.campaign_id = "
        "p.campaign_id WHERE p.case_key = ? ORDER BY g.campaign_id",
        key);
    while (rows.next()) text.append(text.empty() ? "" : ", ").append(rows.get<std::string_view>(0));
    return text;
}

Damage described(const Connection& db, const DamagedCase& damage) {
    return {"case", damage.id, campaigns_of(db, damage.key), damage.observable, damage.what};
}

Damage described(const Connection& db, const DamagedTable& damage) {
    const bool of_campaign = damage.part != 0;
    return {"table", "", of_campaign ? campaign_name(db, damage.part) : "", "",
            fmt::format("table {}: {}", damage.name, damage.what)};
}

/// SQLite's own checks: pages, cells, indices, constraints, references.
void check_database(const Connection& db, std::vector<Damage>& found) {
    auto pages = db.prepare("PRAGMA integrity_check");
    while (pages.step()) {
        if (pages.get<std::string_view>(0) != "ok") found.push_back({"file", "", "", "", pages.get<std::string>(0)});
    }
    std::map<std::pair<std::string, std::string>, std::int64_t> dangling;
    auto references = db.prepare("PRAGMA foreign_key_check");
    while (references.step()) ++dangling[{references.get<std::string>(0), references.get<std::string>(2)}];
    for (const auto& [tables, rows] : dangling) {
        found.push_back({"table", "", "", "",
                         fmt::format("table {}: {} rows refer to rows of {} that are not there", tables.first, rows,
                                     tables.second)});
    }
}

void check_cases(const Connection& db, std::vector<Damage>& found) {
    std::int64_t strays = 0;
    for (const auto& one :
         damaged_cases(db, std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max(), &strays))
        found.push_back(described(db, one));
    if (strays > 0)
        found.push_back({"table", "", "", "", fmt::format("{} rows belong to cases that are not there", strays)});
}

/// A part of the check that stops at a page that cannot be read has found damage, too.
template <class Check>
void guarded(Check&& check, std::vector<Damage>& found) {
    try {
        check();
    } catch (const SystemError& broken) {
        found.push_back({"file", "", "", "", broken.what()});
    }
}

/// Rows that are whole and not in their order are passed by when they are looked for.
std::vector<DamagedTable> disordered_tables(const Connection& db) {
    if (!has_checksums(db)) return {};
    for (const char* const table :
         {"campaign", "campaign_case", "sim_case", "case_input", "attempt", "observation", "convergence"}) {
        auto rows = db.prepare(fmt::format("PRAGMA quick_check({})", table));
        while (rows.step())
            if (rows.get<std::string_view>(0) != "ok") return {{table, 0, rows.get<std::string>(0)}};
    }
    return tables_out_of_order(db);
}

std::string in_words(const Damage& damage) {
    std::string text = damage.kind == "case" ? fmt::format("case {}", damage.case_id) : "";
    if (!damage.campaign.empty()) text += fmt::format("{}campaign '{}'", text.empty() ? "" : " of ", damage.campaign);
    return text.empty() ? damage.what : fmt::format("{}: {}", text, damage.what);
}

}  // namespace

std::vector<Damage> Store::verify() const {
    auto& db = impl_->db;
    const Transaction one_state(db, Transaction::Kind::read);
    std::vector<Damage> found;
    guarded([&] { check_database(db, found); }, found);
    std::vector<DamagedTable> tables;
    const auto gather = [&](auto&& part) {
        guarded([&] { std::ranges::move(part(), std::back_inserter(tables)); }, found);
    };
    gather([&] { return damaged_descriptions(db); });
    gather([&] { return damaged_views(db); });
    gather([&] { return damaged_parts(db); });
    gather([&] { return damaged_numbers(db); });
    gather([&] { return damaged_texts(db, true); });
    guarded(
        [&] {
            for (const auto& table : tables) found.push_back(described(db, table));
        },
        found);
    guarded([&] { check_cases(db, found); }, found);
    guarded(
        [&] {
            for (auto& what : damaged_programs(db)) found.push_back({"table", "", "", "", std::move(what)});
            for (auto& what : damaged_machines(db)) found.push_back({"table", "", "", "", std::move(what)});
            for (auto& what : damaged_files(db)) found.push_back({"table", "", "", "", std::move(what)});
            for (auto& what : damaged_imports(db)) found.push_back({"table", "", "", "", std::move(what)});
        },
        found);
    return found;
}

bool Store::has_checksums() const {
    return store::has_checksums(impl_->db);
}

void Store::Impl::refuse_damage(const std::vector<DamagedTable>& tables, const std::vector<DamagedCase>& cases) const {
    if (tables.empty() && cases.empty()) return;
    const Damage first = tables.empty() ? described(db, cases.front()) : described(db, tables.front());
    const std::size_t count = tables.size() + cases.size();
    const std::string more = count > 1 ? fmt::format(" (the first of {})", count) : "";
    throw SystemError(fmt::format("database '{}': damaged: {}{}. `grainsweep verify {}` names all that is damaged{}",
                                  file.string(), in_words(first), more, file.string(),
                                  tables.empty() ? "; the next run of its campaign asks a damaged case again" : ""));
}

void Store::Impl::require_sound() {
    if (sound) return;
    std::optional<Transaction> one_state;
    if (!db.in_transaction()) one_state.emplace(db, Transaction::Kind::read);
    if (is_as_remembered(db, file))
        refuse_damage(damaged_numbers(db), {});
    else
        (void)check_rows();
    sound = true;
}

bool Store::Impl::check_rows() const {
    refuse_damage(disordered_tables(db), {});
    return check_contents();
}

bool Store::Impl::check_rows_on_two_cores() const {
    auto order = std::async(std::launch::async,
                            [this] { return disordered_tables(Connection(file, Connection::Access::read)); });
    try {
        const bool all_belong = check_contents();
        refuse_damage(order.get(), {});
        return all_belong;
    } catch (const SystemError&) {
        if (order.valid()) refuse_damage(order.get(), {});  // is named first, as on one core
        throw;
    }
}

bool Store::Impl::check_contents() const {
    auto tables = damaged_descriptions(db);
    std::ranges::move(damaged_parts(db), std::back_inserter(tables));
    std::ranges::move(damaged_texts(db, false), std::back_inserter(tables));
    refuse_damage(tables, {});
    std::int64_t strays = 0;
    refuse_damage({}, damaged_cases(db, std::numeric_limits<std::int64_t>::min(),
                                    std::numeric_limits<std::int64_t>::max(), &strays));
    refuse_damage(damaged_numbers(db), {});
    return strays == 0;
}

bool Store::Impl::check_descriptions() const {
    for (const auto table : described_tables) {
        auto rows = db.prepare(fmt::format("PRAGMA quick_check({})", table));
        while (rows.step())
            if (rows.get<std::string_view>(0) != "ok")
                refuse_damage({{std::string(table), 0, rows.get<std::string>(0)}}, {});
    }
    auto tables = damaged_descriptions(db);
    std::ranges::move(damaged_parts(db), std::back_inserter(tables));
    std::ranges::move(damaged_texts(db, false), std::back_inserter(tables));
    refuse_damage(tables, {});
    return true;
}

void Store::Impl::require_sound(std::int64_t key) {
    if (sound) return;
    std::optional<Transaction> one_state;
    if (!db.in_transaction()) one_state.emplace(db, Transaction::Kind::read);
    const auto tables = damaged_descriptions(db);
    refuse_damage(tables, tables.empty() ? damaged_cases(db, key, key) : std::vector<DamagedCase>{});
}

}  // namespace grainsweep::store
