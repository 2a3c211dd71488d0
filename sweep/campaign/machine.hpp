// Machine as a scene: the text of a machine file, and the scene for plans, databases and reports. The name of the scene
// is "machine:" and a hash of everything that changes an answer: the contents of the files, and the text. Notes,
// meanings, bounds, the machine's own name and names of files are not included. The machine's own name is shown to
// users.
#pragma once

#include "solver/scenes/scene.hpp"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::machine {
struct Spec;
}

namespace grainsweep::campaign {

/// Word in a campaign file, and prefix of the names of all such scenes.
inline constexpr std::string_view machine_word = "machine";
inline constexpr std::string_view machine_prefix = "machine:";
[[nodiscard]] inline bool is_machine(std::string_view scene) {
    return scene.starts_with(machine_prefix);
}

struct Machine {
    std::string name, summary;
    std::shared_ptr<const nlohmann::json> document;         ///< the parsed file
    std::map<std::string, std::string, std::less<>> files;  ///< contents, by the name in the document
    std::vector<ParameterSpec> parameters;
    std::vector<std::string> unused;  ///< parameters that nothing in the document names
    std::vector<ObservableSpec> observables;
    std::vector<MainObservable> shown;                    ///< in short tables; empty: the first ones
    std::map<std::string, Inputs, std::less<>> accuracy;  ///< as of SceneInfo
};

/// Function that returns the contents of a file that the document names. Throws std::invalid_argument if there is none.
using FileReader = std::function<std::string(const std::string& name)>;

/// Reads and checks a machine completely, with its default parameters. Throws InputError with the path, beginning at
/// `root`.
[[nodiscard]] std::shared_ptr<const Machine> make_machine(nlohmann::json document, std::string root,
                                                          const FileReader& read_file);
/// Returns a function that reads files of a folder.
[[nodiscard]] FileReader beside(const std::filesystem::path& folder);
/// Returns whether a JSON document looks like a machine and not like a campaign.
[[nodiscard]] bool is_machine_document(const nlohmann::json& document);
/// Reads a machine file and the files beside it.
[[nodiscard]] std::shared_ptr<const Machine> read_machine(const std::filesystem::path& file);
/// Returns the machine as numbers, for complete inputs and the contents of their files. Throws InputError.
[[nodiscard]] machine::Spec machine_spec(const Machine& machine, const Inputs& inputs, const Files& files = {});

/// Calls show(picture, time) of a machine before it runs, for equally spaced times from the start to the latest end. If
/// the fillings do not fit, the machine is drawn without particles; returns why they do not, in one sentence, else
/// empty. Throws InputError if the combination of inputs is impossible otherwise.
[[nodiscard]] std::string draw_machine(const Machine& machine, const Inputs& inputs, std::int64_t frames,
                                       const std::function<void(const Snapshot&, double time)>& show);

/// Returns the value in the unit with which expressions of a machine calculate: "12.6 rad/s" for 120 rpm. Empty: it is
/// the unit of the parameter.
[[nodiscard]] std::string value_in_expressions(const std::string& unit, double value);

/// Returns a description of machines in one line.
[[nodiscard]] std::string_view machine_summary();
/// Returns "machine:" and 32 hexadecimal digits.
[[nodiscard]] std::string machine_scene_name(const Machine& machine);
/// Convert a machine to JSON with the hashes of its files, and back with the contents by their hash. The second throws
/// std::invalid_argument for another text.
[[nodiscard]] std::string machine_text(const Machine& machine);
[[nodiscard]] std::shared_ptr<const Machine> machine_in(std::string_view text, const FileReader& contents_of_hash);

/// Registers the machine's scene in this process.
SharedScene enter_machine(std::shared_ptr<const Machine> machine);
/// Returns the registered machine of a scene; nullptr if there is none.
[[nodiscard]] std::shared_ptr<const Machine> known_machine(std::string_view scene);

}  // namespace grainsweep::campaign
