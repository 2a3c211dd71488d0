#include "sweep/workers/staged_campaign.hpp"

#include "sweep/campaign/file_contents.hpp"
#include "sweep/campaign/machine.hpp"

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>

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

void stage_contents(const std::string& contents, Artefacts& artefacts) {
    artefacts.put(std::string(contents_of) + campaign::content_hash(contents), bytes_of(contents));
}

void enter_machine(std::string_view scene, Artefacts& artefacts) {
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

}  // namespace

void stage_campaign(const campaign::Campaign& campaign, Artefacts& artefacts) {
    for (const auto& file : campaign.files)
        if (file.path.empty())
            if (const auto contents = campaign::known_contents(file.hash)) stage_contents(*contents, artefacts);
    const std::string& scene = campaign.scene().name;
    const auto machine = campaign::known_machine(scene);
    if (machine == nullptr) return;
    for (const auto& [name, contents] : machine->files) stage_contents(contents, artefacts);
    artefacts.put(std::string(definition_of) + scene, bytes_of(campaign::machine_text(*machine)));
}

void enter_staged(const campaign::Case& question, Artefacts& artefacts) {
    if (campaign::is_machine(question.scene) && find_scene(question.scene) == nullptr)
        enter_machine(question.scene, artefacts);
    for (const auto& [name, value] : question.inputs) {
        const auto* word = std::get_if<std::string>(&value);
        const auto file = word == nullptr ? std::nullopt : file_word(*word);
        if (!file || !campaign::is_made(*file) || campaign::known_contents(file->hash)) continue;
        if (const auto contents = artefacts.get(std::string(contents_of) + std::string(file->hash)))
            campaign::enter_contents(text_from(*contents));
    }
}

}  // namespace grainsweep::workers
