#include "sweep/study/calibration_files.hpp"

#include "sweep/campaign/input_error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

namespace grainsweep::study {
namespace {

constexpr auto property_names = std::to_array<std::string_view>(
    {"density", "youngs_modulus", "poisson_ratio", "restitution", "friction", "rolling_friction", "cohesion",
     "surface_energy", "wall_friction", "wall_rolling_friction", "wall_restitution", "wall_cohesion",
     "wall_surface_energy"});

}  // namespace

std::string posterior_csv(const designs::Calibration& found) {
    if (!found.posterior) return {};
    std::string text = fmt::format("{}\n", fmt::join(campaign::names_of(found.factors), ","));
    const auto rows = found.posterior->rows();
    for (std::size_t i = 0; i < rows.size(); ++i)
        for (std::size_t j = 0; j < found.factors.size(); ++j)
            text +=
                fmt::format("{}{}", found.factors[j].text(rows.row(i)[j]), j + 1 == found.factors.size() ? '\n' : ',');
    return text;
}

std::optional<campaign::PowderResult> powder_result(const CalibrationReport& report, std::string_view posterior_file) {
    const auto& found = report.found;
    if (!found.posterior) return std::nullopt;
    const auto& density = found.posterior->density;
    const auto best =
        found.posterior->rows().row(static_cast<std::size_t>(std::ranges::max_element(density) - density.begin()));
    campaign::PowderResult result;
    for (std::size_t j = 0; j < found.factors.size(); ++j)
        if (std::ranges::find(property_names, found.factors[j].name) != property_names.end())
            result.properties.emplace_back(found.factors[j].name, found.factors[j].number_or_index(best[j]));
    if (result.properties.empty()) return std::nullopt;
    for (const auto& target : report.targets)
        result.measured.push_back({target.name(), target.unit, target.value, target.error});
    result.posterior = posterior_file;
    return result;
}

}  // namespace grainsweep::study
