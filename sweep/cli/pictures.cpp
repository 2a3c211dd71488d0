#include "sweep/cli/pictures.hpp"

#include "sweep/campaign/wrong_question.hpp"
#include "sweep/report/file_size.hpp"
#include "sweep/report/vtk_series.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <iostream>
#include <memory>
#include <system_error>

namespace grainsweep::cli {

void declare_pictures(Parser& parser, PictureRequest& request) {
    auto* folder =
        parser.add_option("--vtk", request.folder, "folder for pictures of the particles (VTP files and a PVD series)")
            ->type_name("DIR");
    parser.add_option("--frames", request.frames, "pictures from start to end")
        ->needs(folder)
        ->check(whole_number(2, 9999))
        ->capture_default_str();
}

workers::Camera camera(const PictureRequest& request, const std::string& scene) {
    if (request.folder.empty()) return {};
    const auto series = std::make_shared<report::VtkSeries>(request.folder, scene);
    return {request.frames, [series, scene](const Scene& seen) {
                const Snapshot snapshot = seen.snapshot();
                if (snapshot.positions.empty() && series->size() == 0)
                    throw campaign::wrong_question("--vtk", "", fmt::format("scene '{}' shows no particles", scene));
                series->add(snapshot, seen.time());
            }};
}

void say_pictures(const PictureRequest& request, const std::string& scene, bool on_standard_output) {
    if (request.folder.empty()) return;
    std::uintmax_t bytes = 0;
    std::size_t files = 0;
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator(request.folder, none)) {
        if (!entry.path().filename().string().starts_with(scene)) continue;
        bytes += entry.file_size(none);
        ++files;
    }
    (on_standard_output ? std::cout : std::cerr)
        << fmt::format("pictures: {} files, {}; open {} in ParaView\n", files, report::size_text(bytes),
                       report::VtkSeries(request.folder, scene).collection().string());
}

}  // namespace grainsweep::cli
