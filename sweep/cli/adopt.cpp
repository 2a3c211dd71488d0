#include "sweep/cli/adopt.hpp"

#include "sweep/campaign/program.hpp"
#include "sweep/campaign/wrong_question.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

namespace grainsweep::cli {
namespace {

constexpr std::size_t shown_digits = 12;

campaign::WrongQuestion not_adopted(const std::string& old, const std::string& why) {
    return campaign::wrong_question("--adopt", fmt::format("'{}'", old), why);
}

/// Returns the first difference apart from the contents of files; empty: none.
std::string other_difference(const campaign::Program& before, const campaign::Program& now) {
    const auto names = [](const campaign::Program& program) {
        std::vector<std::pair<std::string, bool>> list;
        for (const auto& file : program.files) list.emplace_back(file.name, file.is_template);
        return list;
    };
    if (before.command != now.command) return "the command";
    if (names(before) != names(now)) return "which files the program has";
    if (before.protocol != now.protocol) return "the protocol";
    if (before.environment != now.environment) return "the environment";
    if (before.version != now.version)
        return fmt::format("the version of the program ('{}', before '{}')", now.version, before.version);
    auto with_old_files = now;
    for (std::size_t k = 0; k < now.files.size(); ++k) with_old_files.files[k].hash = before.files[k].hash;
    const bool same = campaign::program_scene_name(with_old_files) == campaign::program_scene_name(before);
    return same ? "" : "the parameters or observables";
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

}  // namespace

std::vector<std::string> changed_files(const campaign::Program& old_program, const campaign::Program& program) {
    std::vector<std::string> changed;
    for (std::size_t k = 0; k < program.files.size(); ++k)
        if (const auto& before = old_program.files[k], &now = program.files[k]; before.hash != now.hash)
            changed.push_back(fmt::format("{}: {} -> {}", now.name, before.hash.substr(0, shown_digits),
                                          now.hash.substr(0, shown_digits)));
    return changed;
}

std::shared_ptr<const campaign::Program> adopted_program(const store::Store& store, const campaign::Campaign& campaign,
                                                         const std::string& old) {
    const auto records = store.campaigns();
    const auto record = std::ranges::find(records, old, [](const auto& one) { return one.name; });
    if (record == records.end()) {
        const auto names = campaign::names_of(records);
        throw campaign::wrong_question(
            "--adopt", fmt::format("'{}'", old),
            fmt::format("the database has no such campaign; it has {}", campaign::listed(names)),
            campaign::nearest_word(old, names));
    }
    const auto now = campaign::known_program(campaign.scene().name);
    if (now == nullptr) throw not_adopted(old, "only answers of a program are adopted (\"scene\": \"program\")");
    const auto before = store.program(record->scene);
    if (before == nullptr) throw not_adopted(old, "this campaign has no program");
    if (record->scene == campaign.scene().name)
        throw not_adopted(old, "its program is this one: equal cases are shared without --adopt");
    if (const auto differs = other_difference(*before, *now); !differs.empty())
        throw not_adopted(old, fmt::format("more than the contents of files changed: {}", differs));
    return before;
}

std::size_t adopt_answers(store::Store& store, const campaign::Campaign& campaign, const campaign::Cases& cases,
                          const campaign::Program& old_program) {
    while (store.enrols()) store.enrol_more(std::numeric_limits<std::uint32_t>::max());
    std::vector<std::pair<campaign::CaseResult, campaign::Computer>> adopted;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const auto question = cases.question(i);
        if (!cases.is_first(i) || !store.attempts(question.id).empty()) continue;
        const auto old_id = id_under(old_program, campaign, question, cases.place(i).replicate);
        auto result = store.result(old_id);
        if (!result || !campaign::settles(result->outcome)) continue;
        campaign::Computer computer;
        for (const auto& attempt : store.attempts(old_id))
            if (attempt.number == result->attempt.number)
                computer = attempt.computer, result->program = attempt.program;
        result->attempt = {question.id, 1};
        result->message =
            fmt::format("{}{}adopted from case {} of {}", result->message, result->message.empty() ? "" : "; ", old_id,
                        campaign::program_scene_name(old_program));
        adopted.emplace_back(std::move(*result), std::move(computer));
    }
    store.group([&] {
        for (const auto& [result, computer] : adopted) {
            store.begin(result.attempt, computer);
            store.finish(result);
        }
    });
    return adopted.size();
}

}  // namespace grainsweep::cli
