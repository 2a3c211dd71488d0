// The machines that come with the program: configs/machines, compiled in.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep {
struct SceneInfo;
}

namespace grainsweep::campaign {

struct Machine;

struct InstalledFile {
    std::string_view name;
    std::string_view kind;  ///< its folder in configs/machines: "laboratory", or empty
    std::string_view contents;
};
[[nodiscard]] std::span<const InstalledFile> installed_files();

/// Names of the machines, sorted; machines of a kind stand behind the others.
[[nodiscard]] std::vector<std::string> installed_machines();
/// "laboratory" or another kind of an installed machine; empty where it has none.
[[nodiscard]] std::string_view kind_of_installed(std::string_view name);
/// One of them; nullptr where there is none of that name.
[[nodiscard]] std::shared_ptr<const Machine> installed_machine(std::string_view name);
/// The scene of this name, or of the installed machine of this name; nullptr where there is none.
[[nodiscard]] const SceneInfo* scene_named(std::string_view word);
/// What a campaign file may name as its scene: scenes of the program, then installed machines.
[[nodiscard]] std::vector<const SceneInfo*> named_scenes();

/// A machine file, or one that is installed, by a path or a name. Throws WrongQuestion, naming `where`.
[[nodiscard]] std::shared_ptr<const Machine> machine_named(std::string_view where, const std::string& name);

/// The machine that an argument names: a machine file, or one that is installed; nullptr where it is something else.
[[nodiscard]] std::shared_ptr<const Machine> machine_if_any(const std::string& argument);

}  // namespace grainsweep::campaign
