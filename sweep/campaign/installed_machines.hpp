// Machines that come with the program: configs/machines, compiled in.
#pragma once

#include "solver/scenes/scene.hpp"

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::campaign {

struct Machine;

struct InstalledFile {
    std::string_view name;
    std::string_view kind;  ///< folder in configs/machines: "laboratory", or empty
    std::string_view contents;
};
[[nodiscard]] std::span<const InstalledFile> installed_files();

/// Returns the names of the machines, sorted; machines of a kind come last.
[[nodiscard]] std::vector<std::string> installed_machines();
/// Returns the kind of an installed machine, such as "laboratory"; empty if it has none.
[[nodiscard]] std::string_view kind_of_installed(std::string_view name);
/// Returns an installed machine; nullptr if there is none of this name.
[[nodiscard]] std::shared_ptr<const Machine> installed_machine(std::string_view name);
/// Returns the scene of this name, or of the installed machine of this name; nullptr if there is none.
[[nodiscard]] SharedScene scene_named(std::string_view word);
/// Returns the possible scenes of a campaign file: scenes of the program, then installed machines.
[[nodiscard]] std::vector<SharedScene> named_scenes();

/// Returns the machine of a file path or the installed machine of a name. Throws InputError with `where`.
[[nodiscard]] std::shared_ptr<const Machine> machine_named(std::string_view where, const std::string& name);

/// Returns the machine that an argument names by file or name; nullptr if it names none.
[[nodiscard]] std::shared_ptr<const Machine> machine_if_any(const std::string& argument);

}  // namespace grainsweep::campaign
