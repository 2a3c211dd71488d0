#include "sweep/cli/adopt.hpp"

#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/program.hpp"
#include "sweep/cli/stored_case.hpp"
#include "sweep/workers/program_folder.hpp"
#include "sweep/workers/program_results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace grainsweep::cli {
namespace {

using Change = campaign::ProgramChange;

campaign::InputError not_adopted(const std::string& old, const std::string& why) {
    return campaign::input_error("--adopt", fmt::format("'{}'", old), why);
}

/// Returns the id of the same case under the old program.
campaign::CaseId id_under(const campaign::Program& old_program, const campaign::Campaign& campaign,
                          const campaign::Case& question, std::int64_t replicate) {
    const auto& scene = campaign.scene();
    const auto text = [&](std::optional<std::uint64_t> seed) {
        return campaign::canonical_text(campaign::program_scene_name(old_program), scene.revision, question.inputs,
                                        scene.defaults(), seed);
    };
    return campaign::content_hash(text(campaign::case_seed(campaign.seed, text({}), replicate)));
}

/// Returns the program of a stored campaign; nullptr: it has none.
std::shared_ptr<const campaign::Program> program_of(const store::Store& store, const std::string& campaign) {
    for (const auto& record : store.campaigns())
        if (record.name == campaign) return store.program(record.scene);
    return nullptr;
}

bool same_number(double a, double b) {
    return a == b || (std::isnan(a) && std::isnan(b));
}

bool same_values(double a, double b) {
    return same_number(a, b);
}

bool same_values(const std::vector<Sample>& a, const std::vector<Sample>& b) {
    return std::ranges::equal(a, b, [](const Sample& one, const Sample& other) {
        return same_number(one.time, other.time) && same_number(one.bin, other.bin) &&
               same_number(one.value, other.value);
    });
}

/// Whether all values of the old program are among the new ones.
bool contains_values(const Observations& now, const Observations& before) {
    const auto has = [](const auto& all, const auto& one) {
        const auto found = all.find(one.first);
        return found != all.end() && same_values(found->second, one.second);
    };
    return std::ranges::all_of(before.scalars, [&](const auto& one) { return has(now.scalars, one); }) &&
           std::ranges::all_of(before.series, [&](const auto& one) { return has(now.series, one); });
}

/// Reads all observables from the kept folder of a case. Returns false if it has none, or other values than the store.
bool read_again(const Adopted& adopted, const campaign::Program& now, campaign::CaseResult& result) {
    const workers::ProgramFolder folder(
        workers::ProgramFolder::Kept{},
        adopted.cases / fmt::format("{}.{}", result.attempt.case_id, result.attempt.number));
    if (!folder.is_open()) return false;
    auto reply = workers::results_in(folder, now);
    if (reply.kind != workers::ProgramReply::Kind::measured ||
        !contains_values(reply.observations, result.observations))
        return false;
    result.observations = std::move(reply.observations);
    return true;
}

/// Takes over the answer to a case; empty: there is none that can be.
struct Taken {
    campaign::CaseResult result;
    campaign::Computer computer;
};
std::optional<Taken> taken_from(const store::Store& store, const campaign::CaseId& old_id) {
    auto result = store.result(old_id);
    if (!result || !campaign::settles(result->outcome)) return std::nullopt;
    Taken taken{std::move(*result), {}};
    for (const auto& attempt : store.attempts(old_id))
        if (attempt.number == taken.result.attempt.number)
            taken.computer = attempt.computer, taken.result.program = attempt.program;
    return taken;
}

}  // namespace

void refuse_another_program(const store::Store& store, const campaign::Campaign& campaign,
                            const std::filesystem::path& database) {
    const auto now = campaign::known_program(campaign.scene().name);
    const auto before = now == nullptr ? nullptr : program_of(store, campaign.name);
    if (before == nullptr || campaign::program_scene_name(*before) == campaign.scene().name) return;
    const auto changes = campaign::program_changes(*before, *now);
    if (!changes.empty()) campaign::refuse_changed_program(campaign.name, database.string(), changes);
}

Adopted adopted_program(const store::Store& store, const campaign::Campaign& campaign, const std::string& old) {
    const auto records = store.campaigns();
    const auto record = std::ranges::find(records, old, [](const auto& one) { return one.name; });
    if (record == records.end()) {
        const auto names = campaign::names_of(records);
        throw campaign::input_error(
            "--adopt", fmt::format("'{}'", old),
            fmt::format("the database has no such campaign; it has {}", campaign::listed(names)),
            campaign::nearest_word(old, names));
    }
    const auto now = campaign::known_program(campaign.scene().name);
    if (now == nullptr) throw not_adopted(old, "only answers of a program are adopted (\"scene\": \"program\")");
    Adopted adopted{store.program(record->scene), {}, {}, {}};
    if (adopted.program == nullptr) throw not_adopted(old, "this campaign has no program");
    if (record->scene == campaign.scene().name)
        throw not_adopted(old, "its program is this one: equal cases are shared without --adopt");
    adopted.changes = campaign::program_changes(*adopted.program, *now);
    const auto other = std::ranges::find(adopted.changes, Change::Kind::another_program, &Change::kind);
    if (other != adopted.changes.end())
        throw not_adopted(
            old, fmt::format("its answers are those of another program: {} changed ({})", other->place, other->line()));
    return adopted;
}

AdoptedCounts adopt_answers(store::Store& store, const campaign::Campaign& campaign, const campaign::Cases& cases,
                            const Adopted& adopted) {
    while (store.enrols()) store.enrol_more(std::numeric_limits<std::uint32_t>::max());
    const auto now = campaign::known_program(campaign.scene().name);
    const bool further = std::ranges::any_of(
        adopted.changes, [](const auto& change) { return change.kind == Change::Kind::further_observable; });
    AdoptedCounts counts;
    std::vector<Taken> all;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const auto question = cases.question(i);
        if (!cases.is_first(i) || !store.attempts(question.id).empty()) continue;
        const auto old_id = id_under(*adopted.program, campaign, question, cases.place(i).replicate);
        auto taken = taken_from(store, old_id);
        if (!taken) continue;
        if (adopted.where && !adopted.where(question.inputs)) {
            ++counts.excluded;
            continue;
        }
        auto& result = taken->result;
        std::string origin;
        if (further && result.outcome == campaign::Outcome::completed) {
            if (!read_again(adopted, *now, result)) {
                ++counts.without;
                continue;
            }
            ++counts.read_again;
            origin = ", further observables read from its folder";
        }
        result.attempt = {question.id, 1};
        result.message = fmt::format("{}{}{}{} of {}{}", result.message, result.message.empty() ? "" : "; ",
                                     adopted_from, old_id, campaign::program_scene_name(*adopted.program), origin);
        all.push_back(std::move(*taken));
    }
    store.group([&] {
        for (const auto& [result, computer] : all) {
            store.begin(result.attempt, computer);
            store.finish(result);
        }
    });
    counts.answers = all.size();
    return counts;
}

}  // namespace grainsweep::cli
