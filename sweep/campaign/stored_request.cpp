#include "sweep/campaign/stored_request.hpp"

#include "solver/scenes/scene.hpp"
#include "sweep/campaign/expressions.hpp"
#include "sweep/campaign/stored_identity.hpp"

#include <algorithm>
#include <utility>

namespace grainsweep::campaign {

Inputs fixed_values(const Identity& identity, const SceneInfo& scene) {
    Inputs values;
    for (const auto& [name, value] : identity.fixed) {
        const auto* parameter = scene.find_parameter(name);
        const bool expression = std::holds_alternative<std::string>(value) && parameter != nullptr &&
                                !std::holds_alternative<std::string>(parameter->default_value);
        if (parameter != nullptr && !expression) values[name] = coerced(value, parameter->default_value);
    }
    return values;
}

std::optional<ParameterSpace> space_of(const Identity& identity) {
    const auto scene = find_scene(identity.scene);
    if (scene == nullptr || std::ranges::any_of(identity.factors, [&](const Factor& factor) {
            return scene->find_parameter(factor.name) == nullptr;
        }))
        return std::nullopt;
    return ParameterSpace{.scene = scene,
                          .factors = identity.factors,
                          .fixed = fixed_values(identity, *scene),
                          .expressions = expressions_of(identity, *scene)};
}

designs::DesignRequest request_of(const Identity& identity) {
    designs::DesignRequest request;
    request.seed = identity.seed;
    request.factors = identity.factors;
    request.groups = groups_of(identity.factors);
    for (const auto& factor : identity.factors) request.levels.push_back(factor.continuous() ? 0 : factor.parts());
    if (const auto* together = word_of(identity, "together")) request.shared = factors_in(*together);
    request.options = identity.options;
    designs::add_defaults(designs::design_named(identity.design), request.options);
    return request;
}

}  // namespace grainsweep::campaign
