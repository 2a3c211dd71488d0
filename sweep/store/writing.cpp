// Data written while a campaign runs, inside a group: attempts, answers, verdicts.
#include "sweep/campaign/stored_text.hpp"
#include "sweep/store/archive.hpp"
#include "sweep/store/moment.hpp"
#include "sweep/store/soundness.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace grainsweep::store {

namespace {

constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

/// Stores the outcome of an attempt. Returns false if the attempt has an outcome already.
bool close_attempt(Connection& db, const OpenAttempt& open, const campaign::CaseResult& result) {
    const auto phases = campaign::phases_text(result.cost.phases);
    AttemptRow row{.key = open.key,
                   .number = open.number,
                   .provenance = open.provenance,
                   .computer = open.computer,
                   .started = open.started,
                   .outcome = campaign::to_string(result.outcome),
                   .wall_seconds = result.cost.wall_seconds,
                   .cpu_seconds = result.cost.cpu_seconds,
                   .particle_steps = result.cost.particle_steps,
                   .phases = phases,
                   .threads = result.cost.threads};
    if (!result.message.empty()) row.message = result.message;
    const auto closed = db.run(
        "UPDATE attempt SET outcome = ?1, message = ?2, wall_seconds = ?3, cpu_seconds = ?4, particle_steps = ?5, "
        "phases = ?6, threads = ?7, checksum = ?8 WHERE case_key = ?9 AND number = ?10 AND outcome IS NULL",
        row.outcome, row.message, row.wall_seconds, row.cpu_seconds, row.particle_steps, row.phases, row.threads,
        as_sql(checksum_of(row)), row.key, row.number);
    return closed == 1;
}

/// Stores the observables of a case.
MeasuredSum enter_observations(Store::Impl& archive, const OpenAttempt& open, const Observations& observations) {
    MeasuredSum measured;
    constexpr std::string_view insert =
        "INSERT INTO observation (case_key, observable_id, sample, time, bin, value) VALUES (?, ?, ?, ?, ?, ?)";
    for (const auto& [name, value] : observations.scalars) {
        if (std::isnan(value)) continue;  // undefined: no row, NULL in every view
        const auto observable = archive.observable_key(open.scene, open.revision, name);
        archive.db.run(insert, open.key, observable, 0, std::nullopt, std::nullopt, value);
        measured.add(MeasuredSum::hash_of(name), 0, undefined, undefined, value);
    }
    for (const auto& [name, samples] : observations.series) {
        if (samples.empty()) continue;
        const auto observable = archive.observable_key(open.scene, open.revision, name);
        const auto hash = MeasuredSum::hash_of(name);
        std::int64_t number = 0;
        for (const auto& sample : samples) {
            archive.db.run(insert, open.key, observable, number, sample.time, sample.bin, sample.value);
            measured.add(hash, number++, sample.time, sample.bin, sample.value);
        }
    }
    return measured;
}

/// What an attempt at the case needs of it; none for a case that is not there.
std::optional<OpenAttempt> case_of(const Connection& db, const campaign::Attempt& attempt, std::int64_t& begun) {
    auto rows =
        db.ask("SELECT case_key, scene, revision, outcome, attempts FROM sim_case WHERE case_id = ?", attempt.case_id);
    if (!rows.next()) return std::nullopt;
    OpenAttempt open;
    open.number = attempt.number;
    open.key = rows.get<std::int64_t>(0);
    open.scene = rows.get<std::string>(1);
    open.revision = rows.get<std::int64_t>(2);
    open.before = outcome_at(rows, 3);
    begun = rows.get<std::int64_t>(4);
    return open;
}

}  // namespace

std::optional<OpenAttempt> Store::Impl::take_open(const campaign::Attempt& attempt) {
    if (auto known = open.extract(attempt.case_id); !known.empty() && known.mapped().number == attempt.number)
        return std::move(known.mapped());
    std::int64_t begun = 0;
    auto found = case_of(db, attempt, begun);
    if (!found) throw std::logic_error(fmt::format("case {} is not enrolled", attempt.case_id));
    if (begun != attempt.number) return std::nullopt;
    auto rows = db.ask(
        "SELECT provenance_id, started, computer_id FROM attempt WHERE case_key = ? AND number = ? AND outcome IS NULL",
        found->key, attempt.number);
    if (!rows.next()) return std::nullopt;
    found->provenance = rows.get<std::int64_t>(0);
    found->started = rows.get<std::string>(1);
    found->computer = rows.get<std::int64_t>(2);
    return found;
}

