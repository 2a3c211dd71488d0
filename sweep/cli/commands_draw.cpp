// draw: a machine in three dimensions before it runs.
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/machine.hpp"
#include "sweep/cli/asked_case.hpp"
#include "sweep/cli/command.hpp"
#include "sweep/cli/page_file.hpp"
#include "sweep/report/file_size.hpp"
#include "sweep/report/film.hpp"
#include "sweep/report/result.hpp"
#include "sweep/report/results/catalogues.hpp"
#include "sweep/report/watch_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <memory>

namespace grainsweep::cli {
namespace {

constexpr std::int64_t usual_pictures = 121;

struct DrawRequest {
    std::string config, page;
    std::vector<std::string> settings;  ///< NAME=VALUE
    std::int64_t frames = usual_pictures;
};

int draw(const DrawRequest& request, report::Format format) {
    check_page_file("-o", request.page, "");
    const auto question = asked_case(request.config, request.settings, {}).question;
    const auto scene = find_scene(question.scene);
    const auto machine = campaign::known_machine(question.scene);
    if (machine == nullptr)
        throw campaign::input_error("CONFIG", request.config,
                                    fmt::format("scene '{}' is no machine: only machines are drawn", scene->shown()));
    const Inputs& inputs = question.inputs;
    report::Film film;
    std::string empty = campaign::draw_machine(
        *machine, inputs, request.frames, [&film](const Snapshot& picture, double time) { film.add(picture, time); });
    if (!empty.empty()) {
        empty = "drawn without particles: " + empty;
        std::cerr << fmt::format("grainsweep: {}: {}\n", scene->shown(), empty);
    }
    const std::string page = report::watch_page(film, report::about_machine(*scene, inputs, empty));
    write_page_file(request.page, page);
    if (format == report::Format::json)
        report::write(std::cout, report::Result<report::results::drawing>{
                                     {"machine", scene->shown()},
                                     {"page", request.page},
                                     {"particles", static_cast<std::int64_t>(film.spheres())}});
    else
        std::cout << fmt::format("{} ({}): {} with {} spheres; open it in a browser\n", request.page,
                                 report::size_text(page.size()), scene->shown(), film.spheres());
    return 0;
}

}  // namespace

std::vector<Command> draw_commands() {
    const auto arguments = [](Parser& parser, DrawRequest& request) {
        parser.add_option("CONFIG", request.config, "campaign file, machine file, or the name of an installed machine");
        parser
            .add_option(
                "--set NAME=VALUE", request.settings,
                "value of a parameter, a number with or without a unit, or a word; other factors of a campaign take "
                "the middle of their range")
            ->allow_extra_args(false);
        parser.add_option("-o,--output FILE.html", request.page, "HTML page to write")->required();
        parser.add_option("--frames N", request.frames, fmt::format("number of pictures; default: {}", usual_pictures))
            ->check(whole_number(2, 2000));
    };
    return {command<DrawRequest>(
        "draw", "draws a machine before it runs: an HTML page with its walls, motions, fillings and regions", arguments,
        draw)};
}

}  // namespace grainsweep::cli
