// shape: spheres that cover an STL file.
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/machine_shape_file.hpp"
#include "sweep/cli/command.hpp"
#include "sweep/cli/page_file.hpp"
#include "sweep/files/whole_file.hpp"
#include "sweep/report/result.hpp"
#include "sweep/report/results/catalogues.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <system_error>

namespace grainsweep::cli {
namespace {

using report::Format;

constexpr std::size_t largest_stl = 256ULL << 20U;

struct ShapeRequest {
    std::string file, output;
    std::optional<std::int64_t> spheres;
    double error = 0;
};

int write_shape(const ShapeRequest& request, Format format) {
    namespace fs = std::filesystem;
    std::error_code error;
    check_converted_file(request.output, request.file, "STL file", {"list of spheres", "x,y,z,"});
    const std::string contents = files::whole_file(request.file, error, largest_stl);
    if (error) throw campaign::input_error("FILE", request.file, fmt::format("cannot be read: {}", error.message()));
    campaign::ShapeFile shape;
    try {
        shape = campaign::shape_of_stl(contents, request.spheres,
                                       request.error != 0 ? std::optional(request.error) : std::nullopt);
    } catch (const std::invalid_argument& why) {
        throw campaign::input_error("FILE", request.file, why.what());
    }
    write_page_file(request.output, shape.csv);

    store::Table table{report::columns_of(report::results::shape_number), {}};
    const auto row = [&](const char* what, double value) { table.rows.push_back({std::string(what), value}); };
    row("spheres", static_cast<double>(shape.spheres));
    row("shared volume divided by the volume", shape.overlap);
    row("volume of the body, unit of the file", shape.volume);
    row("diameter of the sphere of equal volume, unit of the file", shape.diameter);
    row("smallest sphere divided by this diameter", shape.smallest);
    row("largest relative error of a moment of inertia", shape.inertia_error);
    row("cost of a grain divided by a sphere's, about", shape.cost);
    report::write(std::cout, table, format);
    if (format == Format::text)
        std::cout << fmt::format("\n{}: in a machine file \"shape\": {{\"spheres\": \"{}\"}}\n", request.output,
                                 fs::path(request.output).filename().string());
    return 0;
}

}  // namespace

std::vector<Command> shape_commands() {
    const auto arguments = [](Parser& parser, ShapeRequest& request) {
        parser.add_option("FILE", request.file, "an STL file of one grain: a closed surface in any unit")->required();
        parser.add_option("-o,--output FILE.csv", request.output, "file of spheres to write: x,y,z,diameter");
        parser.add_option("--spheres N", request.spheres,
                          "largest number of spheres, 2 to 200; default: 16, fewer where they add little");
        parser.add_option("--error SHARE", request.error,
                          "enough spheres where they share all but this part of the volume, up to 0.5");
    };
    return {command<ShapeRequest>("shape", "covers an STL file of a grain with spheres, for the shape of a species",
                                  arguments, write_shape)};
}

}  // namespace grainsweep::cli
