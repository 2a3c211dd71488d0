// The scenes of programs, as far as this process has met them.
#include "sweep/campaign/installed_machines.hpp"
#include "sweep/campaign/machine.hpp"
#include "sweep/campaign/program.hpp"
#include "sweep/campaign/program_warnings.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <mutex>
#include <stdexcept>
#include <utility>

namespace grainsweep::campaign {
namespace {

struct Register {
    std::mutex mutex;
    std::map<std::string, std::shared_ptr<const Program>, std::less<>> programs;
};

Register& entered() {
    static Register all;
    return all;
}

SceneInfo scene_of(const Program& program, std::string name) {
    SceneInfo scene;
    scene.name = std::move(name);
    scene.label = "program " + std::filesystem::path(program.command.front()).filename().string();
    scene.summary = "answered by " + program.command.front();
    for (const auto& parameter : program.parameters) {
        // Part of every id, so that the value of a default asks for nothing.
        const Value standard = parameter.standard.value_or(parameter.is_word() ? Value{std::string()} : Value{0.0});
        scene.parameters.push_back({parameter.name, parameter.unit, parameter.meaning, standard, parameter.bounds, {}});
    }
    for (const auto& observable : program.observables)
        scene.observables.push_back(
            {observable.name, observable.unit, observable.meaning, observable.shape, {}, "the program gave none"});
    scene.maker = [](const Inputs&, std::uint64_t, Artefacts&, const Files&) -> std::unique_ptr<Scene> {
        throw std::logic_error("a program is no scene of the solver");
    };
    for (const auto& setting : program.accuracy) scene.accuracy[setting.name] = setting.inputs;
    scene.estimate_cost = [seconds = program.cost_seconds, settings = program.accuracy](const Inputs& inputs,
                                                                                        const Files&) {
        const auto is_chosen = [&](const ProgramSetting& setting) {
            return std::ranges::all_of(setting.inputs, [&](const auto& one) {
                const auto found = inputs.find(one.first);
                return found != inputs.end() && found->second == one.second;
            });
        };
        const auto chosen = std::ranges::find_if(settings, is_chosen);
        const double own = chosen == settings.end() ? seconds : chosen->cost_seconds.value_or(seconds);
        return CostEstimate{.seconds = own, .particle_steps = 0, .bytes = 0};
    };
    scene.warnings = [placed = placed_names(program)](const Inputs& inputs, const Files&) {
        return format_warnings(placed, inputs);
    };
    return scene;
}

}  // namespace

SharedScene enter_program(std::shared_ptr<const Program> program) {
    auto scene = scene_of(*program, program_scene_name(*program));
    auto& all = entered();
    const std::lock_guard lock(all.mutex);
    all.programs[scene.name] = std::move(program);
    return enter_scene(std::move(scene));  // units and settings may be others than before
}

std::shared_ptr<const Program> known_program(std::string_view scene) {
    auto& all = entered();
    const std::lock_guard lock(all.mutex);
    const auto found = all.programs.find(scene);
    return found == all.programs.end() ? nullptr : found->second;
}

std::string why_absent(std::string_view scene, std::string_view observable) {
    const auto known = find_scene(scene);
    const ObservableSpec* spec = known == nullptr ? nullptr : known->find_observable(observable);
    return spec == nullptr ? std::string() : spec->absent;
}

std::vector<std::string> scene_words() {
    std::vector<std::string> words;
    for (const auto& scene : scene_catalogue()) words.push_back(scene.name);
    for (auto& machine : installed_machines()) words.push_back(std::move(machine));
    words.emplace_back(machine_word);
    words.emplace_back(program_word);
    return words;
}

std::string_view program_summary() {
    return "any program, deck or script: a command per case, or one process that answers line by line";
}

}  // namespace grainsweep::campaign
