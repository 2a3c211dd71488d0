#include "sweep/cli/pictures.hpp"

#include "sweep/campaign/input_error.hpp"
#include "sweep/cli/page_file.hpp"
#include "sweep/report/file_size.hpp"
#include "sweep/report/film.hpp"
#include "sweep/report/vtk_file.hpp"
#include "sweep/report/vtk_series.hpp"
#include "sweep/report/watch_page.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <iostream>
#include <system_error>
#include <utility>

namespace grainsweep::cli {
namespace {

constexpr std::int64_t usual_frames = 60;

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
}

Pictures::Pictures(PictureRequest request, campaign::Case question)
    : request_(std::move(request)), question_(std::move(question)) {
    if (request_.frames && request_.page.empty() && request_.folder.empty())
        throw campaign::input_error("--frames", std::to_string(*request_.frames), "needs --watch or --vtk");
    if (!request_.page.empty()) {
        check_page_file("--watch", request_.page, "");
        film_ = std::make_unique<report::Film>();
    }
    if (!request_.folder.empty())
        series_ = std::make_unique<report::VtkSeries>(request_.folder, shown_scene(question_.scene));
}

Pictures::~Pictures() = default;

workers::Camera Pictures::camera() {
    if (!series_ && !film_) return {};
    return {request_.frames.value_or(usual_frames), [this](const Scene& scene) { shoot(scene); },
            [this](const std::vector<std::size_t>& pictures) {
                if (series_) series_->keep(pictures);
                if (film_) film_->keep(pictures);
            }};
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
    if ((series_ || film_) && !any_) out << "no pictures: nothing was simulated\n";
    if (!any_) return;
    if (film_)
        out << fmt::format("{} ({}): {} frame{} of {} particles; open it in a browser\n", request_.page,
                           report::size_text(page_bytes_), film_->frames(), film_->frames() == 1 ? "" : "s",
                           film_->spheres());
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
