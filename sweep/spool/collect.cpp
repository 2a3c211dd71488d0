#include "sweep/spool/collect.hpp"

#include "sweep/files/system_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

namespace grainsweep::spool {
namespace {

namespace fs = std::filesystem;
using campaign::Outcome;

}  // namespace

Collected collect(const fs::path& cases_folder, const campaign::Campaign& campaign, const campaign::Cases& cases,
                  const Collector& collector) {
    Collected collected;
    const auto unusable = [&](const fs::path& file, const std::string& why) {
        ++collected.unusable;
        collector.note(fmt::format("'{}' is not imported: {}", file.string(), why));
    };
    std::map<campaign::CaseId, std::vector<std::int64_t>> attempts;  // ascending, so that nothing depends on the folder
    std::error_code error;
    for (auto entry = fs::directory_iterator(cases_folder, error); !error && entry != fs::directory_iterator();
         entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        if (name.starts_with('.')) continue;  // being written, or left behind by a task that was killed
        const auto attempt = attempt_named(name);
        if (!attempt) {
            unusable(entry->path(), "its name is none of a spool's");
        } else if (!cases.find(campaign::hash_of(attempt->case_id))) {
            unusable(entry->path(), "the campaign has no such case");
        } else {
            attempts[attempt->case_id].push_back(attempt->number);
        }
    }
    if (error) throw SystemError(fmt::format("'{}': cannot be read: {}", cases_folder.string(), error.message()));

    for (auto& [id, numbers] : attempts) {
        std::ranges::sort(numbers);
        std::vector<Answer> ended;
        bool over = false;
        for (const auto number : numbers) {
            const auto file = cases_folder / fmt::format("{}.{}", id, number);
            auto entry = entry_of(file, {id, number}, campaign.scene());
            if (!entry) continue;  // it was released in between
            if (const auto* damaged = std::get_if<Damaged>(&*entry)) {
                unusable(file, damaged->why);
                continue;
            }
            auto* const answer = std::get_if<Answer>(&*entry);
            if (answer == nullptr) {
                if (!over) ++collected.claimed;
                continue;
            }
            const auto outcome = answer->result.outcome;
            if (over || outcome == Outcome::abandoned) continue;
            ended.push_back(std::move(*answer));
            over = settles(outcome) || static_cast<std::int64_t>(ended.size()) >= campaign.limits.attempts;
        }
        if (!over) continue;
        if (collector.is_settled(id)) {
            ++collected.known;
        } else {
            ++collected.imported;
            collector.import(id, std::move(ended));
        }
    }
    return collected;
}

}  // namespace grainsweep::spool
