// Cases, one by one: whether inputs give the id, and attempts and measurements the checksums.
#include "sweep/campaign/case.hpp"
#include "sweep/store/soundness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <unordered_map>
#include <utility>

namespace grainsweep::store {

namespace {

/// Names behind the keys of parameters and observables.
struct Names {
    struct Observable {
        std::string name;
        std::uint64_t hash = 0;
    };
    std::unordered_map<std::int64_t, std::string> parameters;
    std::unordered_map<std::int64_t, Observable> observables;

    explicit Names(const Connection& db) {
        {
            auto rows = db.ask("SELECT parameter_id, name FROM parameter NOT INDEXED");
            while (rows.next()) parameters.emplace(rows.get<std::int64_t>(0), rows.get<std::string>(1));
        }
        auto rows = db.ask("SELECT observable_id, name FROM observable NOT INDEXED");
        while (rows.next()) {
            auto name = rows.get<std::string>(1);
            const auto hash = MeasuredSum::hash_of(name);
            observables.emplace(rows.get<std::int64_t>(0), Observable{std::move(name), hash});
        }
    }
    [[nodiscard]] std::uint64_t hash_of(std::int64_t observable) const {
        const auto found = observables.find(observable);
        return found == observables.end() ? 0 : found->second.hash;
    }
};

/// Rows of one table in order of case, taken case by case.
class Follower {
public:
    Follower(Rows rows, std::int64_t& strays) : rows_(std::move(rows)), strays_(&strays) { advance(); }

