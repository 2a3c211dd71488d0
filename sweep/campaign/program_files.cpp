// "files" and "templates" of a program: the files in every case's folder.
#include "sweep/campaign/case.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/program_section.hpp"
#include "sweep/files/whole_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace grainsweep::campaign {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_files = 500;
constexpr std::size_t longest_name = 1000, longest_part = 200;
constexpr std::uintmax_t largest_file = 64ULL << 20U, largest_of_all = 256ULL << 20U, largest_template = 16ULL << 20U;
constexpr std::array<std::string_view, 4> names_of_ours = {"inputs.json", "outcome.json", "stdout.txt", "stderr.txt"};

/// A file of the campaign's folder, or of one below it, links followed.
fs::path source_of(const Cursor& place, const std::string& name, const fs::path& folder) {
    std::error_code error;
    const fs::path root = fs::weakly_canonical(fs::absolute(folder.empty() ? "." : folder, error), error);
    const fs::path path = fs::canonical(root / name, error);
    if (error || !fs::is_regular_file(path, error)) {
        std::vector<std::string> beside;
        for (const auto& entry : fs::directory_iterator((root / name).parent_path(), error))
            beside.push_back((fs::path(name).parent_path() / entry.path().filename()).string());
        place.refuse("there is no such file beside the campaign file", nearest_word(name, beside));
    }
    const auto [at, end] = std::mismatch(root.begin(), root.end(), path.begin(), path.end());
    if (at != root.end()) place.refuse("it is a link that leaves the folder of the campaign file");
    return path;
}

void read_file(const Cursor& place, const fs::path& folder, bool is_template, Program& program) {
    ProgramFile file{read_file_name(place), {}, is_template};
    if (std::ranges::find(names_of_ours, file.name) != names_of_ours.end())
        place.refuse("a file of this name is written into every case's folder");
    for (const auto& other : program.files) {
        if (other.name == file.name) place.refuse("this file is there twice");
        if (other.name.starts_with(file.name + "/") || file.name.starts_with(other.name + "/"))
            place.refuse(fmt::format("'{}' cannot be a file and a folder", std::min(other.name, file.name)));
    }
    const auto path = source_of(place, file.name, folder);
    std::error_code error;
    const auto size = fs::file_size(path, error);
    if (error || size > (is_template ? largest_template : largest_file))
        place.refuse(fmt::format("has at most {} MiB; larger data are named by an absolute path in the command",
                                 (is_template ? largest_template : largest_file) >> 20U));
    file.contents = files::whole_file(path, error);
    if (error) place.refuse(fmt::format("the file cannot be read: {}", error.message()));
    if (file.contents.size() != size) place.refuse("the file changed while it was read");
    if (is_template && file.contents.find('\0') != std::string::npos)
        place.refuse("is no text file; what is copied as it is belongs to \"files\"");
    file.hash = content_hash(file.contents);
    const auto mode = fs::status(path, error).permissions();
    file.executable = (mode & fs::perms::owner_exec) != fs::perms::none;
    program.files.push_back(std::move(file));
}

}  // namespace

std::string_view flaw_of_file_name(std::string_view name) {
    if (name.empty()) return "no empty name";
    if (name.size() > longest_name) return "at most 1000 bytes";
    if (name.front() == '/') return "no absolute path";
    if (std::ranges::any_of(name, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }))
        return "no control characters";
    for (std::size_t from = 0; from <= name.size();) {
        const auto to = std::min(name.find('/', from), name.size());
        const auto part = name.substr(from, to - from);
        if (part.empty() || part == ".") return "no empty part and no '.'";
        if (part == "..") return "no '..'";
        if (part.size() > longest_part) return "at most 200 bytes between slashes";
        from = to + 1;
    }
    return {};
}

std::string read_file_name(const Cursor& place) {
    auto name = place.text();
    if (const auto flaw = flaw_of_file_name(name); !flaw.empty())
        place.refuse(fmt::format("must be a file name within the case's folder: {}", flaw));
    return name;
}

void read_program_files(const Section& section, const fs::path& folder, Program& program) {
    for (const char* key : {"files", "templates"}) {
        const auto list = section.find(key);
        if (!list) continue;
        for (const auto& place : list->elements()) {
            if (program.files.size() >= most_files) place.refuse(fmt::format("at most {} files", most_files));
            read_file(place, folder, std::string_view(key) == "templates", program);
            std::uintmax_t total = 0;
            for (const auto& file : program.files) total += file.contents.size();
            if (total > largest_of_all)
                place.refuse(fmt::format("all files together have at most {} MiB", largest_of_all >> 20U));
        }
    }
    std::ranges::sort(program.files, {}, &ProgramFile::name);
    const auto others = section.find("does_not_count");
    if (!others) return;
    for (const auto& place : others->elements()) {
        const auto file = std::ranges::find(program.files, place.text(), &ProgramFile::name);
        if (file == program.files.end())
            place.refuse("names no file of \"files\" or \"templates\"",
                         nearest_word(place.text(), names_of(program.files)));
        file->counts = false;
    }
}

}  // namespace grainsweep::campaign
