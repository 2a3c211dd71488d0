#include "solver/scenes/catalogue.hpp"

#include "solver/dem/fast/mixed_engine.hpp"
#include "solver/scenes/scene.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <map>
#include <mutex>
#include <stdexcept>

namespace grainsweep {

const ParameterSpec* SceneInfo::find_parameter(std::string_view parameter) const {
    const auto found = std::ranges::find(parameters, parameter, &ParameterSpec::name);
    return found == parameters.end() ? nullptr : &*found;
}

const ObservableSpec* SceneInfo::find_observable(std::string_view observable) const {
    const auto found = std::ranges::find(observables, observable, &ObservableSpec::name);
    return found == observables.end() ? nullptr : &*found;
}

Inputs SceneInfo::defaults() const {
    Inputs inputs;
    for (const auto& parameter : parameters) inputs.emplace(parameter.name, parameter.default_value);
    return inputs;
}

std::span<const SceneInfo> scene_catalogue() {
    static const std::vector<SceneInfo> scenes = {
        rehearsal_scene(),
        thermovibration_scene(),
    };
    return scenes;
}

namespace {

struct Entered {
    std::mutex mutex;
    std::map<std::string, SharedScene, std::less<>> scenes;
};

Entered& entered() {
    static Entered all;
    return all;
}

}  // namespace

SharedScene enter_scene(SceneInfo scene) {
    auto& all = entered();
    const std::lock_guard lock(all.mutex);
    auto& known = all.scenes[scene.name];
    return known = std::make_shared<const SceneInfo>(std::move(scene));
}

SharedScene find_scene(std::string_view name) {
    const auto scenes = scene_catalogue();
    if (const auto own = std::ranges::find(scenes, name, &SceneInfo::name); own != scenes.end()) return unowned(*own);
    auto& all = entered();
    const std::lock_guard lock(all.mutex);
    const auto found = all.scenes.find(name);
    return found == all.scenes.end() ? nullptr : found->second;
}

std::string shown_scene(std::string_view name) {
    const auto known = find_scene(name);
    return known != nullptr ? known->shown() : std::string(name);
}

namespace {

#if defined(__x86_64__)
constexpr std::array<std::string_view, 2> path_words = {"avx2", "avx512"};
constexpr std::array paths = {dem::Method::Path::avx2, dem::Method::Path::avx512};
#else
constexpr std::array<std::string_view, 1> path_words = {"baseline"};
constexpr std::array paths = {dem::Method::Path::baseline};
#endif

}  // namespace

std::span<const std::string_view> instruction_path_words() {
    return path_words;
}

bool choose_instruction_path(std::string_view word) {
    const auto at = std::ranges::find(path_words, word);
    if (at == path_words.end()) throw std::invalid_argument("there is no instruction path of this name");
    const auto path = paths[static_cast<std::size_t>(at - path_words.begin())];
    if (!dem::fast::supports(path)) return false;
    dem::fast::prefer(path);
    return true;
}

namespace {

std::atomic<int>& threads() {
    static std::atomic<int> allowed = 1;
    return allowed;
}

}  // namespace

void allow_threads(int count) {
    threads() = count;
}

int allowed_threads() {
    return threads();
}

std::string_view instruction_path() {
    const auto at = std::ranges::find(paths, dem::fast::best_path());
    return path_words[static_cast<std::size_t>(at - paths.begin())];
}

bool processor_suffices() {
    return dem::fast::supports(dem::Method::Path::best);
}

std::string unsupported_processor(bool suffices) {
    if (suffices) return "";
    return "this processor lacks AVX2, which the program needs: Intel Core has it since 2013, AMD since 2015.";
}

}  // namespace grainsweep
