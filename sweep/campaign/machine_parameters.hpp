// "parameters" and "let" of a machine, and the numbers that its expressions may use. Internal to the reader of
// machines.
#pragma once

#include "sweep/campaign/cursor.hpp"
#include "sweep/campaign/machine_scope.hpp"

#include "solver/machine/spec.hpp"

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::campaign {

/// Parameter of every machine that multiplies the stiffness of all contacts.
inline constexpr std::string_view stiffness_parameter = "stiffness_scale";
/// Parameter of every machine that has no own parameter or "let" of this name: shape of filled and fed particles.
inline constexpr std::string_view ratio_parameter = "aspect_ratio";

/// Returns the parameters of the machine, and the parameters of every machine.
[[nodiscard]] std::vector<ParameterSpec> read_machine_parameters(const Section& top);
/// Returns the names of parameters of the machine that no text of it names.
[[nodiscard]] std::vector<std::string> unused_parameters(const Json& machine,
                                                         const std::vector<ParameterSpec>& parameters);
/// Returns whether the machine has the parameter for the shape of its particles that machines have.
[[nodiscard]] bool takes_ratio(const Json& machine);
/// Returns the values of parameters at each level of accuracy.
[[nodiscard]] std::map<std::string, Inputs, std::less<>> read_machine_accuracy(
    const Section& top, const std::vector<ParameterSpec>& parameters);
/// Returns the names for expressions, for complete inputs: parameters in SI units, NAME_UNIT, NAME_is_WORD, and "let",
/// whose expressions may use one another in any order. Expressions that need numbers of species are still missing.
/// Refuses circular definitions.
[[nodiscard]] MachineScope machine_scope(const Section& top, const std::vector<ParameterSpec>& parameters,
                                         const Inputs& inputs,
                                         const std::map<std::string, std::string_view, std::less<>>& files);
/// Returns the expression with its quantities as numbers in SI units: "29 mm - hub" becomes "(0.029) - hub". Empty: it
/// has no number with a unit that a machine calculates with, or is nothing but one quantity.
[[nodiscard]] std::string with_si_numbers(std::string_view expression);
/// Returns what "1/2 mm" may mean, "'(1/2) mm' or '1/(2 mm)'"; empty: no quotient of two numbers has a unit behind it.
[[nodiscard]] std::string unclear_quotient(std::string_view expression);
/// Adds SPECIES_largest, SPECIES_smallest, SPECIES_volume, and the rest of "let".
void add_species_numbers(const Section& top, const machine::Spec& spec, MachineScope& scope);

}  // namespace grainsweep::campaign
