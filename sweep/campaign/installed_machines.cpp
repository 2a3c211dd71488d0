#include "sweep/campaign/installed_machines.hpp"

#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/json_text.hpp"
#include "sweep/campaign/machine.hpp"
#include "sweep/files/whole_file.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <mutex>
#include <stdexcept>

namespace grainsweep::campaign {
namespace {

constexpr std::string_view machine_ending = ".json";
constexpr std::size_t largest_campaign_text = 64ULL << 20U;

const InstalledFile* find_installed(std::string_view name) {
    const auto all = installed_files();
    const auto found = std::ranges::find(all, name, &InstalledFile::name);
    return found == all.end() ? nullptr : &*found;
}

}  // namespace

std::vector<std::string> installed_machines() {
    std::vector<std::string> names;
    for (const auto& file : installed_files())
        if (file.name.ends_with(machine_ending))
            names.emplace_back(file.name.substr(0, file.name.size() - machine_ending.size()));
    return names;
}

std::string_view kind_of_installed(std::string_view name) {
    const auto* file = find_installed(std::string(name) + std::string(machine_ending));
    return file == nullptr ? std::string_view() : file->kind;
}

std::shared_ptr<const Machine> installed_machine(std::string_view name) {
    const auto* file = find_installed(std::string(name) + std::string(machine_ending));
    if (file == nullptr) return nullptr;
    return make_machine(parse_json(file->contents), "$", [](const std::string& beside) {
        const auto* found = find_installed(beside);
        if (found == nullptr) throw std::logic_error("a machine that is installed names a file that is not: " + beside);
        return std::string(found->contents);
    });
}

SharedScene scene_named(std::string_view word) {
    if (auto scene = find_scene(word)) return scene;
    static std::mutex mutex;
    static std::map<std::string, SharedScene, std::less<>> entered;
    const std::lock_guard lock(mutex);
    if (const auto known = entered.find(word); known != entered.end()) return known->second;
    auto machine = installed_machine(word);
    return machine == nullptr ? nullptr : (entered[machine->name] = enter_machine(machine));
}

std::vector<SharedScene> named_scenes() {
    std::vector<SharedScene> all;
    for (const auto& scene : scene_catalogue()) all.push_back(unowned(scene));
    for (const auto& name : installed_machines()) all.push_back(scene_named(name));
    return all;
}

std::shared_ptr<const Machine> machine_named(std::string_view where, const std::string& name) {
    std::error_code none;
    if (std::filesystem::is_regular_file(name, none)) return read_machine(name);
    if (auto machine = installed_machine(name)) return machine;
    throw input_error(where, name, "there is no such machine file, and no machine of this name is installed",
                      nearest_word(name, installed_machines()));
}

std::shared_ptr<const Machine> machine_if_any(const std::string& argument) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(argument, error)) return installed_machine(argument);
    const std::string text = files::whole_file(argument, error, largest_campaign_text);
    // A text that is no JSON is refused later, when it is read as a campaign file.
    const Json document = error ? Json() : Json::parse(text, nullptr, false);
    return is_machine_document(document) ? read_machine(argument) : nullptr;
}

}  // namespace grainsweep::campaign
