#include "sweep/report/watch_page.hpp"

#include "solver/scenes/scene.hpp"
#include "sweep/campaign/program.hpp"
#include "sweep/report/packed_column.hpp"
#include "sweep/report/page_files.hpp"
#include "sweep/report/page_template.hpp"
#include "sweep/report/table.hpp"

#include <fmt/format.h>
#include <array>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace grainsweep::report {
namespace {

Json entry(const std::string& name, const Json& value, const std::string& unit) {
    return std::array<Json, 3>{name, value, unit};
}

}  // namespace

Json about_case(const campaign::Case& question, const campaign::CaseResult& result) {
    const auto scene = find_scene(question.scene);
    std::string title = shown_scene(question.scene);
    std::ranges::replace(title, '_', ' ');
    const std::string message = result.outcome == campaign::Outcome::completed
                                    ? result.message
                                    : fmt::format("{}: {}", campaign::to_string(result.outcome), result.message);
    Json inputs = Json::array(), results = Json::array();
    if (scene != nullptr) {
        for (const auto& parameter : scene->parameters)
            if (const auto found = question.inputs.find(parameter.name); found != question.inputs.end())
                inputs.push_back(entry(parameter.name, to_json(to_cell(found->second)), parameter.unit));
        for (const auto& observable : scene->observables)
            if (const auto found = result.observations.scalars.find(observable.name);
                found != result.observations.scalars.end() && std::isfinite(found->second))
                results.push_back(entry(observable.name, found->second, observable.unit));
    }
    return {
        {"title", title},      {"name", shown_scene(question.scene) + "_" + question.id.substr(0, 8)},
        {"case", question.id}, {"subtitle", fmt::format("case {}, seed {}", question.id.substr(0, 10), question.seed)},
        {"message", message},  {"inputs", inputs},
        {"results", results}};
}

Json about_machine(const SceneInfo& machine, const Inputs& inputs, const std::string& message) {
    Json shown = Json::array();
    for (const auto& parameter : machine.parameters)
        if (const auto found = inputs.find(parameter.name); found != inputs.end())
            shown.push_back(entry(parameter.name, to_json(to_cell(found->second)), parameter.unit));
    std::string title = machine.shown();
    std::ranges::replace(title, '_', ' ');
    return {{"title", title},
            {"name", machine.shown()},
            {"case", ""},
            {"drawing", true},
            {"subtitle", "the machine before it runs: walls move, particles stay where they are filled in"},
            {"message", message},
            {"inputs", shown},
            {"results", Json::array()}};
}

std::string watch_page(const Film& film, const Json& about) {
    if (!film.shows_anything()) throw std::invalid_argument("a film without particles, walls or a flow");
    const auto files = page_files();
    const auto program = enclosed(files.watch), sources = script_sources({program});
    const std::string text = base64(film.bytes(about));
    std::ostringstream page;
    fill(page, files.watch_skeleton,
         {{"scripts", sources}, {"style", files.watch_style}, {"film", text}, {"program", program}});
    return std::move(page).str();
}

}  // namespace grainsweep::report
