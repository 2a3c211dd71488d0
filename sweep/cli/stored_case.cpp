#include "sweep/cli/stored_case.hpp"

#include "solver/scenes/scene.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/installed_machines.hpp"
#include "sweep/campaign/program.hpp"

#include <fmt/format.h>

namespace grainsweep::cli {

campaign::Case require_case(const store::Store& archive, const std::string& id) {
    auto found = archive.find_case(id);
    if (!found) throw campaign::input_error("CASE", id, "is not the id of a case of this database, nor its beginning");
    return *std::move(found);
}

std::string heading_of(const store::Store& archive, const campaign::CaseId& id) {
    std::string line = fmt::format("case {}", id);
    for (const auto& place : archive.places(id)) line += fmt::format(", point {} of {}", place.point, place.campaign);
    return line;
}

std::string why_not_again(const campaign::Case& question) {
    const auto scene = find_scene(question.scene);
    if (scene == nullptr && campaign::installed_machine(question.scene) != nullptr)
        return fmt::format(
            "is of scene '{0}' of an older program. Since then {0} is a machine, whose cases have other ids: run the "
            "campaign under another name in the same database, or replay it with the program that made it (grainsweep "
            "explain names it)",
            question.scene);
    if (scene == nullptr) return "needs a scene that this build does not have: " + question.scene;
    if (scene->revision == question.revision) return {};
    return fmt::format(
        "is of revision {} of scene '{}', and this build computes revision {}: "
        "replay it with the build that made it (grainsweep explain names it)",
        question.revision, question.scene, scene->revision);
}

campaign::Case as_asked_today(campaign::Case question) {
    if (const auto why = why_not_again(question); !why.empty()) throw campaign::input_error("CASE", question.id, why);
    for (const auto& [name, value] : find_scene(question.scene)->defaults()) question.inputs.try_emplace(name, value);
    return question;
}

std::optional<campaign::Case> origin_of(const store::Store& archive, const campaign::CaseResult& result) {
    constexpr std::size_t digits = 32;
    const auto at = result.message.find(adopted_from);  // the first one computed it, later ones adopted it
    if (at == std::string::npos) return std::nullopt;
    return archive.find_case(result.message.substr(at + adopted_from.size(), digits));
}

}  // namespace grainsweep::cli
