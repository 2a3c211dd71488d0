// A machine as a scene: what a machine file says, as text and as the scene that plans, archives and reports see. The
// name of the scene is "machine:" and the hash of what changes an answer: the text without notes, meanings, bounds, the
// machine's own name and names of files, and the contents of the files. What is shown is the machine's own name.
#pragma once

#include "solver/scenes/scene.hpp"

#include <nlohmann/json_fwd.hpp>

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

/// The word of a campaign file, and how the names of all such scenes begin.
inline constexpr std::string_view machine_word = "machine";
inline constexpr std::string_view machine_prefix = "machine:";
[[nodiscard]] inline bool is_machine(std::string_view scene) {
    return scene.starts_with(machine_prefix);
}

struct Machine {
    std::string name, summary;
    std::shared_ptr<const nlohmann::json> document;         ///< the file as read
    std::map<std::string, std::string, std::less<>> files;  ///< contents, by the name in the document
    std::vector<ParameterSpec> parameters;
    std::vector<ObservableSpec> observables;
};

/// Returns the contents of a file that the document names. Throws std::invalid_argument where there is none.
using FileReader = std::function<std::string(const std::string& name)>;

/// Reads and checks a machine completely, with its default parameters. Throws WrongQuestion with the path from `root`
/// on.
[[nodiscard]] std::shared_ptr<const Machine> make_machine(nlohmann::json document, std::string root,
                                                          const FileReader& read_file);
/// Reads files of a folder.
[[nodiscard]] FileReader beside(const std::filesystem::path& folder);
/// Whether a JSON document looks like a machine and not like a campaign.
[[nodiscard]] bool is_machine_document(const nlohmann::json& document);
/// A machine file, and the files beside it.
[[nodiscard]] std::shared_ptr<const Machine> read_machine(const std::filesystem::path& file);
/// The machine as numbers, for complete inputs and the contents of files that they name. Throws WrongQuestion.
[[nodiscard]] machine::Spec machine_spec(const Machine& machine, const Inputs& inputs, const Files& files = {});

/// What a machine is, in one line.
[[nodiscard]] std::string_view machine_summary();
/// "machine:" and 32 hexadecimal digits.
[[nodiscard]] std::string machine_scene_name(const Machine& machine);
/// The document and the hashes of its files, as JSON; and back, with the contents by their hash. The second throws
/// std::invalid_argument for another text.
[[nodiscard]] std::string machine_text(const Machine& machine);
[[nodiscard]] std::shared_ptr<const Machine> machine_in(std::string_view text, const FileReader& contents_of_hash);

/// Makes the machine's scene known to this process, for its lifetime.
const SceneInfo& enter_machine(std::shared_ptr<const Machine> machine);
/// nullptr where no such machine was entered.
[[nodiscard]] std::shared_ptr<const Machine> known_machine(std::string_view scene);

}  // namespace grainsweep::campaign
