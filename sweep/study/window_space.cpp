#include "sweep/study/window_space.hpp"

#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/plain_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <regex>

namespace grainsweep::study {
namespace {

constexpr std::size_t noise_settings = 64, least_of_a_combination = 16, most_combinations = 32;

std::size_t levels_in(const ModelFactor& factor) {
    return factor.is_word() ? factor.choices() : factor.numbers.size();
}

double level_number(const ModelFactor& factor, std::size_t level) {
    return factor.is_word() ? static_cast<double>(level) : factor.numbers[level];
}

/// Some of the factors, without their conditions: these read all factors.
std::vector<ModelFactor> factors_at(const std::vector<ModelFactor>& factors, const std::vector<std::size_t>& places) {
    std::vector<ModelFactor> chosen;
    for (const auto j : places) chosen.emplace_back(factors[j]).counts = nullptr;
    return chosen;
}

/// Every combination of the levels of the factors at `places`, in copies of a setting.
std::vector<Setting> combinations_of(const Setting& setting, const std::vector<ModelFactor>& factors,
                                     const std::vector<std::size_t>& places) {
    std::vector<Setting> all = {setting};
    for (const auto j : places) {
        std::vector<Setting> longer;
        for (const auto& one : all)
            for (std::size_t level = 0; level < levels_in(factors[j]); ++level) {
                longer.push_back(one);
                longer.back()[j] = level_number(factors[j], level);
            }
        all = std::move(longer);
    }
    return all;
}

/// Sobol points of the factors at `places`, cells centred.
std::vector<Setting> centred_points(const std::vector<ModelFactor>& factors, const std::vector<std::size_t>& places,
                                    std::size_t count) {
    const auto chosen = factors_at(factors, places);
    if (chosen.empty()) return {Setting{}};
    const auto set =
        sobol_points({.levels = std::vector<std::size_t>(chosen.size(), 0),
                      .options = {{"points", static_cast<std::int64_t>(count)}, {"scramble", std::string("none")}}});
    std::vector<Setting> points;
    for (std::size_t p = 0; p < set.size(); ++p) {
        std::vector<double> u;
        for (const double x : set.point(p)) u.push_back(x + 0.5 / static_cast<double>(count));
        points.push_back(exact_setting(chosen, u));
    }
    return points;
}

constexpr std::size_t longest_list = 1000;  // characters; a regular expression recurses over them

struct Stretch {
    std::size_t begin = 0, end = 0;
};

/// The first "for all" that stands as two words, whatever their case.
std::optional<Stretch> for_all_in(std::string_view where) {
    const auto part_of_word = [&](std::size_t k) { return k < where.size() && campaign::is_name_sign(where[k]); };
    const auto is_word = [&](std::size_t at, std::string_view word) {
        if (at + word.size() > where.size() || (at > 0 && part_of_word(at - 1)) || part_of_word(at + word.size()))
            return false;
        return campaign::small_letters(where.substr(at, word.size())) == word;
    };
    for (std::size_t at = 0; at < where.size(); ++at) {
        if (!is_word(at, "for")) continue;
        const auto next = where.find_first_not_of(" \t\n", at + 3);
        if (next != std::string_view::npos && is_word(next, "all")) return Stretch{at, next + 3};
    }
    return std::nullopt;
}

}  // namespace

StatedCondition split_condition(std::string_view where) {
    const auto split = for_all_in(where);
    if (!split) return {std::string(where), {}};
    StatedCondition stated{std::string(where.substr(0, split->begin)), {}};
    static const std::regex name(R"(^\s*([A-Za-z_]\w*)\s*(,|$))");
    const bool too_long = where.size() - split->end > longest_list;
    std::string rest(too_long ? std::string_view() : where.substr(split->end));
    for (std::smatch found; std::regex_search(rest, found, name); rest = found.suffix())
        stated.for_all.push_back(found[1]);
    if (stated.for_all.empty() || !rest.empty())
        throw campaign::input_error("--where", where,
                                    "'for all' stands at the end, with names of factors that have levels: \"mfr >= "
                                    "0.3 for all powder\"");
    if (std::ranges::all_of(stated.condition, [](char c) { return c == ' '; }))
        throw campaign::input_error("--where", where, "a condition stands before 'for all'");
    return stated;
}

WindowSpace::WindowSpace(const ModelCases& cases, const Held& held, const std::vector<std::string>& for_all,
                         Admits admits)
    : factors_(cases.factors), admits_(std::move(admits)) {
    empty_.assign(factors_.size(), std::numeric_limits<double>::quiet_NaN());
    for (const auto& [j, value] : held) empty_[j] = value;
    const auto names = cases.factor_names();
    for (const auto& name : for_all) {
        const auto j = static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
        const auto refuse = [&](std::string_view why, std::string_view word = {}) {
            throw campaign::input_error("--where", fmt::format("for all {}", name), why, word);
        };
        if (j == names.size()) refuse("is no factor of the campaign", campaign::nearest_word(name, names));
        if (levels_in(factors_[j]) == 0) refuse("needs a factor with \"levels\"");
        if (!std::isnan(empty_[j])) refuse("cannot be held at one value, too");
        every_.push_back(j);
    }
    for (std::size_t j = 0; j < factors_.size(); ++j) {
        if (!std::isnan(empty_[j]) || std::ranges::find(every_, j) != every_.end()) continue;
        (factors_[j].noise ? noise_ : searched_).push_back(j);
    }
    searched_factors_ = factors_at(factors_, searched_);
    if (searched_.empty())
        throw campaign::input_error("window", "",
                                    "no factor is left to be searched: each is held, noise, or named by 'for all'");
    const auto shares = std::ranges::count_if(factors_, &ModelFactor::share);
    for (const auto* some : {&searched_, &noise_})
        if (const auto count = std::ranges::count_if(*some, [&](std::size_t j) { return factors_[j].share; });
            count != 0 && count != shares)
            throw campaign::input_error("window", "",
                                        "shares that add to one are all searched, all held, or all noise");
}

std::vector<BoxPoint> WindowSpace::embedded(std::vector<BoxPoint> points) const {
    for (auto& point : points) {
        auto setting = empty_;
        for (std::size_t k = 0; k < searched_.size(); ++k) setting[searched_[k]] = point.setting[k];
        point.setting = std::move(setting);
        if (!averages()) fold(factors_, point.setting);
    }
    if (admits_)
        std::erase_if(points, [&](const BoxPoint& point) {
            if (!averages()) return !admits_(point.setting);
            return std::ranges::all_of(behind(point.setting), [](const auto& group) { return group.empty(); });
        });
    return points;
}

std::vector<BoxPoint> WindowSpace::spread(std::size_t count) const {
    return embedded(spread_points(searched_factors_, {}, count));
}

std::vector<BoxPoint> WindowSpace::about(const BoxPoint& centre, double reach, std::size_t count) const {
    return embedded(points_about(centre, reach, searched_factors_, {}, count));
}

std::vector<Setting> WindowSpace::noise_points(const std::vector<std::size_t>& averaged) const {
    std::vector<std::size_t> with_levels, others;
    std::size_t combinations = 1;
    for (const auto j : averaged) {
        const auto levels = levels_in(factors_[j]);
        const bool listed = levels > 0 && combinations * levels <= most_combinations;
        if (listed) combinations *= levels;
        (listed ? with_levels : others).push_back(j);
    }
    const auto count = std::max(noise_settings / combinations, least_of_a_combination);
    const auto points = centred_points(factors_, others, count);
    std::vector<Setting> all;
    for (const auto& one : combinations_of(Setting(factors_.size(), 0), factors_, with_levels))
        for (const auto& point : points) {
            all.push_back(one);
            for (std::size_t k = 0; k < others.size(); ++k) all.back()[others[k]] = point[k];
        }
    return all;
}

std::vector<std::vector<Setting>> WindowSpace::behind(const Setting& setting) const {
    std::vector<std::size_t> averaged, every;
    for (const auto j : noise_)
        if (std::isnan(setting[j])) averaged.push_back(j);
    for (const auto j : every_)
        if (std::isnan(setting[j])) every.push_back(j);
    const auto noise = noise_points(averaged);
    std::vector<std::vector<Setting>> groups;
    for (const auto& one : combinations_of(setting, factors_, every)) {
        auto& group = groups.emplace_back();
        for (const auto& point : noise) {
            Setting full = one;
            for (const auto j : averaged) full[j] = point[j];
            fold(factors_, full);
            if (!admits_ || admits_(full)) group.push_back(std::move(full));
        }
    }
    return groups;
}

std::optional<Setting> WindowSpace::searched_part(const Setting& full) const {
    Setting part = empty_;
    for (std::size_t j = 0; j < part.size(); ++j)
        if (!std::isnan(part[j]) && part[j] != full[j]) return std::nullopt;
    for (const auto j : searched_) part[j] = full[j];
    return part;
}

bool WindowSpace::searches(std::size_t factor) const {
    return std::ranges::find(searched_, factor) != searched_.end();
}

std::vector<std::string> WindowSpace::noise_names() const {
    std::vector<std::string> names;
    for (const auto j : noise_) names.push_back(factors_[j].name);
    return names;
}

}  // namespace grainsweep::study
