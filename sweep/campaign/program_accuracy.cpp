// Accuracy settings of a program: values of parameters that decide its error and its cost.
#include "sweep/campaign/accuracy_goal.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/program_keys.hpp"
#include "sweep/campaign/program_section.hpp"
#include "sweep/campaign/sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace grainsweep::campaign {
namespace {

constexpr std::string_view cost_of_a_setting = "cost_seconds";

Value setting_value(const Cursor& place, const ProgramParameter& parameter) {
    if (parameter.is_word()) return place.text();
    const auto value = read_value(place, {parameter.name, parameter.unit, {}, 0.0, parameter.bounds, {}}, {});
    const double number = std::get<double>(value);
    if (parameter.whole && number != std::floor(number))
        place.refuse(fmt::format("'{}' is a whole number", parameter.name));
    return value;
}

ProgramSetting read_setting(const Cursor& here, const std::string& name, const Program& program) {
    ProgramSetting setting{name, {}, {}};
    for (const auto& [key, value] : here.members("must be an object of parameters and their values at this setting")) {
        if (key == cost_of_a_setting) {
            setting.cost_seconds = value.number({0, std::numeric_limits<double>::infinity(), true, true});
            continue;
        }
        const auto parameter = std::ranges::find(program.parameters, key, &ProgramParameter::name);
        if (parameter == program.parameters.end()) value.refuse("is no parameter of the program");  // of `notes` alone
        setting.inputs[key] = setting_value(value, *parameter);
    }
    if (setting.inputs.empty()) here.refuse("needs a parameter and its value at this setting");
    return setting;
}

void refuse_other_parameters(const Cursor& here, const ProgramSetting& first, const ProgramSetting& other) {
    for (const auto& [key, value] : first.inputs)
        if (!other.inputs.contains(key))
            here.refuse(fmt::format("it has no value of '{}', and the setting '{}' has one", key, first.name));
    for (const auto& [key, value] : other.inputs)
        if (!first.inputs.contains(key))
            here.refuse(fmt::format("it has a value of '{}', and the setting '{}' has none", key, first.name));
}

}  // namespace

void read_program_accuracy(const Section& section, Program& program) {
    const auto place = section.find("accuracy");
    if (!place) return;
    const std::string measure(AccuracyGoal::measure);
    std::optional<Cursor> named;
    for (const auto& [name, here] : place->members("must be an object of settings and the parameters of each")) {
        if (name == measure && here.json().is_string()) {
            named = here;
            continue;
        }
        check_program_name(here, name);
        program.accuracy.push_back(read_setting(here, name, program));
        refuse_other_parameters(here, program.accuracy.front(), program.accuracy.back());
    }
    const auto names = names_of(program.accuracy);
    if (named) {
        const auto word = named->text();
        const auto found = std::ranges::find(program.accuracy, word, &ProgramSetting::name);
        if (found == program.accuracy.end())
            named->refuse(fmt::format("must be one of the settings, {}", listed(names)), nearest_word(word, names));
        program.accuracy.push_back({measure, found->inputs, found->cost_seconds});
    } else if (std::ranges::find(names, measure) == names.end()) {
        place->refuse(
            fmt::format("key '{}' is missing: the name of the setting whose results are the standard", measure));
    }
}

}  // namespace grainsweep::campaign
