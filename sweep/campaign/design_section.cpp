// "design": its options against the OptionSpecs that the design declares.
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/sections.hpp"
#include "sweep/designs/factor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace grainsweep::campaign {

namespace {

using designs::OptionSpec;
using designs::OptionValue;

const designs::DesignInfo& read_kind(const Cursor& place) {
    if (!place.json().is_object()) place.refuse("must be an object with a \"kind\"");
    const auto known = names_of(designs::design_catalogue());
    if (!place.json().contains("kind")) {
        throw input_error(place.path(), "", fmt::format("key 'kind' is missing: {}", in_words(known)));
    }
    return *designs::find_design(place["kind"].word(known));
}

/// Returns one count, or one per factor. The entry of a factor with levels is the number of its levels.
OptionValue read_counts(const Cursor& place, const OptionSpec& option, std::span<const std::size_t> levels) {
    if (!place.json().is_array()) return place.whole(option.bounds);
    const auto elements = place.elements();
    if (elements.size() != levels.size()) {
        place.refuse(
            fmt::format("must be one whole number or one per factor, and there are {} factors", levels.size()));
    }
    std::vector<std::int64_t> counts;
    for (std::size_t j = 0; j < elements.size(); ++j) {
        counts.push_back(elements[j].whole(option.bounds));
        if (levels[j] != 0 && counts.back() != static_cast<std::int64_t>(levels[j])) {
            elements[j].refuse(fmt::format("this factor is given by its {} levels", levels[j]));
        }
    }
    return counts;
}

OptionValue read_rows(const Section& section, const OptionSpec& option, const ParameterSpace& space,
                      const std::filesystem::path& folder) {
    const auto file = section.find("file");
    const auto listed = section.find(option.name);
    if (file.has_value() == listed.has_value()) {
        throw input_error(section.place().path(), file ? "both" : "neither",
                          fmt::format("give either \"{}\": [[...], ...] or \"file\": a CSV file", option.name));
    }
    if (file) return read_rows_file(*file, space, folder);
    designs::Rows rows;
    for (const auto& element : listed->elements()) {
        const auto cells = element.elements();
        if (cells.size() != space.factors.size()) {
            element.refuse(
                fmt::format("a row has one value per factor, and there are {} factors", space.factors.size()));
        }
        auto& row = rows.emplace_back();
        for (std::size_t j = 0; j < cells.size(); ++j) {
            row.push_back(read_value(cells[j], *space.scene->find_parameter(space.factors[j].name), folder));
            check_in_range(cells[j], space.factors[j], row.back());
        }
    }
    if (rows.empty()) listed->refuse("a design needs at least one row");
    return rows;
}

/// Checks the number of points that an option requests, as far as this option alone determines it.
void check_size(const Cursor& place, const OptionValue& value, std::span<const std::size_t> levels, bool points) {
    double size = 1;
    if (const auto* count = std::get_if<std::int64_t>(&value)) {
        for (const std::size_t k : levels) size *= k != 0 ? static_cast<double>(k) : static_cast<double>(*count);
        if (points) size = static_cast<double>(*count);
    } else if (const auto* counts = std::get_if<std::vector<std::int64_t>>(&value)) {
        for (const std::int64_t k : *counts) size *= static_cast<double>(k);
    }
    if (size > static_cast<double>(most_cases)) {
        place.refuse(fmt::format("a campaign has at most {} cases", most_cases));
    }
}

std::vector<std::string> names_for(const OptionSpec& option, const Campaign& campaign) {
    std::vector<std::string> names;
    if (option.names == OptionSpec::Names::factors) {
        for (const auto& factor : campaign.space.factors)
            if (std::holds_alternative<Between>(factor.range)) names.push_back(factor.name);
    } else {
        for (const auto& observable : campaign.scene().observables)
            if (observable.shape == Shape::scalar) names.push_back(observable.name);
    }
    return names;
}

std::string read_option_word(const Cursor& place, const OptionSpec& option, const Campaign& campaign) {
    if (option.names == OptionSpec::Names::any) return place.word(option.words);
    const auto names = names_for(option, campaign);
    if (names.empty()) place.refuse("needs a factor that varies between two values, and there is none");
    return place.word(names);
}

}  // namespace

void check_in_range(const Cursor& place, const Factor& factor, const Value& value) {
    if (const auto* levels = factor.levels()) {
        if (std::ranges::find(levels->values, value) == levels->values.end()) {
            place.refuse(fmt::format("is none of the levels of factor '{}'", factor.name));
        }
        return;
    }
    const auto* distribution = factor.distribution();
    const double low = distribution != nullptr ? distribution->low() : factor.between()->low;
    const double high = distribution != nullptr ? distribution->high() : factor.between()->high;
    const double number = std::get<double>(coerced(value, Value{0.0}));
    if (!Interval{low, high}.contains(number))
        place.refuse(fmt::format("factor '{}' goes from {} to {}", factor.name, shortest(low), shortest(high)));
    if (factor.step && !designs::is_multiple(*factor.step, number))
        place.refuse(fmt::format("factor '{}' takes multiples of {}", factor.name, shortest(*factor.step)));
}

void set_factors(Campaign& campaign) {
    auto& request = campaign.request;
    request.seed = campaign.seed;
    request.factors = campaign.space.factors;
    for (const auto& factor : request.factors) request.levels.push_back(factor.continuous() ? 0 : factor.parts());
    request.groups = groups_of(request.factors);
}

void check_growing(const Cursor& place, const Campaign& campaign) {
    if (campaign.replicates != 1) {
        throw input_error("$.replicates", std::to_string(campaign.replicates),
                          fmt::format("a {} design repeats its points itself: give \"replicates\" within \"design\"",
                                      campaign.design));
    }
    try {
        (void)designs::design_named(campaign.design).sample(campaign.request);
    } catch (const std::invalid_argument& error) {
        throw input_error(place.path(), "", error.what());
    }
}

void read_design(const Cursor& place, Campaign& campaign, const std::filesystem::path& folder) {
    const auto& design = read_kind(place);
    const auto keys = design_keys(design);
    const Section section(place, keys);
    campaign.design = design.name;
    auto& request = campaign.request;
    set_factors(campaign);
    for (const auto& option : design.options) {
        const std::string name(option.name);
        if (option.kind == Field::Kind::array) {
            request.options[name] = read_rows(section, option, campaign.space, folder);
            continue;
        }
        const auto given = section.find(name);
        if (!given) continue;
        OptionValue value;
        if (option.kind == Field::Kind::word || option.kind == Field::Kind::text) {
            value = read_option_word(*given, option, campaign);
        } else if (option.kind == Field::Kind::number) {
            value = given->number(option.bounds);
        } else if (option.kind == Field::Kind::value) {
            value = read_counts(*given, option, request.levels);
            check_size(*given, value, request.levels, false);
        } else {
            value = given->whole(option.bounds);
            if (name == "points") check_size(*given, value, request.levels, true);
        }
        request.options[name] = std::move(value);
    }
    designs::add_defaults(design, request.options);
    if (design.grows) check_growing(place, campaign);
}

}  // namespace grainsweep::campaign
