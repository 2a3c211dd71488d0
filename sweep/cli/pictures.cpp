#include "sweep/cli/pictures.hpp"

#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/quantity.hpp"
#include "sweep/cli/page_file.hpp"
#include "sweep/report/file_size.hpp"
#include "sweep/report/film.hpp"
#include "sweep/report/table.hpp"
#include "sweep/report/vtk_file.hpp"
#include "sweep/report/vtk_series.hpp"
#include "sweep/report/watch_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <sstream>
#include <system_error>
#include <utility>
#include <variant>

namespace grainsweep::cli {
namespace {

constexpr std::int64_t usual_frames = 60;
constexpr FileKind contact_table{"table of contacts", "first,second,wall"};

double time_in(const std::string& text) {
    const auto time = campaign::in_si(text, "s");
    const auto* number = std::get_if<double>(&time);
    if (number == nullptr || !(*number >= 0) || !std::isfinite(*number))
        throw campaign::input_error("--contacts-at", fmt::format("'{}'", text),
                                    "must be a time, such as 0.2s or 150ms");
    return *number;
}

/// Returns a row per contact; "second" or "wall" is empty.
store::Table table_of_contacts(const ContactLines& contacts) {
    store::Table table{{"first", "second", "wall", "x", "y", "z", "to_x", "to_y", "to_z"}, {}};
    constexpr std::array<std::string_view, 3> own = {"first", "second", "wall"};
    const auto is_own = [&](const std::string& name) { return std::ranges::find(own, name) != own.end(); };
    for (const auto& [name, values] : contacts.scalars)
        if (!is_own(name)) table.columns.push_back(name);
    for (const auto& [name, values] : contacts.vectors)
        for (const char axis : {'x', 'y', 'z'}) table.columns.push_back(fmt::format("{}_{}", name, axis));
    const auto number = [&](std::string_view column, std::size_t k) {
        return static_cast<std::int64_t>(contacts.scalars.find(column)->second[k]);
    };
    for (std::size_t k = 0; k < contacts.ends.size(); ++k) {
        auto& row = table.rows.emplace_back();
        const std::int64_t second = number("second", k), wall = number("wall", k);
        row.emplace_back(number("first", k));
        row.push_back(second < 0 ? store::Table::Cell{} : store::Table::Cell{second});
        if (wall < 0)
            row.emplace_back();
        else if (const auto w = static_cast<std::size_t>(wall); w < contacts.walls.size())
            row.emplace_back(contacts.walls[w]);
        else
            row.emplace_back(wall);
        for (const auto& end : contacts.ends[k])
            for (const double x : end) row.push_back(report::to_cell(x));
        for (const auto& [name, values] : contacts.scalars)
            if (!is_own(name)) row.push_back(report::to_cell(values[k]));
        for (const auto& [name, values] : contacts.vectors)
            for (const double x : values[k]) row.push_back(report::to_cell(x));
    }
    return table;
}

}  // namespace

void declare_pictures(Parser& parser, PictureRequest& request) {
    parser.add_option("--vtk DIR", request.folder,
                      "folder for ParaView files: particles and walls (VTP), flow (VTI or VTR), a PVD series");
    parser.add_option("--watch FILE.html", request.page, "HTML page that plays the case in three dimensions");
    parser
        .add_option("--frames N", request.frames,
                    fmt::format("number of pictures, evenly from start to end, for --vtk or --watch; default: {}",
                                usual_frames))
        ->check(whole_number(2, 9999));
    parser.add_flag("--forces", request.forces,
                    "with --watch: the page also draws the normal forces between particles");
    parser.add_option("--contacts FILE.csv", request.contacts,
                      "table of all contacts of one instant: partners, places, forces, overlap");
    parser.add_option("--contacts-at TIME", request.contacts_at,
                      "with --contacts: the instant, such as 0.2s or 150ms; default: the end");
}

Pictures::Pictures(PictureRequest request, campaign::Case question)
    : request_(std::move(request)), question_(std::move(question)) {
    if (request_.frames && request_.page.empty() && request_.folder.empty())
        throw campaign::input_error("--frames", std::to_string(*request_.frames), "needs --watch or --vtk");
    if (request_.forces && request_.page.empty()) throw campaign::input_error("--forces", "", "needs --watch");
    if (!request_.contacts_at.empty()) {
        if (request_.contacts.empty())
            throw campaign::input_error("--contacts-at", request_.contacts_at, "needs --contacts");
        contacts_at_ = time_in(request_.contacts_at);
    }
    if (!request_.contacts.empty()) check_page_file("--contacts", request_.contacts, "", contact_table);
    if (!request_.page.empty()) {
        check_page_file("--watch", request_.page, "");
        film_ = std::make_unique<report::Film>(report::FilmLimits{.forces = request_.forces});
    }
    if (std::filesystem::exists(request_.folder) && !std::filesystem::is_directory(request_.folder))
        throw campaign::input_error("--vtk", request_.folder, "must be a folder; there is a file of this name");
    if (!request_.folder.empty())
        series_ = std::make_unique<report::VtkSeries>(request_.folder, shown_scene(question_.scene));
}

Pictures::~Pictures() = default;

workers::Camera Pictures::camera() {
    workers::Camera camera;
    if (!request_.contacts.empty()) {
        camera.at_moment = [this](const Scene& scene) { list_contacts(scene); };
        if (contacts_at_) camera.moment = *contacts_at_;
    }
    if (!series_ && !film_) return camera;
    camera.frames = request_.frames.value_or(usual_frames);
    camera.shoot = [this](const Scene& scene) { shoot(scene); };
    camera.keep = [this](const std::vector<std::size_t>& pictures) {
        if (series_) series_->keep(pictures);
        if (film_) film_->keep(pictures);
    };
    return camera;
}

void Pictures::list_contacts(const Scene& scene) {
    const Snapshot snapshot = scene.snapshot();
    if (!snapshot.contacts)
        throw campaign::input_error("--contacts", "",
                                    fmt::format("scene '{}' has no contacts", shown_scene(question_.scene)));
    std::ostringstream text;
    report::write(text, table_of_contacts(*snapshot.contacts), report::Format::csv);
    write_page_file(request_.contacts, text.str());
    listed_contacts_ = snapshot.contacts->ends.size();
    listed_at_ = scene.time();
}

void Pictures::shoot(const Scene& scene) {
    const Snapshot snapshot = scene.snapshot();
    if (!any_ && !report::shows_particles(snapshot) && snapshot.fields.empty())
        throw campaign::input_error(
            film_ ? "--watch" : "--vtk", "",
            fmt::format("scene '{}' shows no particles and no flow", shown_scene(question_.scene)));
    any_ = true;
    if (series_) series_->add(snapshot, scene.time());
    if (film_) film_->add(snapshot, scene.time());
}

void Pictures::finish(const campaign::CaseResult& result) {
    if (!film_ || !any_) return;
    const std::string page = report::watch_page(*film_, report::about_case(question_, result));
    write_page_file(request_.page, page);
    page_bytes_ = page.size();
}

void Pictures::say(bool on_standard_output) const {
    std::ostream& out = on_standard_output ? std::cout : std::cerr;
    if (listed_contacts_) {
        const bool early = contacts_at_ && listed_at_ < *contacts_at_;
        out << fmt::format("{}: {} contacts at {:.6g} s{}\n", request_.contacts, *listed_contacts_, listed_at_,
                           early ? ", where the case ended" : "");
    }
    if (!request_.contacts.empty() && !listed_contacts_) out << "no contacts: nothing was simulated\n";
    if ((series_ || film_) && !any_) out << "no pictures: nothing was simulated\n";
    if (!any_) return;
    if (film_)
        out << fmt::format("{} ({}): {} frame{} of {} particles; open it in a browser\n", request_.page,
                           report::size_text(page_bytes_), film_->frames(), film_->frames() == 1 ? "" : "s",
                           film_->spheres());
    if (request_.forces && !film_->shows_forces())
        out << "no forces on the page: a film of more than 65,536 spheres has none\n";
    if (!series_) return;
    std::uintmax_t bytes = 0;
    std::size_t files = 0;
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator(request_.folder, none)) {
        if (!entry.path().filename().string().starts_with(shown_scene(question_.scene))) continue;
        bytes += entry.file_size(none);
        ++files;
    }
    out << fmt::format("pictures: {} files, {}; open {} in ParaView\n", files, report::size_text(bytes),
                       series_->collection().string());
}

}  // namespace grainsweep::cli
