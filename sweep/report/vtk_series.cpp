#include "sweep/report/vtk_series.hpp"

#include "sweep/files/aside_file.hpp"
#include "sweep/files/system_error.hpp"
#include "sweep/files/whole_file.hpp"
#include "sweep/report/vtk_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <system_error>

namespace grainsweep::report {
namespace {

constexpr std::string_view particles = "particles";
constexpr std::string_view contacts = "contacts";
constexpr std::string_view contacts_part = "contacts of particles";  // no name of a wall has blanks

void write_file(const std::filesystem::path& path, const std::string& bytes) {
    std::error_code none;
    if (std::filesystem::is_symlink(std::filesystem::symlink_status(path, none)))
        throw SystemError("'" + path.string() + "' is a symbolic link; a picture does not replace it");
    files::AsideFile file(path);
    file.write(bytes);
    file.take_place();
}

bool same(const WallSurface& a, const WallSurface& b) {
    return a.corners == b.corners && a.triangles == b.triangles && a.edges == b.edges;
}

}  // namespace

VtkSeries::VtkSeries(std::filesystem::path folder, std::string name)
    : folder_(std::move(folder)), name_(std::move(name)) {}

std::string VtkSeries::file_of(std::string_view what, std::string_view extension) const {
    return fmt::format("{}{}{}_{:04}{}", name_, what.empty() ? "" : "_", what, written_, extension);
}

/// Files of an older series of this name would be mixed with the files of this one.
void VtkSeries::begin() {
    std::error_code error;
    std::filesystem::create_directories(folder_, error);
    if (error) throw SystemError(fmt::format("cannot make {}: {}", folder_.string(), error.message()));
    const std::string older = files::whole_file(collection(), error);  // none there, as a rule
    constexpr std::string_view before = "file=\"";
    for (std::size_t at = older.find(before); at != std::string::npos; at = older.find(before, at)) {
        at += before.size();
        const std::size_t end = older.find_first_of("\"/", at);
        if (end == std::string::npos || older[end] != '"') continue;
        const std::string file = older.substr(at, end - at);
        if (!file.ends_with(".vtp") && !file.ends_with(".vti") && !file.ends_with(".vtr")) continue;
        const bool own = std::filesystem::is_regular_file(std::filesystem::symlink_status(folder_ / file, error));
        if (own && file.starts_with(name_ + "_")) std::filesystem::remove(folder_ / file, error);
    }
}

void VtkSeries::list(std::string_view what, const std::string& file) {
    auto part = std::ranges::find(parts_, what);
    if (part == parts_.end()) part = parts_.insert(part, std::string(what));
    entries_.back().files.emplace_back(part - parts_.begin(), file);
}

void VtkSeries::write_collection() const {
    std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n<Collection>\n";
    for (const auto& [time, files] : entries_)
        for (const auto& [part, file] : files)
            text += fmt::format("<DataSet timestep=\"{}\" part=\"{}\" file=\"{}\" name=\"{}\"/>\n", time, part, file,
                                parts_[part]);
    write_file(collection(), text + "</Collection>\n</VTKFile>\n");
}

void VtkSeries::add(const Snapshot& snapshot, double time) {
    if (written_ == 0) begin();
    entries_.push_back({.time = time, .files = {}});
    if (shows_particles(snapshot)) {
        const std::string file = file_of("", ".vtp");
        write_file(folder_ / file, vtp(snapshot, time));
        list(particles, file);
    }
    if (snapshot.contacts) {
        // The number is in the middle, so that no wall of this name has the file.
        const std::string file = fmt::format("{}_{:04}_{}.vtp", name_, written_, contacts);
        write_file(folder_ / file, vtp(*snapshot.contacts, time));
        list(contacts_part, file);
    }
    for (const auto& wall : snapshot.walls) {
        auto& [shown, file] = walls_[wall.name];
        if (file.empty() || !same(shown, wall)) {
            file = file_of(wall.name, ".vtp");
            shown = wall;
            write_file(folder_ / file, vtp(wall, time));
        }
        list(wall.name, file);
    }
    for (const auto& field : snapshot.fields) {
        const std::string file = file_of(field.name, extension_of(field));
        write_file(folder_ / file, vtk_grid(field, time));
        list(field.name, file);
    }
    ++written_;
    write_collection();
}

void VtkSeries::keep(const std::vector<std::size_t>& moments) {
    std::set<std::string> all, needed;
    for (const auto& [name, wall] : walls_) needed.insert(wall.file);  // a later moment may name it again
    for (const Moment& moment : entries_)
        for (const auto& [part, file] : moment.files) all.insert(file);
    std::vector<Moment> kept;
    for (const std::size_t k : moments) {
        for (const auto& [part, file] : entries_[k].files) needed.insert(file);
        kept.push_back(std::move(entries_[k]));
    }
    entries_ = std::move(kept);
    write_collection();
    std::error_code error;
    for (const std::string& file : all)
        if (!needed.contains(file)) std::filesystem::remove(folder_ / file, error);
}

}  // namespace grainsweep::report
