#include "sweep/campaign/program_changes.hpp"

#include "sweep/campaign/case.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/json_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace grainsweep::campaign {
namespace {

using Change = ProgramChange;
using ChangeKind = ProgramChange::Kind;

constexpr std::size_t shown_hash_digits = 12;

std::string short_hash(const ProgramFile* file) {
    return file == nullptr ? std::string() : file->hash.substr(0, shown_hash_digits);
}

/// Returns the member of each list with each name that occurs, in the order of the names; nullptr: absent.
template <class Member>
std::map<std::string, std::pair<const Member*, const Member*>> paired(const std::vector<Member>& before,
                                                                      const std::vector<Member>& now) {
    std::map<std::string, std::pair<const Member*, const Member*>> pairs;
    for (const auto& one : before) pairs[one.name].first = &one;
    for (const auto& one : now) pairs[one.name].second = &one;
    return pairs;
}

void compare_files(const Program& before, const Program& now, std::vector<Change>& changes) {
    for (const auto& [name, pair] : paired(before.files, now.files)) {
        const auto& [old, fresh] = pair;
        const bool same = old != nullptr && fresh != nullptr && old->hash == fresh->hash &&
                          old->is_template == fresh->is_template && old->counts == fresh->counts;
        if (same) continue;
        const bool no_matter = (old == nullptr || !old->counts) && (fresh == nullptr || !fresh->counts);
        const bool contents = old != nullptr && fresh != nullptr && old->is_template == fresh->is_template;
        const auto* place = (fresh != nullptr ? fresh : old)->is_template ? "$.program.templates" : "$.program.files";
        changes.push_back({no_matter || contents || (fresh != nullptr && !fresh->counts) ? ChangeKind::adoptable
                                                                                         : ChangeKind::another_program,
                           place, name, short_hash(old), short_hash(fresh)});
        if (contents && old->hash == fresh->hash)
            changes.back().before = old->counts ? "counts" : "does not count",
            changes.back().now = fresh->counts ? "counts" : "does not count";
    }
}

std::string last_part(const std::string& path) {
    return path.substr(path.rfind('/') + 1);
}

/// Whether two words are paths of one file name: "/opt/a/lmp", and "lmp" on the search path.
bool same_but_for_folder(const std::string& before, const std::string& now, bool first) {
    const auto is_path = [&](const std::string& word) { return first || word.starts_with('/'); };
    return is_path(before) && is_path(now) && last_part(before) == last_part(now) && !last_part(now).empty();
}

void compare_command(const Program& before, const Program& now, std::vector<Change>& changes) {
    const auto most = std::max(before.command.size(), now.command.size());
    const auto word = [](const Program& program, std::size_t k) {
        return k < program.command.size() ? program.command[k] : std::string();
    };
    for (std::size_t k = 0; k < most; ++k) {
        const auto old = word(before, k), fresh = word(now, k);
        if (old == fresh && k < before.command.size() && k < now.command.size()) continue;
        changes.push_back(
            {same_but_for_folder(old, fresh, k == 0) ? ChangeKind::adoptable : ChangeKind::another_program,
             path_of("$.program.command", k),
             {},
             old,
             fresh});
    }
}

void compare_texts(const std::map<std::string, std::string>& before, const std::map<std::string, std::string>& now,
                   const std::string& place, std::vector<Change>& changes) {
    std::set<std::string> names;
    for (const auto& [name, text] : before) names.insert(name);
    for (const auto& [name, text] : now) names.insert(name);
    const auto text_of = [](const std::map<std::string, std::string>& texts, const std::string& name) {
        const auto found = texts.find(name);
        return found == texts.end() ? std::string() : found->second;
    };
    for (const auto& name : names) {
        const auto old = text_of(before, name), fresh = text_of(now, name);
        if (old == fresh && before.contains(name) == now.contains(name)) continue;
        changes.push_back({ChangeKind::another_program, path_of(place, name), name, old, fresh});
    }
}

std::string type_and_default(const ProgramParameter& parameter) {
    std::string text = parameter.is_word() ? "a word" : "a number";
    if (parameter.standard) text += ", default " + to_text(*parameter.standard);
    return text;
}

void compare_parameters(const Program& before, const Program& now, std::vector<Change>& changes) {
    std::map<std::string, std::string> old, fresh;
    for (const auto& parameter : before.parameters) old[parameter.name] = type_and_default(parameter);
    for (const auto& parameter : now.parameters) fresh[parameter.name] = type_and_default(parameter);
    compare_texts(old, fresh, "$.program.parameters", changes);
}

void compare_observables(const Program& before, const Program& now, std::vector<Change>& changes) {
    for (const auto& [name, pair] : paired(before.observables, now.observables)) {
        const auto& [old, fresh] = pair;
        const auto old_text = old == nullptr ? std::string() : observable_text(*old);
        const auto fresh_text = fresh == nullptr ? std::string() : observable_text(*fresh);
        if (old_text == fresh_text) continue;
        changes.push_back({old == nullptr ? ChangeKind::further_observable : ChangeKind::another_program,
                           path_of("$.program.observables", name), name, old_text, fresh_text});
    }
}

}  // namespace

std::string ProgramChange::line() const {
    const auto& subject = name.empty() ? place : name;
    if (before.empty()) return fmt::format("{}: new", subject);
    return fmt::format("{}: {} -> {}", subject, before, now.empty() ? "gone" : now);
}

std::vector<ProgramChange> program_changes(const Program& before, const Program& now) {
    std::vector<Change> changes;
    compare_files(before, now, changes);
    compare_command(before, now, changes);
    compare_texts(before.environment, now.environment, "$.program.environment", changes);
    compare_parameters(before, now, changes);
    compare_observables(before, now, changes);
    const auto protocol = [](const Program& program) {
        return program.protocol == Program::Protocol::lines ? "lines" : "files";
    };
    if (before.protocol != now.protocol)
        changes.push_back({ChangeKind::another_program, "$.program.protocol", {}, protocol(before), protocol(now)});
    if (before.version != now.version)
        changes.push_back({ChangeKind::another_program, "$.program.version", {}, before.version, now.version});
    return changes;
}

void refuse_changed_program(const std::string& campaign, const std::string& database,
                            const std::vector<ProgramChange>& changes) {
    const auto& first = changes.front();
    const bool adoptable =
        std::ranges::none_of(changes, [](const Change& change) { return change.kind == ChangeKind::another_program; });
    std::string others;
    for (std::size_t k = 1; k < changes.size(); ++k)
        others += fmt::format("{}{}", k == 1 ? "; also changed: " : ", ",
                              changes[k].name.empty() ? changes[k].place : changes[k].name);
    const auto subject = first.name.empty() ? std::string("it") : first.name;
    const auto change =
        first.before.empty() ? fmt::format("{} is new since '{}'", subject, database)
        : first.now.empty()
            ? fmt::format("{} is gone since '{}', where it was {}", subject, database, first.before)
            : fmt::format("{} changed since '{}' ({} -> {})", subject, database, first.before, first.now);
    throw input_error(
        first.place, "",
        fmt::format("{}{}: give the campaign a new name, which computes every case, or {}", change, others,
                    adoptable ? fmt::format("a new name and --adopt {}, which takes over its results, if the change "
                                            "alters none",
                                            campaign)
                              : fmt::format("set this back to continue campaign '{}'", campaign)));
}

}  // namespace grainsweep::campaign
