// Distribution of a factor: its figures, cut off at the bounds of the parameter.
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/sections.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace grainsweep::campaign {

namespace {

using Ranges = std::variant<Between, stats::Distribution>;

constexpr double most_cut = 0.05, least_kept = 1e-6;

/// Place of the figures of a distribution, and their parameter.
struct Reading {
    const Section& section;
    const ParameterSpec& parameter;
    const std::filesystem::path& folder;

    /// A value that the parameter may have.
    [[nodiscard]] double value(std::string_view key) const {
        return std::get<double>(read_value(section.at(key), parameter, folder));
    }
    /// A number in the unit of the parameter, which need not be one of its values.
    [[nodiscard]] double amount(std::string_view key, const Interval& bounds = {}, Reads reads = Reads::value) const {
        ParameterSpec figure = parameter;
        figure.name = key;
        figure.bounds = bounds;
        return std::get<double>(read_value(section.at(key), figure, folder, reads));
    }
};

constexpr Interval above_zero{0, std::numeric_limits<double>::infinity(), true};

Ranges read_uniform(const Reading& read) {
    const Between range{read.value("low"), read.value("high"), Scale::linear};
    if (!(range.low < range.high)) read.section.place().refuse("low must be below high");
    if (!std::isfinite(range.high - range.low))
        read.section.place().refuse("the range must be finite in double precision");
    return range;
}

stats::Distribution::Form read_lognormal(const Reading& read) {
    const auto sigma = read.section.find("sigma"), ratio = read.section.find("ratio");
    if (sigma.has_value() == ratio.has_value())
        throw input_error(read.section.place().path(), sigma ? "both" : "neither",
                          "a lognormal distribution has either \"sigma\", the standard deviation of the natural "
                          "logarithm, or \"ratio\", exp(sigma)");
    const double width = sigma ? read.section.number("sigma", 1) : std::log(read.section.number("ratio", 1));
    return stats::Lognormal{read.amount("median", above_zero), width};
}

stats::Distribution::Form read_triangular(const Reading& read) {
    const stats::Triangular form{read.value("low"), read.value("mode"), read.value("high")};
    if (!(form.low < form.high)) read.section.place().refuse("low must be below high");
    if (!(form.low <= form.mode && form.mode <= form.high))
        read.section.place().refuse("the mode must lie from low to high");
    return form;
}

stats::Distribution::Form read_beta(const Reading& read) {
    const stats::Beta form{read.value("low"), read.value("high"), read.section.number("a", 1),
                           read.section.number("b", 1)};
    if (!(form.low < form.high)) read.section.place().refuse("low must be below high");
    return form;
}

/// Truncates to the bounds of the parameter, and to those of the user, who may cut off more; checks that something
/// varies.
stats::Distribution within_bounds(const stats::Distribution::Form& form, const Reading& read) {
    const auto& bounds = std::get<Interval>(read.parameter.bounds);
    constexpr double infinite = std::numeric_limits<double>::infinity();
    const stats::Distribution untruncated(form);
    const bool truncated = !untruncated.has_ends();
    const bool low_given = truncated && read.section.find("low"), high_given = truncated && read.section.find("high");
    const double beyond =
        stats::Distribution(form, low_given ? -infinite : bounds.low, high_given ? infinite : bounds.high).cut();
    if (!(beyond <= most_cut))
        read.section.place().refuse(fmt::format(
            "{:.3g} % of the distribution lie where '{}' has no value, which is a number{}; at most {:.0f} % may, "
            "unless \"low\" or \"high\" truncates the distribution there",
            100 * beyond, read.parameter.name, in_words(bounds), 100 * most_cut));
    const double from = low_given ? read.value("low") : bounds.low, to = high_given ? read.value("high") : bounds.high;
    if (!(from < to)) read.section.place().refuse("low must be below high");
    const stats::Distribution distribution(form, from, to);
    if (!(distribution.cut() < 1 - least_kept))
        read.section.place().refuse(
            fmt::format("less than {:.2g} of the distribution lies between low and high", least_kept));
    const double low = distribution.quantile(0), high = distribution.quantile(1);
    if (!std::isfinite(high - low)) read.section.place().refuse("the range must be finite in double precision");
    if (!(distribution.quantile(0.25) < distribution.quantile(0.75)))
        read.section.place().refuse("the width is lost in double precision");
    return distribution;
}

}  // namespace

std::variant<Between, stats::Distribution> read_distribution(const Section& factor, std::string_view key,
                                                             const ParameterSpec& parameter,
                                                             const std::filesystem::path& folder) {
    const Cursor place = factor.at(key);
    const auto with = [&](std::span<const Field> keys, auto read) {
        const Section section(place, keys);
        return read(Reading{section, parameter, folder});
    };
    const auto shaped = [&](std::span<const Field> keys, auto read) -> Ranges {
        return with(keys, [&](const Reading& reading) { return within_bounds(read(reading), reading); });
    };
    if (key == "uniform") return with(uniform_keys, read_uniform);
    if (key == "lognormal") return shaped(lognormal_keys, read_lognormal);
    if (key == "weibull")
        return shaped(weibull_keys, [](const Reading& read) -> stats::Distribution::Form {
            return stats::Weibull{read.amount("scale", above_zero), read.section.number("shape", 1)};
        });
    if (key == "gumbel")
        return shaped(gumbel_keys, [](const Reading& read) -> stats::Distribution::Form {
            return stats::Gumbel{read.amount("location"), read.amount("scale", above_zero, Reads::difference)};
        });
    if (key == "triangular") return shaped(triangular_keys, read_triangular);
    if (key == "beta") return shaped(beta_keys, read_beta);
    return shaped(normal_keys, [](const Reading& read) -> stats::Distribution::Form {
        return stats::Normal{read.amount("mean"), read.amount("sd", above_zero, Reads::difference)};
    });
}

}  // namespace grainsweep::campaign
