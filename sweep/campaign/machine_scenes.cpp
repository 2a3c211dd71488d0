// The scenes of machines, as far as this process has met them.
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/machine.hpp"
#include "sweep/campaign/machine_parameters.hpp"

#include "solver/machine/plan.hpp"
#include "solver/machine/run.hpp"

#include <map>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <utility>

namespace grainsweep::campaign {
namespace {

/// Part of every id; grows when results of machines change on purpose.
constexpr int machine_revision = 4;

struct Machines {
    std::mutex mutex;
    std::map<std::string, std::shared_ptr<const Machine>, std::less<>> by_scene;
};

Machines& machines() {
    static Machines all;
    return all;
}

/// A case that is impossible is no wrong question of the campaign file: it is rejected.
machine::Spec possible_spec(const Machine& machine, const Inputs& inputs, const Files& files) {
    try {
        return machine_spec(machine, inputs, files);
    } catch (const InputError& wrong) {
        throw std::invalid_argument(wrong.what());
    }
}

/// The machine of the last case: a plan asks for its cost and its warnings, one after the other.
class LastSpec {
public:
    explicit LastSpec(std::shared_ptr<const Machine> machine) : machine_(std::move(machine)) {}

    /// Returns ask(spec) of a case. Throws std::invalid_argument for an impossible one.
    auto of(const Inputs& inputs, const Files& files, auto ask) {
        const std::lock_guard lock(mutex_);
        if (!spec_ || inputs != inputs_ || files != files_) {
            spec_.reset();
            spec_ = possible_spec(*machine_, inputs, files);
            inputs_ = inputs, files_ = files;
        }
        return ask(*spec_);
    }

private:
    std::shared_ptr<const Machine> machine_;
    std::mutex mutex_;
    Inputs inputs_;
    Files files_;
    std::optional<machine::Spec> spec_;
};

SceneInfo scene_of_machine(const std::shared_ptr<const Machine>& machine, std::string name) {
    SceneInfo scene;
    scene.name = std::move(name);
    scene.label = machine->name;
    scene.summary = machine->summary;
    scene.revision = machine_revision;
    scene.parameters = machine->parameters;
    scene.observables = machine->observables;
    scene.main = machine->shown;
    scene.accuracy = machine->accuracy;
    scene.stiffness = stiffness_parameter;
    scene.maker = [machine](const Inputs& inputs, std::uint64_t seed, Artefacts& artefacts,
                            const Files& files) -> std::unique_ptr<Scene> {
        return std::make_unique<machine::Run>(possible_spec(*machine, inputs, files), seed, &artefacts);
    };
    const auto last = std::make_shared<LastSpec>(machine);
    scene.estimate_cost = [last](const Inputs& inputs, const Files& files) {
        return last->of(inputs, files, machine::cost_of);
    };
    scene.warnings = [last](const Inputs& inputs, const Files& files) {
        return last->of(inputs, files, machine::warnings_of);
    };
    return scene;
}

}  // namespace

std::string_view machine_summary() {
    return "your own granular experiment as one JSON file: walls, motions, powders, phases, measurements";
}

SharedScene enter_machine(std::shared_ptr<const Machine> machine) {
    auto scene = scene_of_machine(machine, machine_scene_name(*machine));
    auto& all = machines();
    const std::lock_guard lock(all.mutex);
    all.by_scene[scene.name] = std::move(machine);
    return enter_scene(std::move(scene));
}

std::shared_ptr<const Machine> known_machine(std::string_view scene) {
    auto& all = machines();
    const std::lock_guard lock(all.mutex);
    const auto found = all.by_scene.find(scene);
    return found == all.by_scene.end() ? nullptr : found->second;
}

}  // namespace grainsweep::campaign
