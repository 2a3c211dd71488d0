#include "sweep/store/placing.hpp"

#include "sweep/store/database.hpp"
#include "sweep/store/soundness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace grainsweep::store {

namespace {

// Looking one case up by its id costs about as much as reading so many in a row.
constexpr std::int64_t rows_worth_a_search = 8;

CaseState state_at(const Rows& rows, int first) {
    return {static_cast<std::int32_t>(rows.get<std::int64_t>(first)),
            static_cast<std::int32_t>(rows.get<std::int64_t>(first + 1)), outcome_at(rows, first + 2)};
}

std::int64_t highest_key(const Connection& db) {
    return db.value<std::int64_t>("SELECT coalesce(max(case_key), 0) FROM sim_case").value_or(0);
}

void search_each(const Connection& db, const campaign::Cases& cases, KnownCases& known) {
    for (std::size_t i = 0; i < cases.size(); ++i) {
        if (!cases.is_first(i)) continue;
        const auto id = cases.id(i);
        auto rows = db.ask("SELECT attempts, failures, outcome, case_key FROM sim_case WHERE case_id = ?", id);
        if (!rows.next()) continue;
        known.states[i] = state_at(rows, 0);
        known.keys[i] = rows.get<std::int64_t>(3);
    }
}

void read_all(const Connection& db, const campaign::Cases& cases, KnownCases& known) {
    auto rows = db.ask("SELECT attempts, failures, outcome, case_key, case_id FROM sim_case NOT INDEXED");
    while (rows.next()) {
        const auto place = cases.find(campaign::hash_of(rows.get<std::string_view>(4)));
        if (!place) continue;
        known.states[*place] = state_at(rows, 0);
        known.keys[*place] = rows.get<std::int64_t>(3);
    }
}

}  // namespace

std::optional<campaign::Outcome> outcome_at(const Rows& rows, int column) {
    return rows.is_null(column) ? std::nullopt : campaign::outcome_named(rows.get<std::string_view>(column));
}

CaseState stored_state(const Connection& db, std::int64_t key) {
    auto rows = db.ask("SELECT attempts, failures, outcome FROM sim_case WHERE case_key = ?", key);
    return rows.next() ? state_at(rows, 0) : CaseState{};
}

KnownCases known_cases(const Connection& db, const campaign::Cases& cases) {
    KnownCases known{std::vector<std::int64_t>(cases.size()), std::vector<CaseState>(cases.size())};
    const std::int64_t stored = highest_key(db);
    if (stored == 0 || cases.empty()) return known;
    if (stored / rows_worth_a_search > static_cast<std::int64_t>(cases.size()))
        search_each(db, cases, known);
    else
        read_all(db, cases, known);
    for (std::size_t i = 0; i < cases.size(); ++i) {
        if (!cases.is_first(i)) known.states[i] = known.states[cases.first(i)];
    }
    return known;
}

void enter_inputs(Connection& db, std::int64_t key, const campaign::Case& question,
                  const std::vector<DeclaredParameter>& parameters) {
    auto parameter = parameters.begin();  // both are sorted by name
    for (const auto& [name, value] : question.inputs) {
        while (parameter != parameters.end() && parameter->name < name) ++parameter;
        if (parameter == parameters.end() || parameter->name != name) {
            throw std::logic_error(
                fmt::format("case {} has the input {}, which its scene does not", question.id, name));
        }
        if (value == parameter->default_value) continue;
        db.run("INSERT INTO case_input (case_key, parameter_id, value) VALUES (?, ?, ?)", key, parameter->key, value);
    }
}

bool Placing::adds_to(const Connection& db) {
    there_.assign(cases_.size(), false);
    RowSum sum;
    bool moved = false;
    std::size_t next = 0;                                         // the first place that is not before the row
    std::size_t fresh = std::numeric_limits<std::size_t>::max();  // the first place without a row
    auto rows = db.ask(
        "SELECT point, replicate, sequence, case_key FROM campaign_case WHERE campaign_id = ? "
        "ORDER BY point, replicate",
        campaign_key_);
    const auto position = [&](std::size_t i) {
        return std::pair(std::int64_t{cases_.place(i).point}, std::int64_t{cases_.place(i).replicate});
    };
    for (std::size_t i = 1; i < cases_.size(); ++i) {
        if (position(i) <= position(i - 1)) return false;
    }
    std::int64_t last_point = -1;
    while (rows.next()) {
        const auto row = std::pair(rows.get<std::int64_t>(0), rows.get<std::int64_t>(1));
        const auto case_key = rows.get<std::int64_t>(3);
        sum.add(checksum_of_place(row.first, row.second, rows.get<std::int64_t>(2), case_key));
        last_point = row.first;
        for (; next < cases_.size() && position(next) < row; ++next) fresh = std::min(fresh, next);
        if (next == cases_.size() || position(next) != row) continue;
        if (key(next) != case_key) moved = true;
        there_[next++] = true;
    }
    if (next < cases_.size()) fresh = std::min(fresh, next);
    inside_ = fresh < cases_.size() && cases_.place(fresh).point <= last_point;
    return !moved && sum == stored_sum(db, "campaign_case", campaign_key_);
}

void Placing::enter_case(Connection& db, std::size_t i) {
    auto& key = keys_[cases_.first(i)];
    if (key != 0) return;
    cases_.question(i, question_);
    db.run("INSERT INTO sim_case (case_id, scene, revision, seed) VALUES (?, ?, ?, ?)", question_.id, question_.scene,
           question_.revision, static_cast<std::int64_t>(question_.seed));
    key = db.last_row();
    enter_inputs(db, key, question_, parameters_);
}

void Placing::enter_cases(Connection& db) {
    for (std::size_t i = 0; i < cases_.size(); ++i) enter_case(db, i);
}

void Placing::enter(Connection& db, std::size_t places) {
    RowSum fresh;
    for (std::size_t entered = 0; next_ < cases_.size() && entered < places; ++next_) {
        enter_case(db, next_);
        if (there_[next_]) continue;
        const auto& [point, sequence, replicate] = cases_.place(next_);
        db.run("INSERT INTO campaign_case (campaign_id, point, replicate, sequence, case_key) VALUES (?, ?, ?, ?, ?)",
               campaign_key_, std::int64_t{point}, std::int64_t{replicate}, std::int64_t{sequence}, key(next_));
        fresh.add(checksum_of_place(point, replicate, sequence, key(next_)));
        ++entered;
    }
    if (fresh.rows == 0) return;
    RowSum sum = stored_sum(db, "campaign_case", campaign_key_);
    sum.add(fresh);
    store_sum(db, "campaign_case", campaign_key_, sum);
}

}  // namespace grainsweep::store
