#include "sweep/study/brackets.hpp"

#include "solver/scenes/scene.hpp"
#include "sweep/campaign/program.hpp"
#include "sweep/campaign/stored_identity.hpp"
#include "sweep/schedule/growth.hpp"

namespace grainsweep::study {

std::optional<Brackets> brackets_of(const store::Store& store, const store::CampaignRecord& record) {
    if (const auto* design = designs::find_design(record.design); design == nullptr || !design->brackets)
        return std::nullopt;
    auto request = campaign::request_of(record);
    Brackets brackets;
    brackets.factor = request.word("factor");
    brackets.observable = request.word("observable");
    brackets.threshold = request.number("threshold");
    brackets.width = request.number("width");
    if (const auto scene = find_scene(record.scene)) {
        if (const auto* parameter = scene->find_parameter(brackets.factor)) brackets.factor_unit = parameter->unit;
        if (const auto* measured = scene->find_observable(brackets.observable))
            brackets.observable_unit = measured->unit;
    }
    request.answers = schedule::known_answers(store, record, std::span(&brackets.observable, 1));
    brackets.found = designs::brackets(request);
    for (const auto& factor : record.factors)
        if (!factor.continuous()) brackets.others.push_back(factor.name);
    for (const auto& bracket : brackets.found) {
        auto& levels = brackets.levels.emplace_back();
        std::size_t other = 0;
        for (const auto& factor : record.factors)
            if (!factor.continuous()) levels.push_back(factor.level_texts()[bracket.levels[other++]]);
    }
    return brackets;
}

}  // namespace grainsweep::study
