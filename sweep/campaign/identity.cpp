#include "sweep/campaign/identity.hpp"

#include "solver/scenes/scene.hpp"
#include "sweep/campaign/expressions.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/stated_distribution.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <sstream>

namespace grainsweep::campaign {

namespace {

constexpr std::string_view level_separator = " | ", factor_separator = "; ";

std::string joined(const std::vector<Value>& values) {
    std::string text;
    for (const auto& value : values) text.append(text.empty() ? "" : level_separator).append(identity_text(value));
    return text;
}

constexpr std::string_view step_mark = " step ";

std::string line_of(const Factor& factor) {
    if (const auto* between = std::get_if<Between>(&factor.range)) {
        return fmt::format("{} between {} {} {}{}{}", factor.name, shortest(between->low), shortest(between->high),
                           between->scale == Scale::log ? "log" : "linear",
                           factor.step ? fmt::format("{}{}", step_mark, shortest(*factor.step)) : "",
                           factor.share ? " share" : "");
    }
    if (const auto* distribution = std::get_if<stats::Distribution>(&factor.range))
        return fmt::format("{} {}{}", factor.name, stated_text(*distribution),
                           factor.step ? fmt::format("{}{}", step_mark, shortest(*factor.step)) : "");
    return fmt::format("{} levels {}", factor.name, joined(std::get<Levels>(factor.range).values));
}

constexpr std::string_view group_mark = " group ", when_mark = " when ";

/// Returns the relations of a factor to others, as lines that follow the lines of all factors.
std::string ties_of(const Factor& factor) {
    std::string lines;
    if (!factor.group.empty()) lines += fmt::format("{}{} {}\n", group_mark, factor.name, factor.group);
    if (!factor.when.empty()) lines += fmt::format("{}{} {}\n", when_mark, factor.name, factor.when);
    return lines;
}

std::string text_of(const designs::OptionValue& value) {
    if (const auto* count = std::get_if<std::int64_t>(&value)) return std::to_string(*count);
    if (const auto* word = std::get_if<std::string>(&value)) return *word;
    if (const auto* number = std::get_if<double>(&value)) return shortest(*number);
    std::string text;
    if (const auto* counts = std::get_if<std::vector<std::int64_t>>(&value)) {
        for (const auto count : *counts) text += (text.empty() ? "" : " ") + std::to_string(count);
    }
    return text;
}

const designs::OptionSpec* find_option(const designs::DesignInfo& design, std::string_view name) {
    const auto found = std::ranges::find(design.options, name, &designs::OptionSpec::name);
    return found == design.options.end() ? nullptr : &*found;
}

/// "points = 40" -> "points", "40".
std::pair<std::string, std::string> name_and_value(const std::string& line) {
    constexpr std::string_view between = " = ";
    const auto at = line.find(between);
    if (at == std::string::npos) return {line, {}};
    return {line.substr(0, at), line.substr(at + between.size())};
}

/// "gap shape" -> "gap", "shape".
std::pair<std::string, std::string> name_and_rest(const std::string& line) {
    const auto blank = line.find(' ');
    return {line.substr(0, blank), blank == std::string::npos ? "" : line.substr(blank + 1)};
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

/// Returns the lines of the options that identify the design, or (`extent`) of the options that set its size.
std::string options_of(const designs::DesignInfo& design, const std::string& text, bool extent) {
    std::set<std::string> kept;
    for (const auto& line : lines_of(text)) {
        const auto* option = find_option(design, name_and_value(line).first);
        if ((option != nullptr && option->extent) == extent) kept.insert(line);
    }
    std::string lines;
    for (const auto& line : kept) lines += line + '\n';
    return lines;
}

std::vector<std::string> split(std::string_view text, std::string_view separator) {
    std::vector<std::string> parts;
    for (auto at = text.find(separator); at != std::string_view::npos; at = text.find(separator)) {
        parts.emplace_back(text.substr(0, at));
        text.remove_prefix(at + separator.size());
    }
    parts.emplace_back(text);
    return parts;
}

double identity_number(const std::string& text) {
    double number = std::numeric_limits<double>::quiet_NaN();
    std::from_chars(text.data(), text.data() + text.size(), number);
    return number;
}

/// Returns the factor that line_of() wrote; for a distribution only its name and step.
StatedFactor factor_in(const std::string& line) {
    constexpr std::string_view levels = " levels ", between = " between ";
    StatedFactor factor;
    factor.name = line.substr(0, line.find(' '));
    if (line.compare(factor.name.size(), levels.size(), levels) == 0) {
        factor.levels = split(std::string_view(line).substr(factor.name.size() + levels.size()), level_separator);
    } else if (line.compare(factor.name.size(), between.size(), between) == 0) {
        std::istringstream words(line.substr(factor.name.size() + between.size()));
        std::string low, high, scale;
        words >> low >> high >> scale;
        factor.between = {identity_number(low), identity_number(high), scale == "log" ? Scale::log : Scale::linear};
        for (std::string word, number; words >> word;) {
            if (word == "share") factor.share = true;
            if (word == "step" && words >> number) factor.step = identity_number(number);
        }
    } else if (const auto at = line.rfind(step_mark); at != std::string::npos) {
        factor.step = identity_number(line.substr(at + step_mark.size()));
    }
    return factor;
}

/// Adds the distributions that lines state; columns of one sample share its rows.
void add_distributions(std::vector<StatedFactor>& factors, const std::vector<std::string>& lines) {
    struct Member {
        std::size_t factor;
        StatedColumn stated;
    };
    std::map<std::string, std::vector<Member>> samples;
    for (std::size_t j = 0; j < lines.size(); ++j) {
        if (factors[j].between || !factors[j].levels.empty()) continue;
        const auto end = std::min(factors[j].name.size() + 1, lines[j].size());
        const auto stated = std::string_view(lines[j]).substr(0, lines[j].rfind(step_mark));
        auto found = distribution_in(stated.substr(end));
        if (auto* whole = std::get_if<stats::Distribution>(&found)) factors[j].distribution = std::move(*whole);
        if (auto* column = std::get_if<StatedColumn>(&found); column != nullptr && !column->values.empty())
            samples[column->sample].push_back({j, std::move(*column)});
    }
    for (auto& [hash, members] : samples) {
        std::ranges::sort(members, {}, [](const Member& member) { return member.stated.column; });
        std::vector<std::vector<double>> columns;
        for (auto& member : members) columns.push_back(std::move(member.stated.values));
        const auto sample = std::make_shared<const stats::JointSample>(std::move(columns));
        for (std::size_t k = 0; k < members.size(); ++k)
            factors[members[k].factor].distribution = stats::Distribution(stats::SampleColumn{sample, k});
    }
}

/// Returns the counts per factor that have an effect: without counts of factors with levels of their own. One count for
/// all factors is written out.
std::string counts_that_act(const std::string& value, const std::vector<std::string>& factors) {
    std::istringstream stream(value);
    std::vector<std::int64_t> counts;
    for (std::int64_t count = 0; stream >> count;) counts.push_back(count);
    std::string acting;
    for (std::size_t j = 0; j < factors.size() && !counts.empty(); ++j) {
        if (!factor_in(factors[j]).levels.empty()) continue;
        acting += fmt::format(" {}", counts[counts.size() == 1 ? 0 : std::min(j, counts.size() - 1)]);
    }
    return acting;
}

/// "a = 1\nb = 2\n" -> "a = 1, b = 2".
std::string in_one_line(const std::string& lines) {
    std::string text;
    for (const auto& line : lines_of(lines)) text += (text.empty() ? "" : ", ") + line;
    return text;
}

/// Returns whether the factor is the same, with all its old levels and new ones. A lattice may grow in this way.
bool levels_added(const std::string& before, const std::string& after) {
    const auto was = factor_in(before), is = factor_in(after);
    return was.name == is.name && !was.levels.empty() && std::ranges::all_of(was.levels, [&](const auto& level) {
               return std::ranges::find(is.levels, level) != is.levels.end();
           });
}

/// Returns the first line in which two texts differ; "nothing" for a text that has ended.
std::pair<std::string, std::string> first_difference(const std::string& before, const std::string& after,
                                                     bool may_add_levels) {
    auto a = lines_of(before);
    auto b = lines_of(after);
    const std::size_t longest = std::max(a.size(), b.size());
    a.resize(longest, "nothing");
    b.resize(longest, "nothing");
    for (std::size_t k = 0; k < longest; ++k) {
        if (a[k] != b[k] && !(may_add_levels && levels_added(a[k], b[k]))) return {a[k], b[k]};
    }
    return {};
}

}  // namespace

Identity identity_of(const Campaign& campaign) {
    Identity identity;
    identity.name = campaign.name;
    identity.scene = campaign.scene().name;
    identity.revision = campaign.scene().revision;
    identity.seed = campaign.seed;
    identity.condition = campaign.where;
    identity.design = campaign.design;
    const auto& design = designs::design_named(campaign.design);
    for (const auto& factor : campaign.space.factors) identity.factors += line_of(factor) + '\n';
    for (const auto& factor : campaign.space.factors) identity.factors += ties_of(factor);
    for (const auto& [name, value] : fixed_as_stated(campaign.space))
        identity.fixed += fmt::format("{} = {}\n", name, identity_text(value));
    for (const auto& [name, value] : campaign.request.options) {
        if (std::holds_alternative<designs::Rows>(value)) continue;  // compared row by row, by their cases
        const auto* option = find_option(design, name);
        if (option != nullptr && option->silent_by_default && value == option->default_value) continue;
        const bool extent = option != nullptr && option->extent;
        (extent ? identity.extent : identity.options) += fmt::format("{} = {}\n", name, text_of(value));
    }
    if (const auto& names = campaign.common_random_numbers; !names.empty())
        identity.options += fmt::format("common_random_numbers = {}\n", fmt::join(names, " "));
    return identity;
}

std::vector<StatedFactor> factors_of(const Identity& identity) {
    std::vector<StatedFactor> factors;
    std::vector<std::string> lines;
    for (const auto& line : lines_of(identity.factors)) {
        const bool grouped = line.starts_with(group_mark);
        if (!grouped && !line.starts_with(when_mark)) {
            factors.push_back(factor_in(line));
            lines.push_back(line);
            continue;
        }
        const auto [name, text] = name_and_rest(line.substr((grouped ? group_mark : when_mark).size()));
        const auto factor = std::ranges::find(factors, name, &StatedFactor::name);
        if (factor != factors.end()) (grouped ? factor->group : factor->when) = text;
    }
    add_distributions(factors, lines);
    return factors;
}

std::string factors_line(const std::vector<Factor>& factors) {
    std::string line;
    for (const auto& factor : factors) line.append(line.empty() ? "" : factor_separator).append(line_of(factor));
    return line;
}

std::vector<StatedFactor> factors_in(std::string_view line) {
    std::vector<StatedFactor> factors;
    const auto parts = split(line, factor_separator);
    for (const auto& part : parts) factors.push_back(factor_in(part));
    add_distributions(factors, parts);
    return factors;
}

std::vector<std::string> factor_names(const Identity& identity) {
    std::vector<std::string> names;
    for (const auto& line : lines_of(identity.factors))
        if (!line.starts_with(' ')) names.push_back(line.substr(0, line.find(' ')));
    return names;
}

std::map<std::string, std::string, std::less<>> options_in(const Identity& identity) {
    std::map<std::string, std::string, std::less<>> options;
    for (const auto& line : lines_of(identity.options + identity.extent)) options.insert(name_and_value(line));
    return options;
}

std::optional<std::int64_t> points_of(const Identity& identity) {
    const auto options = options_in(identity);
    const auto points = options.find("points");
    if (points == options.end()) return std::nullopt;
    return std::strtoll(points->second.c_str(), nullptr, 10);
}

std::string family_of(const Identity& identity) {
    const auto* design = designs::find_design(identity.design);
    const auto& all = identity.options + identity.extent;
    return fmt::format("{}\n{}\n{}\n{}\n{}\n{}\n{}", identity.scene, identity.revision, identity.factors,
                       identity.fixed, identity.condition, identity.design,
                       design == nullptr ? identity.options : options_of(*design, all, false));
}

std::string design_line(const Identity& identity) {
    std::string stated;  // options without a value have no say: the levels of a lattice whose factors have their own
    for (const auto& line : lines_of(identity.options + identity.extent))
        if (!line.ends_with("= ") && !line.ends_with('=')) stated += line + '\n';
    const auto options = in_one_line(stated);
    return identity.design + (options.empty() ? "" : ": ") + options;
}

std::string fixed_line(const Identity& identity) {
    return in_one_line(identity.fixed);
}

std::string larger_extent(std::string_view design, const std::string& before, const std::string& after) {
    const auto& info = designs::design_named(design);
    if (!info.extends) return after;
    std::map<std::string, std::int64_t> largest;
    for (const auto* text : {&before, &after}) {
        for (const auto& line : lines_of(options_of(info, *text, true))) {
            const auto [name, value] = name_and_value(line);
            auto& count = largest.try_emplace(name, 0).first->second;
            count = std::max<std::int64_t>(count, std::strtoll(value.c_str(), nullptr, 10));
        }
    }
    std::string lines;
    for (const auto& [name, count] : largest) lines += fmt::format("{} = {}\n", name, count);
    return lines;
}

namespace {

/// A design that cannot be extended keeps its first size.
void refuse_another_size(const Identity& stored, const Identity& asked, std::string_view archive) {
    const auto& design = designs::design_named(asked.design);
    if (design.extends) return;
    const auto factors = lines_of(asked.factors);
    const auto value_of = [](const std::string& text, const designs::OptionSpec& option) {
        for (const auto& line : lines_of(text)) {
            const auto [name, value] = name_and_value(line);
            if (name == option.name) return value;
        }
        return std::string{};
    };
    const auto shown = [](const std::string& value) { return value.empty() ? "none" : value; };
    for (const auto& option : design.options) {
        if (!option.extent || option.kind == designs::OptionSpec::Kind::rows) continue;
        const auto before = value_of(stored.options + stored.extent, option), after = value_of(asked.extent, option);
        const bool per_factor = option.kind == designs::OptionSpec::Kind::counts;
        if (before == after || (per_factor && counts_that_act(before, factors) == counts_that_act(after, factors)))
            continue;
        throw input_error(
            "$.design." + option.name, shown(after),
            fmt::format("campaign '{}' stands in '{}' with {}, and a {} of another size is another design, with other "
                        "points under the same numbers: give it a campaign name of its own; cases that both ask are "
                        "not computed again",
                        asked.name, archive, shown(before), asked.design));
    }
}

}  // namespace

std::int64_t sequences_of(const Campaign& campaign) {
    const auto found = campaign.request.options.find("sequences");
    const auto* count = found == campaign.request.options.end() ? nullptr : std::get_if<std::int64_t>(&found->second);
    return count == nullptr ? 1 : *count;
}

void require_same(const Identity& stored, const Identity& asked, std::string_view archive) {
    const auto refuse = [&](std::string_view where, std::string_view now, std::string_view before) {
        throw input_error(where, now,
                          fmt::format("campaign '{}' stands in '{}' with {}: another question needs another name",
                                      stored.name, archive, before));
    };
    const auto same = [&](std::string_view where, std::string_view what, const std::string& before,
                          const std::string& now, bool may_add_levels = false) {
        const auto [old, fresh] = first_difference(before, now, may_add_levels);
        if (old != fresh)
            refuse(where, without_values(fresh),
                   fmt::format("{}{}{}", what, what.empty() ? "" : " ", without_values(old)));
    };
    const auto& design = designs::design_named(asked.design);
    same("$.campaign", "the name", stored.name, asked.name);
    // The name of a machine is a hash, which tells the reader nothing.
    if (const auto shown = shown_scene(asked.scene); stored.scene != asked.scene && shown != asked.scene) {
        const bool part = shown == stored.scene;  // of an older program
        const bool changed = shown == shown_scene(stored.scene), program = shown.starts_with("program ");
        throw input_error(
            "$.scene", shown,
            fmt::format("campaign '{}' stands in '{}' with {}: give the campaign another name in the same database, or "
                        "continue it with {}",
                        stored.name, archive,
                        part      ? fmt::format("scene {} of an older program. Since then {} is a machine, whose cases "
                                                     "have other ids",
                                                shown, shown)
                        : changed ? fmt::format("another version of {}{}, whose {} changed", program ? "" : "machine ",
                                                shown, program ? "command or files have" : "file has")
                                  : fmt::format("scene {}", shown_scene(stored.scene)),
                        part ? "the program that wrote it (`grainsweep explain` names it)"
                             : "the scene that it was begun with"));
    }
    same("$.scene", "scene", stored.scene, asked.scene);
    if (stored.revision != asked.revision) {
        refuse("$.scene", fmt::format("revision {} of {}", asked.revision, asked.scene),
               fmt::format("revision {}, whose answers differ", stored.revision));
    }
    same("$.seed", "seed", std::to_string(stored.seed), std::to_string(asked.seed));
    same("$.design.kind", "design", stored.design, asked.design);
    same("$.factors", "factor", stored.factors, asked.factors,
         design.beginning == designs::Beginning::corner && !design.grows);
    same("$.fixed", "fixed", stored.fixed, asked.fixed);
    if (stored.condition != asked.condition) {
        refuse("$.where", asked.condition.empty() ? "none" : asked.condition,
               stored.condition.empty() ? "no condition" : fmt::format("the condition {}", stored.condition));
    }
    // The program, not the archive, defines which options belong to the extent. So both texts are sorted again.
    same("$.design", "design option", options_of(design, stored.options + stored.extent, false),
         options_of(design, asked.options + asked.extent, false));
    refuse_another_size(stored, asked, archive);
}

}  // namespace grainsweep::campaign
