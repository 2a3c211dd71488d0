#include "sweep/campaign/identity.hpp"

#include "solver/scenes/scene.hpp"
#include "sweep/campaign/expressions.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/stated_distribution.hpp"
#include "sweep/campaign/stored_identity.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>

namespace grainsweep::campaign {

namespace {

const designs::OptionSpec* find_option(const designs::DesignInfo& design, std::string_view name) {
    const auto found = std::ranges::find(design.options, name, &designs::OptionSpec::name);
    return found == design.options.end() ? nullptr : &*found;
}

/// A file by its contents.
Value identity_value(const Value& value) {
    return std::holds_alternative<std::string>(value) ? Value{identity_text(value)} : value;
}

/// Returns the counts per factor that have an effect: without counts of factors with levels of their own. One count for
/// all factors is written out.
std::string counts_that_act(const designs::OptionValue* value, const std::vector<Factor>& factors) {
    if (value == nullptr) return {};
    const auto* one = std::get_if<std::int64_t>(value);
    const auto* several = std::get_if<std::vector<std::int64_t>>(value);
    const auto counts = one != nullptr       ? std::vector{*one}
                        : several != nullptr ? *several
                                             : std::vector<std::int64_t>();
    std::string acting;
    for (std::size_t j = 0; j < factors.size() && !counts.empty(); ++j)
        if (factors[j].continuous())
            acting += fmt::format(" {}", counts[counts.size() == 1 ? 0 : std::min(j, counts.size() - 1)]);
    return acting;
}

/// Returns whether the factor is the same, with all its old levels and new ones. A lattice may grow in this way.
bool levels_added(const Factor& was, const Factor& is) {
    const auto before = was.level_texts(), after = is.level_texts();
    return was.name == is.name && !before.empty() && std::ranges::all_of(before, [&](const auto& level) {
               return std::ranges::find(after, level) != after.end();
           });
}

/// Returns the first line in which two texts differ; "nothing" for a text that has ended.
std::pair<std::string, std::string> first_difference(const std::string& before, const std::string& after,
                                                     const std::function<bool(std::size_t)>& may_differ) {
    auto a = text_lines(before);
    auto b = text_lines(after);
    const std::size_t longest = std::max(a.size(), b.size());
    a.resize(longest, "nothing");
    b.resize(longest, "nothing");
    for (std::size_t k = 0; k < longest; ++k)
        if (a[k] != b[k] && !(may_differ && may_differ(k))) return {a[k], b[k]};
    return {};
}

/// Returns the lines in alphabetical order.
std::string sorted_lines(const std::string& text) {
    auto lines = text_lines(text);
    std::ranges::sort(lines);
    return fmt::format("{}\n", fmt::join(lines, "\n"));
}

}  // namespace

Identity identity_of(const Campaign& campaign) {
    Identity identity{.name = campaign.name,
                      .scene = campaign.scene().name,
                      .revision = campaign.scene().revision,
                      .seed = campaign.seed,
                      .factors = campaign.space.factors,
                      .fixed = fixed_as_stated(campaign.space),
                      .condition = campaign.where,
                      .design = campaign.design,
                      .options = campaign.request.options,
                      .common_random_numbers = campaign.common_random_numbers};
    for (auto& factor : identity.factors)
        if (auto* levels = std::get_if<Levels>(&factor.range))
            std::ranges::transform(levels->values, levels->values.begin(), identity_value);
    for (auto& [name, value] : identity.fixed) value = identity_value(value);
    const auto& design = designs::design_named(campaign.design);
    std::erase_if(identity.options, [&](const auto& entry) {
        const auto* option = find_option(design, entry.first);
        return std::holds_alternative<designs::Rows>(entry.second) ||  // compared row by row, by their cases
               (option != nullptr && option->silent_by_default && entry.second == option->default_value());
    });
    return identity;
}

bool asks_the_same(const Identity& a, const Identity& b) {
    const auto first = texts_of(a), second = texts_of(b);
    return a.scene == b.scene && a.revision == b.revision && first.factors == second.factors &&
           first.fixed == second.fixed;
}

const std::string* word_of(const Identity& identity, std::string_view option) {
    const auto found = identity.options.find(option);
    return found == identity.options.end() ? nullptr : std::get_if<std::string>(&found->second);
}

std::optional<std::int64_t> points_of(const Identity& identity) {
    const auto points = identity.options.find("points");
    const auto* count = points == identity.options.end() ? nullptr : std::get_if<std::int64_t>(&points->second);
    return count == nullptr ? std::nullopt : std::optional(*count);
}

std::string family_of(const Identity& identity) {
    const auto texts = texts_of(identity);
    return fmt::format("{}\n{}\n{}\n{}\n{}\n{}\n{}", identity.scene, identity.revision, texts.factors, texts.fixed,
                       identity.condition, identity.design, texts.options);
}

std::string design_line(const Identity& identity) {
    const auto texts = texts_of(identity);
    std::vector<std::string> stated;  // options without a value have no say: the levels of a lattice whose factors have
                                      // their own
    for (auto& line : text_lines(texts.options + texts.extent))
        if (!line.ends_with("= ")) stated.push_back(std::move(line));
    return fmt::format("{}{}{}", identity.design, stated.empty() ? "" : ": ", fmt::join(stated, ", "));
}

std::string fixed_line(const Identity& identity) {
    return fmt::format("{}", fmt::join(text_lines(texts_of(identity).fixed), ", "));
}

void keep_extent(Identity& later, const Identity& earlier) {
    const auto& design = designs::design_named(later.design);
    if (!design.extends) return;
    for (const auto& [name, value] : earlier.options) {
        const auto* option = find_option(design, name);
        const auto* before = std::get_if<std::int64_t>(&value);
        if (option == nullptr || !option->extent || before == nullptr) continue;
        auto& count = std::get<std::int64_t>(later.options.try_emplace(name, std::int64_t{0}).first->second);
        count = std::max(count, *before);
    }
}

namespace {

/// A design that cannot be extended keeps its first size.
void refuse_another_size(const Identity& stored, const Identity& asked, std::string_view archive) {
    const auto& design = designs::design_named(asked.design);
    if (design.extends) return;
    const auto shown = [](const designs::OptionValue* value) {
        const auto text = value == nullptr ? std::string() : text_of(*value);
        return text.empty() ? "none" : text;
    };
    for (const auto& option : design.options) {
        if (!option.extent || option.kind == Field::Kind::array) continue;
        const auto value_in = [&](const Identity& identity) {
            const auto found = identity.options.find(option.name);
            return found == identity.options.end() ? nullptr : &found->second;
        };
        const auto *before = value_in(stored), *after = value_in(asked);
        const bool per_factor = option.kind == Field::Kind::value;
        if (shown(before) == shown(after) ||
            (per_factor && counts_that_act(before, asked.factors) == counts_that_act(after, asked.factors)))
            continue;
        throw input_error(
            fmt::format("$.design.{}", option.name), shown(after),
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
                          const std::string& now, const std::function<bool(std::size_t)>& may_differ = {}) {
        const auto [old, fresh] = first_difference(before, now, may_differ);
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
    const auto before = texts_of(stored), now = texts_of(asked);
    const bool may_add_levels = design.beginning == designs::Beginning::corner && !design.grows;
    same("$.factors", "factor", before.factors, now.factors, [&](std::size_t k) {
        return may_add_levels && k < std::min(stored.factors.size(), asked.factors.size()) &&
               levels_added(stored.factors[k], asked.factors[k]);
    });
    same("$.fixed", "fixed", before.fixed, now.fixed);
    if (stored.condition != asked.condition) {
        refuse("$.where", asked.condition.empty() ? "none" : asked.condition,
               stored.condition.empty() ? "no condition" : fmt::format("the condition {}", stored.condition));
    }
    same("$.design", "design option", sorted_lines(before.options), sorted_lines(now.options));
    refuse_another_size(stored, asked, archive);
}

}  // namespace grainsweep::campaign
