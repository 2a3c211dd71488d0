// Fixed parameters that follow from others in every case: "gap": "3*diameter". A case holds the number.
#pragma once

#include "sweep/campaign/campaign.hpp"
#include "sweep/campaign/identity.hpp"

#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace grainsweep::campaign {

/// A formula over the parameters of a scene that are numbers; otherwise why not.
[[nodiscard]] std::variant<Formula, std::string> parse_expression(std::string_view text, const SceneInfo& scene);
/// Puts each after those it needs. Refuses one that needs itself, through others or not.
[[nodiscard]] std::vector<Expression> in_order(std::vector<Expression> expressions);

/// Evaluates them in complete inputs, unchecked: the result may be out of bounds, or not finite.
void evaluate_expressions(std::span<const Expression> expressions, Inputs& inputs);
/// Refuses evaluated inputs in which an expression gives a value that its parameter cannot take.
void check_expressions(const ParameterSpace& space, const Inputs& inputs);

/// What is fixed as a campaign file states it, expressions as text.
[[nodiscard]] Inputs fixed_as_stated(const ParameterSpace& space);
/// The expressions of a stored campaign.
[[nodiscard]] std::vector<Expression> expressions_of(const Identity& identity, const SceneInfo& scene);

}  // namespace grainsweep::campaign
