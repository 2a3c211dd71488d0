#include "sweep/cli/collect_spool.hpp"

#include "sweep/campaign/reader.hpp"
#include "sweep/campaign/wrong_question.hpp"
#include "sweep/spool/spool.hpp"

#include <algorithm>
#include <utility>

namespace grainsweep::cli {
namespace {

using campaign::Outcome;

constexpr std::size_t cases_at_once = 256;  // in one durable group

struct Ended {
    campaign::CaseId id;
    std::vector<spool::Answer> answers;
};

void write_ended(store::Store& store, const std::vector<Ended>& cases) {
    const auto write = [&] {
        for (const auto& one : cases) {
            const auto logged = store.attempts(one.id);
            std::int64_t number = logged.empty() ? 0 : logged.back().number;
            for (const auto& answer : one.answers) {
                auto result = answer.result;
                result.attempt.number = ++number;
                store.begin(result.attempt, answer.computer);
                (void)store.finish(result);
            }
        }
    };
    store.group(write, store::Store::Origin::imported);
}

/// As enrolling once more would find it.
void note_state(const campaign::Cases& cases, const Ended& one, std::vector<store::CaseState>& states) {
    for (auto place = cases.find(campaign::hash_of(one.id)); place; place = cases.next(*place)) {
        auto& state = states[*place];
        state.attempts += static_cast<std::int32_t>(one.answers.size());
        state.failures += static_cast<std::int32_t>(
            std::ranges::count_if(one.answers, [](const auto& answer) { return !settles(answer.result.outcome); }));
        state.outcome = one.answers.back().result.outcome;
    }
}

}  // namespace

campaign::Campaign campaign_of_spool(const std::filesystem::path& spool) {
    const auto asked = spool::Spool::asked_in(spool);
    return campaign::asked_in(spool / "campaign", [&] { return campaign::parse_campaign(asked.text, asked.folder); });
}

void refuse_other_cases(const std::filesystem::path& spool, const campaign::Cases& cases) {
    if (spool::Spool::asked_in(spool).cases == spool::hash_of_cases(cases)) return;
    throw campaign::wrong_question("DIR", spool.string(),
                                   "its tasks computed other cases: a file of the campaign has changed since, "
                                   "or this program is another version");
}

spool::Collected import_answers(const std::filesystem::path& spool, const campaign::Campaign& campaign,
                                const campaign::Cases& cases, store::Store& store,
                                std::vector<store::CaseState>& states,
                                const std::function<void(const std::string&)>& note) {
    std::vector<Ended> group;
    const auto flush = [&] {
        if (!group.empty()) write_ended(store, group);
        for (const auto& one : group) note_state(cases, one, states);
        group.clear();
    };
    spool::Collector collector;
    collector.is_settled = [&](const campaign::CaseId& id) {
        const auto& state = states[cases.find(campaign::hash_of(id)).value()];
        return state.outcome && (settles(*state.outcome) || state.failures >= campaign.limits.attempts);
    };
    collector.import = [&](const campaign::CaseId& id, std::vector<spool::Answer> answers) {
        group.push_back({id, std::move(answers)});
        if (group.size() >= cases_at_once) flush();
    };
    collector.note = note;
    const auto collected = spool::collect(spool / "cases", campaign, cases, collector);
    flush();
    return collected;
}

}  // namespace grainsweep::cli