    /// Visits the rows of this case. Remaining rows with a smaller key belong to no case and are counted.
    template <class Visit>
    void visit(std::int64_t key, Visit&& visit) {
        for (; there_ && key_ < key; advance()) ++*strays_;
        for (; there_ && key_ == key; advance()) visit(rows_);
    }
    void finish(std::int64_t last) {
        for (; there_ && key_ <= last; advance()) ++*strays_;
    }

private:
    void advance() {
        there_ = rows_.next();
        if (there_) key_ = rows_.get<std::int64_t>(0);
    }
    Rows rows_;
    std::int64_t* strays_;
    bool there_ = false;
    std::int64_t key_ = 0;
};

AttemptRow attempt_at(const Rows& rows) {
    const auto text = [&](int column) {
        return rows.is_null(column) ? std::nullopt : std::optional(rows.get<std::string_view>(column));
    };
    return {.key = rows.get<std::int64_t>(0),
            .number = rows.get<std::int64_t>(1),
            .provenance = rows.get<std::int64_t>(2),
            .computer = rows.get<std::int64_t>(11),
            .started = rows.get<std::string_view>(3),
            .outcome = rows.get<std::string_view>(4),
            .message = text(5),
            .wall_seconds = rows.get<double>(6),
            .cpu_seconds = rows.get<double>(7),
            .particle_steps = rows.get<double>(8),
            .phases = text(9),
            .threads = rows.get<double>(12)};
}

/// An archive of an older form has no column `threads`.
std::string attempts_of_cases(const Connection& db) {
    return fmt::format(
        "SELECT case_key, number, provenance_id, started, outcome, message, wall_seconds, cpu_seconds, particle_steps, "
        "phases, checksum, computer_id, {} FROM attempt NOT INDEXED WHERE case_key BETWEEN ?1 AND ?2 "
        "ORDER BY case_key, number",
        has_threads(db) ? "threads" : "NULL");
}
constexpr std::string_view inputs_of_cases =
    "SELECT case_key, parameter_id, value FROM case_input NOT INDEXED WHERE case_key BETWEEN ?1 AND ?2 "
    "ORDER BY case_key, parameter_id";
constexpr std::string_view measured_of_cases =
    "SELECT case_key, observable_id, sample, time, bin, value FROM observation NOT INDEXED "
    "WHERE case_key BETWEEN ?1 AND ?2 ORDER BY case_key, observable_id, sample";

void add_measured(const Rows& rows, const Names& names, MeasuredSum& sum) {
    sum.add(names.hash_of(rows.get<std::int64_t>(1)), rows.get<std::int64_t>(2), rows.get<double>(3),
            rows.get<double>(4), rows.get<double>(5));
}

/// Data in the rows of one case.
struct Seen {
    Inputs inputs;
    bool unknown_input = false;
    std::int64_t highest = 0, failures = 0, measured_rows = 0;
    bool finished = false;          ///< an attempt has an outcome
    std::optional<bool> standing;   ///< whether the last attempt with the case's outcome is as written
    std::vector<std::int64_t> log;  ///< attempts that are not
    MeasuredSum measured;
};

Seen see(std::int64_t key, std::string_view outcome, const Names& names, Follower& inputs, Follower& attempts,
         Follower& measured) {
    Seen seen;
    inputs.visit(key, [&](const Rows& rows) {
        const auto name = names.parameters.find(rows.get<std::int64_t>(1));
        if (name == names.parameters.end() || rows.is_null(2))
            seen.unknown_input = true;
        else
            seen.inputs.emplace(name->second, rows.value(2));
    });
    attempts.visit(key, [&](const Rows& rows) {
        const AttemptRow attempt = attempt_at(rows);
        const bool running = rows.is_null(4);
        const bool right = running ? rows.is_null(10)
                                   : !rows.is_null(10) && rows.get<std::int64_t>(10) == as_sql(checksum_of(attempt));
        if (!right) seen.log.push_back(attempt.number);
        seen.highest = std::max(seen.highest, attempt.number);
        if (attempt.outcome == "crashed" || attempt.outcome == "timed_out") ++seen.failures;
        if (running) return;
        seen.finished = true;
        if (attempt.outcome == outcome) seen.standing = right;
    });
    measured.visit(key, [&](const Rows& rows) {
        add_measured(rows, names, seen.measured);
        ++seen.measured_rows;
    });
    return seen;
}

/// The one observable whose rows explain both differences.
std::string observable_behind(const Names& names, std::uint64_t plain, std::uint64_t by_observable) {
    for (const auto& [key, observable] : names.observables) {
        if (by_observable == plain * MeasuredSum::weight_of(observable.hash)) return observable.name;
    }
    return {};
}

void judge_answer(const Rows& row, const Seen& seen, const Names& names, DamagedCase& damage) {
    const auto complain = [&](std::string what) {
        damage.answer = true;
        damage.what += (damage.what.empty() ? "" : "; ") + std::move(what);
    };
    if (row.is_null(5)) {  // no outcome
        if (!row.is_null(9) || seen.measured_rows > 0 || seen.finished) complain("its outcome is missing");
        return;
    }
    const auto outcome = row.get<std::string_view>(5);
    const auto head =
        checksum_of_case(row.get<std::int64_t>(0), row.get<std::string_view>(1), outcome, row.get<double>(6));
    const auto plain = static_cast<std::uint64_t>(row.get<std::int64_t>(9)) - (head + seen.measured.plain);
    const auto by_observable = static_cast<std::uint64_t>(row.get<std::int64_t>(10)) - seen.measured.by_observable;
    if (row.is_null(9) || row.is_null(10)) {
        complain("its checksum is missing");
    } else if (plain != 0 && by_observable != 0) {
        damage.observable = observable_behind(names, plain, by_observable);
        complain(damage.observable.empty() ? "what it measured is not as written"
                                           : fmt::format("observable '{}' is not as written", damage.observable));
    } else if (plain != 0 || by_observable != 0) {
        complain("its outcome, or its checksum, is not as written");
    }
    if (!campaign::outcome_named(outcome)) complain("its outcome is none that exists");
    if (!seen.standing) complain("the attempt that gave its outcome is missing");
    if (seen.standing && !*seen.standing) complain("the attempt that gave its outcome is not as written");
}

DamagedCase judge(const Rows& row, const Seen& seen, const Names& names) {
    DamagedCase damage;
    damage.key = row.get<std::int64_t>(0);
    damage.id = row.get<std::string>(1);
    const auto text = campaign::canonical_text(row.get<std::string_view>(2), static_cast<int>(row.get<std::int64_t>(3)),
                                               seen.inputs, {}, static_cast<std::uint64_t>(row.get<std::int64_t>(4)));
    if (seen.unknown_input || campaign::content_hash(text) != damage.id) {
        damage.identity = true;
        damage.what = "its inputs, scene, revision and seed do not give its id";
    }
    judge_answer(row, seen, names, damage);
    damage.log = seen.log;
    for (const auto number : seen.log) {
        if (!damage.answer)
            damage.what += fmt::format("{}attempt {} is not as written", damage.what.empty() ? "" : "; ", number);
    }
    if (seen.highest != row.get<std::int64_t>(7) || seen.failures != row.get<std::int64_t>(8)) {
        damage.log.push_back(0);
        damage.what += fmt::format("{}its attempts are miscounted", damage.what.empty() ? "" : "; ");
    }
    return damage;
}

std::vector<DamagedCase> scanned(const Connection& db, const Names& names, std::int64_t first, std::int64_t last,
                                 std::int64_t& strays) {
    std::vector<DamagedCase> damaged;
    Follower inputs(db.ask(inputs_of_cases, first, last), strays);
    Follower attempts(db.ask(attempts_of_cases(db), first, last), strays);
    Follower measured(db.ask(measured_of_cases, first, last), strays);
    auto cases = db.ask(
        "SELECT case_key, case_id, scene, revision, seed, outcome, wall_seconds, attempts, failures, checksum, "
        "checksum_by_observable FROM sim_case NOT INDEXED WHERE case_key BETWEEN ?1 AND ?2 ORDER BY case_key",
        first, last);
    while (cases.next()) {
        const auto key = cases.get<std::int64_t>(0);
        const Seen seen = see(key, cases.get<std::string_view>(5), names, inputs, attempts, measured);
        auto damage = judge(cases, seen, names);
        if (damage.identity || damage.answer || !damage.log.empty()) damaged.push_back(std::move(damage));
    }
    for (auto* follower : {&inputs, &attempts, &measured}) follower->finish(last);
    return damaged;
}

void renew_answer(Connection& db, std::int64_t key, const Names& names) {
    MeasuredSum measured;
    {
        auto rows = db.ask(measured_of_cases, key, key);
        while (rows.next()) add_measured(rows, names, measured);
    }
    std::uint64_t head = 0;
    {
        auto rows = db.ask("SELECT case_id, outcome, wall_seconds FROM sim_case WHERE case_key = ?", key);
        if (!rows.next() || rows.is_null(1)) return;
        head = checksum_of_case(key, rows.get<std::string_view>(0), rows.get<std::string_view>(1), rows.get<double>(2));
    }
    db.run("UPDATE sim_case SET checksum = ?, checksum_by_observable = ? WHERE case_key = ?",
           as_sql(head + measured.plain), as_sql(measured.by_observable), key);
}

void renew_case(Connection& db, std::int64_t key, const Names& names) {
    const auto attempts = db.column<std::int64_t>("SELECT number FROM attempt WHERE case_key = ?", key);
    for (const auto number : attempts) renew_attempt(db, key, number);
    renew_answer(db, key, names);
}

}  // namespace

std::vector<DamagedCase> damaged_cases(const Connection& db, std::int64_t first, std::int64_t last,
                                       std::int64_t* strays) {
    if (!has_checksums(db)) return {};
    const Names names(db);
    std::int64_t without_case = 0;
    const auto suspected = scanned(db, names, first, last, without_case);
    if (strays != nullptr) *strays = without_case;
    if (suspected.size() < 2) return suspected;
    // A row whose key is damaged makes the cases after it look bare in one pass over all: each is asked for its own.
    std::vector<DamagedCase> damaged;
    for (const auto& one : suspected) {
        std::int64_t none = 0;
        auto found = scanned(db, names, one.key, one.key, none);
        std::ranges::move(found, std::back_inserter(damaged));
    }
    return damaged.empty() ? suspected : damaged;
}

void renew_attempt(Connection& db, std::int64_t key, std::int64_t number) {
    std::optional<std::int64_t> checksum;
    {
        auto rows = db.ask(
            "SELECT case_key, number, provenance_id, started, outcome, message, wall_seconds, cpu_seconds, "
            "particle_steps, phases, checksum, computer_id, threads FROM attempt WHERE case_key = ? AND number = ?",
            key, number);
        if (rows.next() && !rows.is_null(4)) checksum = as_sql(checksum_of(attempt_at(rows)));
    }
    db.run("UPDATE attempt SET checksum = ? WHERE case_key = ? AND number = ?", checksum, key, number);
}

void renew_answer(Connection& db, std::int64_t key) {
    renew_answer(db, key, Names(db));
}

void renew_case(Connection& db, std::int64_t key) {
    renew_case(db, key, Names(db));
}

void renew_all_cases(Connection& db) {
    const auto keys = db.column<std::int64_t>("SELECT case_key FROM sim_case NOT INDEXED ORDER BY case_key");
    const Names names(db);
    for (const auto key : keys) renew_case(db, key, names);
}

}  // namespace grainsweep::store
