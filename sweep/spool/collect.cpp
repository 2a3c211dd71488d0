#include "sweep/spool/collect.hpp"

#include "sweep/campaign/wrong_question.hpp"
#include "sweep/store/broken_world.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <map>
#include <memory>
#include <utility>

namespace grainsweep::spool {
namespace {

namespace fs = std::filesystem;
using campaign::Outcome;

std::string bytes_of(const fs::path& file) {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(file.c_str(), "rb"), std::fclose);
    if (!stream) {
        if (errno == ENOENT) return {};  // it was released in between
        throw store::BrokenWorld(fmt::format("'{}': cannot be read: {}", file.string(), std::strerror(errno)));
    }
    std::string text;
    std::string part(65536, '\0');
    for (std::size_t got = 1; got > 0;) {
        got = std::fread(part.data(), 1, part.size(), stream.get());
        text.append(part, 0, got);
    }
    if (std::ferror(stream.get()) != 0)
        throw store::BrokenWorld(fmt::format("'{}': cannot be read: {}", file.string(), std::strerror(EIO)));
    return text;
}

/// What its scene does not declare so; empty: all is declared.
std::string undeclared_by(const SceneInfo& scene, const Observations& observations) {
    const auto declared = [&](const std::string& name, bool scalar) {
        const auto* observable = scene.find_observable(name);
        return observable != nullptr && (observable->shape == Shape::scalar) == scalar;
    };
    for (const auto& [name, value] : observations.scalars)
        if (!declared(name, true)) return name;
    for (const auto& [name, samples] : observations.series)
        if (!declared(name, false)) return name;
    return {};
}

/// Why the answer must not be imported; empty: it may.
std::string fault_of(const campaign::Campaign& campaign, const campaign::Attempt& named, const Answer& answer) {
    if (answer.result.attempt != named) return "it answers another attempt than its name says";
    if (const auto name = undeclared_by(campaign.scene(), answer.result.observations); !name.empty())
        return fmt::format("it measured '{}', which its scene does not declare so", name);
    return {};
}

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
    if (error)
        throw store::BrokenWorld(fmt::format("'{}': cannot be read: {}", cases_folder.string(), error.message()));

    for (auto& [id, numbers] : attempts) {
        std::ranges::sort(numbers);
        std::vector<Answer> ended;
        bool over = false;
        for (const auto number : numbers) {
            const auto file = cases_folder / fmt::format("{}.{}", id, number);
            auto entry = entry_in(bytes_of(file));
            if (const auto* damaged = std::get_if<Damaged>(&entry)) {
                unusable(file, damaged->why);
                continue;
            }
            auto* const answer = std::get_if<Answer>(&entry);
            if (answer == nullptr) {
                if (!over) ++collected.claimed;
                continue;
            }
            if (const auto fault = fault_of(campaign, {id, number}, *answer); !fault.empty()) {
                unusable(file, fault);
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
