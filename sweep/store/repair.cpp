// Damage found while a campaign is enrolled: a damaged answer is discarded, and its case runs again.
#include "sweep/store/archive.hpp"
#include "sweep/store/soundness.hpp"

#include <fmt/format.h>

#include <limits>
#include <optional>
#include <unordered_map>

namespace grainsweep::store {

namespace {

/// Restores scene, revision, seed and inputs of this id from the campaign.
void restore_question(Connection& db, std::int64_t key, const campaign::Case& question,
                      const std::vector<DeclaredParameter>& parameters) {
    db.run("UPDATE sim_case SET scene = ?, revision = ?, seed = ? WHERE case_key = ?", question.scene,
           question.revision, static_cast<std::int64_t>(question.seed), key);
    db.run("DELETE FROM case_input WHERE case_key = ?", key);
    enter_inputs(db, key, question, parameters);
}

/// The attempt that gave the case its outcome, or may have.
std::optional<std::int64_t> standing_attempt(const Connection& db, std::int64_t key) {
    return db.value<std::int64_t>(
        "SELECT number FROM attempt WHERE case_key = ?1 AND outcome IS NOT NULL ORDER BY outcome = (SELECT outcome "
        "FROM sim_case WHERE case_key = ?1) DESC, number DESC LIMIT 1",
        key);
}

void note_in_log(Connection& db, std::int64_t key, std::int64_t number, std::string_view note) {
    db.run(
        "UPDATE attempt SET message = iif(coalesce(message, '') = '', ?1, message || ' [' || ?1 || ']'), "
        "outcome = iif(outcome IN ('completed', 'skipped', 'unstable', 'rejected', 'crashed', 'timed_out'), outcome, "
        "'abandoned') WHERE case_key = ?2 AND number = ?3 AND outcome IS NOT NULL",
        note, key, number);
}

void recount(Connection& db, std::int64_t key) {
    db.run(
        "UPDATE sim_case SET (attempts, failures) = (SELECT coalesce(max(number), 0), "
        "coalesce(sum(outcome IN ('crashed', 'timed_out')), 0) FROM attempt WHERE case_key = ?1) WHERE case_key = ?1",
        key);
}

/// Deletes an answer; its attempt gets the reason.
void forget_answer(Connection& db, const DamagedCase& damage) {
    const auto number = standing_attempt(db, damage.key);
    db.run("DELETE FROM observation WHERE case_key = ?", damage.key);
    if (number) {
        db.run("UPDATE attempt SET outcome = 'abandoned', message = ?, phases = NULL WHERE case_key = ? AND number = ?",
               fmt::format("its stored answer was found damaged and is asked again: {}", damage.what), damage.key,
               *number);
    }
    db.run(
        "UPDATE sim_case SET outcome = ?1, wall_seconds = NULL, checksum = NULL, checksum_by_observable = NULL "
        "WHERE case_key = ?2",
        number ? std::optional(std::string("abandoned")) : std::nullopt, damage.key);
}

}  // namespace

bool ask_damaged_again(Store::Impl& archive, const campaign::Cases& cases,
                       const std::vector<DeclaredParameter>& parameters, KnownCases& known) {
    auto& db = archive.db;
    auto& [keys, states] = known;
    std::int64_t strays = 0;
    const auto damaged = damaged_cases(db, 0, std::numeric_limits<std::int64_t>::max(), &strays);
    if (damaged.empty()) return strays == 0;
    bool others_sound = strays == 0;
    std::unordered_map<std::int64_t, std::size_t> places;
    for (std::size_t k = 0; k < keys.size(); ++k)
        if (keys[k] != 0) places.emplace(keys[k], k);
    for (const auto& damage : damaged) {
        const auto found = places.find(damage.key);
        if (found == places.end()) {  // of another campaign
            others_sound = false;
            continue;
        }
        const auto question = cases.question(found->second);
        if (damage.identity) restore_question(db, damage.key, question, parameters);
        if (damage.identity || damage.answer) forget_answer(db, damage);
        for (const auto number : damage.log) note_in_log(db, damage.key, number, "this row was found damaged");
        recount(db, damage.key);
        renew_case(db, damage.key);
        const CaseState now = stored_state(db, damage.key);
        for (std::optional place = found->second; place; place = cases.next(*place)) states[*place] = now;
        archive.notes.push_back(fmt::format("{} is damaged in the database: {}{}", question.id.substr(0, 12),
                                            damage.what,
                                            damage.identity || damage.answer ? "; it is asked again" : ""));
    }
    return others_sound;
}

}  // namespace grainsweep::store
