#include "solver/plain_text.hpp"
#include "stats/random.hpp"
#include "sweep/designs/kinds.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace grainsweep::designs {

DesignInfo calibration_design();  // of the section "calibration"

const DesignInfo* find_design(std::string_view name) {
    const auto kinds = design_catalogue();
    const auto found = std::ranges::find(kinds, name, &DesignInfo::name);
    if (found != kinds.end()) return &*found;
    static const DesignInfo waves = calibration_design();
    return name == waves.name ? &waves : nullptr;
}

const DesignInfo& design_named(std::string_view name) {
    const auto* found = find_design(name);
    if (found == nullptr) throw std::logic_error("there is no design '" + std::string(name) + "'");
    return *found;
}

std::optional<OptionValue> OptionSpec::default_value() const {
    if (kind == Kind::value) return std::vector<std::int64_t>{};
    if (standard.empty()) return std::nullopt;
    if (kind == Kind::word) return std::string(standard.substr(1, standard.size() - 2));  // without its quotes
    const double number = *number_in(standard);
    if (kind == Kind::whole) return static_cast<std::int64_t>(number);
    return number;
}

void add_defaults(const DesignInfo& design, std::map<std::string, OptionValue, std::less<>>& options) {
    for (const auto& option : design.options)
        if (auto value = option.default_value()) options.try_emplace(std::string(option.name), std::move(*value));
}

std::int64_t independent_sequences(std::string_view design, const DesignRequest& request) {
    if (!design_named(design).independent_sequences || !request.options.contains("sequences")) return 1;
    return request.count("sequences");
}

namespace {

template <typename T>
const T& option_of(const DesignRequest& request, std::string_view option) {
    const auto found = request.options.find(option);
    if (found == request.options.end())
        throw std::invalid_argument("the design's option '" + std::string(option) + "' is missing");
    const T* value = std::get_if<T>(&found->second);
    if (value == nullptr)
        throw std::invalid_argument("the design's option '" + std::string(option) + "' is of another kind");
    return *value;
}

}  // namespace

std::size_t DesignRequest::group_count() const {
    return groups.empty() ? dimensions() : *std::ranges::max_element(groups) + 1;
}

std::int64_t DesignRequest::count(std::string_view option) const {
    return option_of<std::int64_t>(*this, option);
}

double DesignRequest::number(std::string_view option) const {
    return option_of<double>(*this, option);
}

const std::string& DesignRequest::word(std::string_view option) const {
    return option_of<std::string>(*this, option);
}

std::uint64_t draw_key(std::uint64_t seed, DrawPurpose purpose, std::uint64_t a, std::uint64_t b, std::uint64_t c) {
    std::uint64_t h = stats::splitmix64(seed);
    for (const std::uint64_t part : {static_cast<std::uint64_t>(purpose), a, b, c}) h = stats::splitmix64(h ^ part);
    return h;
}

OptionSpec points_option(std::string_view meaning) {
    return {count_field("points", 1, 1e8, "", meaning), true};
}

std::int64_t points_asked(const DesignRequest& request) {
    return request.count("points");
}

std::vector<double> room_for(std::int64_t points, std::size_t dimensions) {
    constexpr auto most = std::size_t{1} << 28U;
    const auto count = static_cast<std::size_t>(points);
    if (dimensions != 0 && count > most / dimensions)
        throw std::invalid_argument(std::to_string(points) + " points of " + std::to_string(dimensions) +
                                    " factors are more than a design may hold (2^28 coordinates)");
    return std::vector<double>(count * dimensions);
}

}  // namespace grainsweep::designs
