#include "sweep/workers/staged_machine.hpp"

#include "sweep/campaign/case.hpp"
#include "sweep/campaign/machine.hpp"

#include <span>
#include <stdexcept>
#include <string>

namespace grainsweep::workers {
namespace {

constexpr std::string_view definition_of = "definition\n", contents_of = "contents\n";

std::span<const std::byte> bytes_of(std::string_view text) {
    return std::as_bytes(std::span(text.data(), text.size()));
}

std::string text_from(const Bytes& bytes) {
    std::string text(bytes.size(), '\0');
    for (std::size_t k = 0; k < bytes.size(); ++k) text[k] = static_cast<char>(bytes[k]);
    return text;
}

}  // namespace

void stage_machine(std::string_view scene, Artefacts& artefacts) {
    const auto machine = campaign::known_machine(scene);
    if (machine == nullptr) return;
    for (const auto& [name, contents] : machine->files)
        artefacts.put(std::string(contents_of) + campaign::content_hash(contents), bytes_of(contents));
    artefacts.put(std::string(definition_of) + std::string(scene), bytes_of(campaign::machine_text(*machine)));
}

void enter_staged_machine(std::string_view scene, Artefacts& artefacts) {
    const auto definition = artefacts.get(std::string(definition_of) + std::string(scene));
    if (!definition) return;
    try {
        auto machine = campaign::machine_in(text_from(*definition), [&](const std::string& hash) {
            const auto contents = artefacts.get(std::string(contents_of) + hash);
            if (!contents) throw std::invalid_argument("a file of the machine is not staged");
            return text_from(*contents);
        });
        if (campaign::machine_scene_name(*machine) == scene) campaign::enter_machine(std::move(machine));
    } catch (const std::invalid_argument&) {  // the case is rejected: this worker has no such scene
    }
}

}  // namespace grainsweep::workers
