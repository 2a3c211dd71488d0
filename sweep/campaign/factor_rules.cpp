// Rules of factors besides their values: steps, groups, conditions, and shares that add to one.
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/plain_name.hpp"
#include "sweep/campaign/sections.hpp"
#include "sweep/campaign/simplex.hpp"
#include "sweep/designs/factor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <utility>

namespace grainsweep::campaign {

namespace {

double read_step_size(const Cursor& place, const ParameterSpec& parameter) {
    ParameterSpec size = parameter;
    size.name = "step";
    size.bounds = Interval{0, std::numeric_limits<double>::infinity(), true, true};
    return std::get<double>(coerced(read_value(place, size, {}, Reads::difference), Value{0.0}));
}

void check_multiples(const Cursor& place, const Between& range, std::pair<double, double> ends, double step) {
    const double farthest = std::max(std::abs(ends.first), std::abs(ends.second));
    if (farthest / step > static_cast<double>(designs::most_multiples))
        place.refuse(
            fmt::format("the values end more than {} steps from 0: give a larger step", designs::most_multiples));
    const auto count = designs::multiples_in(step, range.low, range.high).count();
    if (count < 2)
        place.refuse(
            fmt::format("{} multiple of it, counted from 0, lies between {} and {}: give a smaller step or a "
                        "wider range",
                        count == 1 ? "only one" : "no", shortest(range.low), shortest(range.high)));
}

/// A distribution without ends may round to a number beyond the parameter's bounds.
void check_rounded(const Cursor& place, const stats::Distribution& distribution, const ParameterSpec& parameter,
                   double step) {
    const auto* bounds = std::get_if<Interval>(&parameter.bounds);
    for (const double u : {0.0, 1.0})
        if (const double x = designs::stepped(distribution, step, u); bounds != nullptr && !bounds->contains(x))
            place.refuse(
                fmt::format("values round to {}, where '{}' has no value: give a smaller step, or {} to the "
                            "distribution",
                            shortest(x), parameter.name, u == 0 ? "\"low\"" : "\"high\""));
}

/// A text on one line, as an identity keeps it.
std::string one_line(std::string text) {
    std::ranges::replace_if(
        text, [](unsigned char c) { return std::isspace(c) != 0; }, ' ');
    return text;
}

void check_group_name(const Cursor& place, const std::string& name) {
    if (!is_plain_name(name)) place.refuse("the name of a group is letters, digits and _, not a digit first");
    if (name == group_of_shares) place.refuse("the shares that add to one have this group; take another name");
}

}  // namespace

std::optional<double> read_step(const Section& section, const ParameterSpec& parameter, const Factor& factor) {
    const auto step = section.find("step"), whole = section.find("whole");
    if (step && whole) step->refuse("'whole' is a step of 1: give one of the two");
    if (whole && !section.flag("whole", false)) {
        whole->refuse("only true has a meaning: leave it out for real numbers");
    }
    if (!step && !whole) return std::nullopt;
    const double size = step ? read_step_size(*step, parameter) : 1;
    const auto& place = step ? *step : *whole;
    if (const auto* distribution = std::get_if<stats::Distribution>(&factor.range)) {
        const auto [low, high] = distribution->range();
        check_multiples(place, {low, high}, {distribution->quantile(0), distribution->quantile(1)}, size);
        check_rounded(place, *distribution, parameter, size);
    } else {
        const auto& range = std::get<Between>(factor.range);
        check_multiples(place, range, {range.low, range.high}, size);
    }
    return size;
}

void refuse_steps(const Section& factor, std::string_view why) {
    for (const auto* key : {"step", "whole"})
        if (const auto place = factor.find(key)) place->refuse(std::string(why));
}

void read_ties(const Section& section, Factor& factor) {
    if (const auto group = section.find("group")) {
        factor.group = group->text();
        check_group_name(*group, factor.group);
    }
    if (const auto when = section.find("when")) {
        factor.when = one_line(when->text());
        if (factor.when.find_first_not_of(' ') == std::string::npos) when->refuse("a condition is expected");
    }
}

void check_groups(const Cursor& factors, const Campaign& campaign) {
    const auto& all = campaign.space.factors;
    const auto place = [&](std::size_t j) { return factors[j]["group"]; };
    for (std::size_t j = 0; j < factors.elements().size(); ++j) {
        if (all[j].group.empty()) continue;
        const auto& design = designs::design_named(campaign.design);
        if (design.beginning != designs::Beginning::listed && design.purpose == designs::Purpose::statistics)
            place(j).refuse(
                fmt::format("factors move in groups in the designs saltelli and morris, not in {}", campaign.design));
        if (std::ranges::find(all, all[j].group, &Factor::name) != all.end())
            place(j).refuse("a factor has this name; take another for the group");
        if (std::ranges::count(all, all[j].group, &Factor::group) == 1)
            place(j).refuse("this group has one factor: give it to another one too, or leave it out");
    }
    const auto groups = groups_of(all);
    if (std::ranges::all_of(groups, [&](std::size_t group) { return group == 0; }) && all.size() > 1)
        for (std::size_t j = 0; j < all.size(); ++j)
            if (!all[j].group.empty()) place(j).refuse("all factors are in one group: nothing is left to compare");
}

namespace {

/// The factor that an entry of "simplex" names.
Factor& share_named(const Cursor& place, std::vector<Factor>& factors) {
    const auto named = place.json().is_string() ? place.json().get<std::string>() : std::string();
    const auto found = std::ranges::find(factors, named, &Factor::name);
    if (found == factors.end()) {
        std::vector<std::string> names;
        for (const auto& factor : factors) names.push_back(factor.name);
        place.refuse(fmt::format("must be a factor of the campaign, with its smallest share: "
                                 "{{\"name\": ..., \"between\": [0, 1]}}; its factors are {}",
                                 listed(names)),
                     nearest_word(named, names));
    }
    if (found->share) place.refuse("this share is there twice");
    return *found;
}

void check_share(const Cursor& place, const Factor& factor, const SceneInfo& scene) {
    const auto* range = std::get_if<Between>(&factor.range);
    if (std::holds_alternative<Levels>(factor.range))
        place.refuse("a share varies between two values, and this factor has levels");
    if (range == nullptr) place.refuse("shares are uniform, and this factor has a distribution: give \"between\"");
    if (std::holds_alternative<std::int64_t>(scene.find_parameter(factor.name)->default_value))
        place.refuse("a share is a real number, and this parameter is a whole number");
    if (range->scale == Scale::log) place.refuse("shares are uniform: a logarithmic scale has no meaning");
    if (factor.step) place.refuse("steps of several shares do not add to one: leave out 'step' and 'whole'");
    if (!factor.when.empty()) place.refuse("all shares count at every point: leave out 'when'");
    if (!factor.group.empty()) place.refuse("the shares move together anyway: leave out 'group'");
    if (range->low < 0) place.refuse("a share is not negative: 'between' begins below 0");
}

/// A share cannot be larger than 1 minus the smallest values of the others. This is the upper end of its range.
void check_upper_ends(const Cursor& place, std::vector<Factor>& factors) {
    double lows = 0;
    for (const auto& factor : factors)
        if (factor.share) lows += std::get<Between>(factor.range).low;
    if (!(lows < 1)) place.refuse(fmt::format("the smallest shares add to {}: less than 1 is needed", shortest(lows)));
    for (auto& factor : factors) {
        if (!factor.share) continue;
        auto& range = std::get<Between>(factor.range);
        const double largest = 1 - (lows - range.low);
        constexpr double rounding = 1e-12;
        if (range.high < largest - rounding)
            place.refuse(
                fmt::format("'{0}' ends at {1}, and the others leave up to {2}: shares have a lower end only; "
                            "end it at {2} and give \"where\": \"{0} <= {1}\"",
                            factor.name, shortest(range.high), shortest(largest)));
        range.high = largest;
    }
}

}  // namespace

void read_simplex(const Cursor& place, ParameterSpace& space) {
    const auto elements = place.elements();
    if (elements.size() < 2) place.refuse("at least two shares add to one");
    for (const auto& element : elements) {
        Factor& factor = share_named(element, space.factors);
        check_share(element, factor, *space.scene);
        factor.share = true;
    }
    check_upper_ends(place, space.factors);
}

void check_simplex(const Cursor& place, const Campaign& campaign) {
    const auto& design = designs::design_named(campaign.design);
    if (design.beginning == designs::Beginning::corner)
        place.refuse(
            fmt::format("a {} divides every factor by itself, and its shares do not add to one: take a halton "
                        "design, or list the mixtures",
                        campaign.design));
    const auto* rows = std::get_if<designs::Rows>(
        campaign.request.options.contains("rows") ? &campaign.request.options.at("rows") : nullptr);
    for (std::size_t p = 0; rows != nullptr && p < rows->size(); ++p) {
        std::vector<double> shares;
        for (std::size_t j = 0; j < campaign.space.factors.size(); ++j)
            if (campaign.space.factors[j].share) shares.push_back(std::get<double>((*rows)[p][j]));
        double sum = 0;
        for (const double share : shares) sum += share;
        if (!add_to_one(shares))
            throw input_error("$.design", fmt::format("row {}", p + 1),
                              fmt::format("its shares add to {}, not to 1", shortest(sum)));
    }
}

void check_unfit(const Campaign& campaign) {
    const auto& design = designs::design_named(campaign.design);
    for (const auto& factor : campaign.space.factors) {
        const auto* key = factor.step ? "step" : factor.share ? "simplex" : !factor.when.empty() ? "when" : nullptr;
        if (key == nullptr) continue;
        const auto refuse = [&](std::string_view who, std::string_view why) {
            throw input_error("$.factors", factor.name, fmt::format("{} {}: leave out '{}'", who, why, key));
        };
        if (design.grows && !(design.calibrates && factor.step))
            refuse(fmt::format("a {}", campaign.design), "chooses its points between real numbers itself");
        if (campaign.convergence && campaign.convergence->traits().of_model && !factor.step)
            refuse("the rule 'assisted'", "integrates a model over independent factors");
    }
}

}  // namespace grainsweep::campaign
