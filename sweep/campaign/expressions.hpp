// Fixed parameters computed from others in every case: "gap": "3*diameter". A case contains the number.
#pragma once

#include "sweep/campaign/campaign.hpp"
#include "sweep/campaign/identity.hpp"

#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace grainsweep::campaign {

/// Returns a formula of the numeric parameters of a scene, or the reason why the text is none.
[[nodiscard]] std::variant<Formula, std::string> parse_expression(std::string_view text, const SceneInfo& scene);
/// Returns the expressions, each after the ones that it needs. Refuses an expression that depends on itself, also
/// through others.
[[nodiscard]] std::vector<Expression> in_order(std::vector<Expression> expressions);

/// Refuses an expression of a program's parameters if its numbers are in different units, not all of them SI units.
void refuse_mixed_units(const Expression& expression, const SceneInfo& scene);
/// Refuses an expression with functions of angles and a parameter in degrees that it converts nowhere.
void refuse_degrees(const Expression& expression, const SceneInfo& scene);

/// Evaluates the expressions in complete inputs, without checks: a result may be out of bounds, or not finite.
void evaluate_expressions(std::span<const Expression> expressions, Inputs& inputs);
/// Refuses evaluated inputs in which an expression gives a value that its parameter cannot take.
void check_expressions(const ParameterSpace& space, const Inputs& inputs);

/// Returns the fixed parameters as in a campaign file, expressions as text.
[[nodiscard]] Inputs fixed_as_stated(const ParameterSpace& space);
/// Returns the expressions of a stored campaign.
[[nodiscard]] std::vector<Expression> expressions_of(const Identity& identity, const SceneInfo& scene);

}  // namespace grainsweep::campaign