void Store::begin(const campaign::Attempt& attempt, const campaign::Computer& computer) {
    impl_->require_group();
    auto& db = impl_->db;
    if (!impl_->provenance) throw std::logic_error("an attempt begins before its campaign is enrolled");
    std::int64_t before = 0;
    auto open = case_of(db, attempt, before);
    if (!open && impl_->placing) {
        impl_->placing->enter(db, std::numeric_limits<std::size_t>::max());
        impl_->placing.reset();
        open = case_of(db, attempt, before);
    }
    if (!open || before > attempt.number) {
        throw std::logic_error(fmt::format("attempt {} of case {} begins, which is unknown or has begun a later one",
                                           attempt.number, attempt.case_id));
    }
    open->provenance = *impl_->provenance;
    open->computer = impl_->computer_key(computer);
    open->started = utc_now();
    db.run("UPDATE sim_case SET attempts = ? WHERE case_key = ?", attempt.number, open->key);
    // An attempt that was handed out to a worker that died before it began may begin again.
    const auto begun = db.run(
        "INSERT INTO attempt (case_key, number, provenance_id, computer_id, started) VALUES (?, ?, ?, ?, ?) "
        "ON CONFLICT (case_key, number) DO UPDATE SET provenance_id = excluded.provenance_id, "
        "computer_id = excluded.computer_id, started = excluded.started WHERE outcome IS NULL",
        open->key, attempt.number, open->provenance, open->computer, open->started);
    if (begun != 1) {
        throw std::logic_error(
            fmt::format("attempt {} of case {} begins after it ended", attempt.number, attempt.case_id));
    }
    impl_->open.insert_or_assign(attempt.case_id, std::move(*open));
}

bool Store::finish(const campaign::CaseResult& result) {
    impl_->require_group();
    auto& db = impl_->db;
    const auto open = impl_->take_open(result.attempt);
    if (!open || !close_attempt(db, *open, result)) return false;  // given up as abandoned, or reported twice
    ++impl_->settled_in_group;
    if (result.program) store_program_facts(db, open->key, open->number, *result.program);
    if (result.imported) store_import(db, open->key, open->number, *result.imported);

    const bool failed = result.outcome == campaign::Outcome::crashed || result.outcome == campaign::Outcome::timed_out;
    if (open->before && campaign::settles(*open->before) && !campaign::settles(result.outcome)) {  // it stands
        db.run("UPDATE sim_case SET failures = failures + ? WHERE case_key = ?", failed, open->key);
        return true;
    }
    if (open->before) db.run("DELETE FROM observation WHERE case_key = ?", open->key);
    const auto measured = enter_observations(*impl_, *open, result.observations);
    const auto outcome = campaign::to_string(result.outcome);
    const auto head = checksum_of_case(open->key, result.attempt.case_id, outcome, result.cost.wall_seconds);
    db.run(
        "UPDATE sim_case SET outcome = ?1, failures = failures + ?2, wall_seconds = ?3, checksum = ?4, "
        "checksum_by_observable = ?5 WHERE case_key = ?6",
        outcome, failed, result.cost.wall_seconds, as_sql(head + measured.plain), as_sql(measured.by_observable),
        open->key);
    return true;
}

void Store::record(std::string_view campaign, const ConvergenceRow& row) {
    impl_->require_group();
    auto& db = impl_->db;
    const std::int64_t key = impl_->campaign_key(campaign);
    RowSum sum = stored_sum(db, "convergence", key);
    sum.remove(sum_of_verdict(db, key, row.observable, row.points));
    db.run("INSERT OR REPLACE INTO convergence VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)", key,
           row.observable, row.points, row.mean, row.sd, row.skewness, row.g1, row.kurtosis, row.mean_error,
           row.sd_error, row.skewness_error, row.g1_error, row.kurtosis_error, row.zero_share, row.excluded,
           row.converged);
    sum.add(sum_of_verdict(db, key, row.observable, row.points));
    store_sum(db, "convergence", key, sum);
}

void Store::forget_checks(std::string_view campaign) {
    impl_->require_group();
    forget_convergence(impl_->db, impl_->campaign_key(campaign));
}

void Store::stop(std::string_view campaign, std::optional<std::int64_t> points) {
    impl_->require_group();
    constexpr std::string_view update = "UPDATE campaign SET stopped_at = ? WHERE campaign_id = ?";
    const auto key = impl_->campaign_key(campaign);
    change_summed(impl_->db, "campaign", [&] {
        if (points)
            impl_->db.run(update, *points, key);
        else
            impl_->db.run(update, std::nullopt, key);
    });
}

}  // namespace grainsweep::store
