#include "sweep/campaign/file_contents.hpp"

#include "sweep/campaign/case.hpp"
#include "sweep/files/system_error.hpp"
#include "sweep/files/whole_file.hpp"

#include <fmt/format.h>

#include <map>
#include <mutex>
#include <system_error>
#include <utility>

namespace grainsweep::campaign {
namespace {

struct KnownContents {
    std::mutex mutex;
    std::map<std::string, std::string, std::less<>> by_hash;
};

KnownContents& known_files() {
    static KnownContents all;
    return all;
}

}  // namespace

void enter_contents(std::string contents) {
    std::string hash = content_hash(contents);
    auto& all = known_files();
    const std::lock_guard lock(all.mutex);
    all.by_hash.insert_or_assign(std::move(hash), std::move(contents));
}

std::optional<std::string> known_contents(std::string_view hash) {
    auto& all = known_files();
    const std::lock_guard lock(all.mutex);
    const auto found = all.by_hash.find(hash);
    return found == all.by_hash.end() ? std::nullopt : std::optional(found->second);
}

std::string made_file_word(std::string_view name, std::string contents) {
    std::string word = fmt::format("file:{}:{}", content_hash(contents), name);
    enter_contents(std::move(contents));
    return word;
}

bool is_made(const FileWord& file) {
    return file.path.find('/') == std::string_view::npos;
}

std::variant<FileContents, std::string> contents_of(const FileWord& file) {
    if (auto given = known_contents(file.hash)) return FileContents{std::move(*given)};
    const std::string path(file.path);
    std::error_code error;
    std::string text = files::whole_file(path, error);
    if (error == std::errc::no_such_file_or_directory) return fmt::format("cannot read {}", path);
    if (error) throw SystemError(fmt::format("'{}': cannot be read: {}", path, error.message()));
    if (content_hash(text) != file.hash)
        return fmt::format("{} has changed since the campaign was read; run the campaign file again", path);
    return FileContents{std::move(text)};
}

std::variant<Files, std::string> files_named(const Inputs& inputs) {
    Files files;
    for (const auto& [name, value] : inputs) {
        const auto* word = std::get_if<std::string>(&value);
        const auto file = word == nullptr ? std::nullopt : file_word(*word);
        if (!file) continue;
        auto read = contents_of(*file);
        if (const auto* why = std::get_if<std::string>(&read)) return fmt::format("{}: {}", name, *why);
        files.emplace(name, std::move(std::get<FileContents>(read).text));
    }
    return files;
}

}  // namespace grainsweep::campaign
