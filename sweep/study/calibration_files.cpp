#include "sweep/study/calibration_files.hpp"

#include "sweep/campaign/json_writer.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

namespace grainsweep::study {
namespace {

using PowderJson = campaign::JsonText;

constexpr auto material_names = std::to_array<std::string_view>({"density", "youngs_modulus", "poisson_ratio"});
constexpr auto contact_names = std::to_array<std::string_view>(
    {"restitution", "friction", "rolling_friction", "cohesion", "surface_energy", "wall_friction",
     "wall_rolling_friction", "wall_restitution", "wall_cohesion", "wall_surface_energy"});

/// A number as a powder file may have it: bare, or a text with its unit.
PowderJson quantity(double value, const std::string& unit) {
    if (unit.empty() || unit == "1") return value;
    return fmt::format("{} {}", value, unit);
}

}  // namespace

std::string posterior_csv(const designs::Calibration& found) {
    if (!found.posterior) return {};
    std::string text = fmt::format("{}\n", fmt::join(found.factors, ","));
    const auto rows = found.posterior->rows();
    for (std::size_t i = 0; i < rows.size(); ++i)
        for (std::size_t j = 0; j < found.ranges.size(); ++j)
            text += fmt::format("{}{}", found.ranges[j].value_at(rows.row(i)[j]),
                                j + 1 == found.ranges.size() ? '\n' : ',');
    return text;
}

std::string powder_json(const CalibrationReport& report, std::string_view name, std::string_view posterior_file) {
    const auto& found = report.found;
    if (!found.posterior) return {};
    const auto& density = found.posterior->density;
    const auto best =
        found.posterior->rows().row(static_cast<std::size_t>(std::ranges::max_element(density) - density.begin()));
    PowderJson material = PowderJson::object(), contacts = PowderJson::object();
    bool any = false;
    for (std::size_t j = 0; j < found.factors.size(); ++j) {
        const bool of_material = std::ranges::find(material_names, found.factors[j]) != material_names.end();
        if (!of_material && std::ranges::find(contact_names, found.factors[j]) == contact_names.end()) continue;
        (of_material ? material : contacts).add(found.factors[j], found.ranges[j].value_at(best[j]));
        any = true;
    }
    if (!any) return {};
    const auto measured = [](const TargetCheck& target) {
        return PowderJson{{"what", target.name()},
                          {"value", quantity(target.value, target.unit)},
                          {"error", quantity(target.error, target.unit)}};
    };
    return PowderJson{{"powder", name},
                      {"notes", "Made by grainsweep calibrate: the setting of highest density of the posterior."},
                      {"material", material},
                      {"contacts", contacts},
                      {"measured", PowderJson::list(report.targets, measured)},
                      {"posterior", posterior_file}}
               .text() +
           "\n";
}

}  // namespace grainsweep::study
