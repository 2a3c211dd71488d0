#include "sweep/study/error_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grainsweep::study {

std::string with_error(double value, double error) {
    if (!std::isfinite(value)) return "-";
    if (!std::isfinite(error)) return fmt::format("{:.5g}", value);
    if (!(error > 1e-12 * std::abs(value))) return fmt::format("{:.{}g} ± 0", value, std::abs(value) < 1e5 ? 5 : 12);
    const double magnitude = std::max(std::abs(value), error);
    const int place = 1 - static_cast<int>(std::floor(std::log10(error)));  // decimals for two digits of the error
    if (magnitude >= 1e6 || magnitude < 1e-3) {
        const int exponent = static_cast<int>(std::floor(std::log10(magnitude)));
        const double unit = std::pow(10.0, exponent);
        const int decimals = std::clamp(place + exponent, 0, 15);
        return fmt::format("({:.{}f} ± {:.{}f})e{}", value / unit, decimals, error / unit, decimals, exponent);
    }
    const int decimals = std::clamp(place, 0, 15);
    return fmt::format("{:.{}f} ± {:.{}f}", value, decimals, error, decimals);
}

std::string index_text(const stats::SensitivityIndex& index) {
    const bool nothing = std::abs(index.value) < 1e-9 && !(index.half_width >= 1e-9);
    return nothing ? "0" : with_error(index.value, index.half_width);
}

std::string with_unit(std::string_view name, std::string_view unit) {
    return unit.empty() || unit == "1" ? std::string(name) : fmt::format("{} ({})", name, unit);
}

}  // namespace grainsweep::study
