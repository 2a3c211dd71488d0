// What makes a campaign the same campaign: its scene, factors, fixed values, condition, seed and kind of design.
//
// More points or replicates extend it, where the design extends; of a design that does not, another size is another
// design. Levels that a factor of a lattice gains renumber the points: the new placement replaces the old one. Cases
// are known by what they ask, so every answer is kept and shared.
#include "sweep/campaign/wrong_question.hpp"
#include "sweep/store/archive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <set>
#include <sstream>

namespace grainsweep::store {

using campaign::Campaign;

namespace {

std::string joined(const std::vector<Value>& values) {
    std::string text;
    for (const auto& value : values) text += (text.empty() ? "" : " | ") + campaign::identity_text(value);
    return text;
}

std::string line_of(const campaign::Factor& factor) {
    if (const auto* between = std::get_if<campaign::Between>(&factor.range)) {
        return fmt::format("{} between {} {} {}", factor.name, campaign::shortest(between->low),
                           campaign::shortest(between->high),
                           between->scale == campaign::Scale::log ? "log" : "linear");
    }
    return fmt::format("{} levels {}", factor.name, joined(std::get<campaign::Levels>(factor.range).values));
}

std::string text_of(const designs::OptionValue& value) {
    if (const auto* count = std::get_if<std::int64_t>(&value)) return std::to_string(*count);
    if (const auto* word = std::get_if<std::string>(&value)) return *word;
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

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

/// The lines of those options that say which design it is, or of those that say how much of it is asked.
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

/// Counts per factor as they act: without those of factors whose own levels decide, and one for all written out.
std::string counts_that_act(const std::string& value, const std::vector<std::string>& factors) {
    std::istringstream stream(value);
    std::vector<std::int64_t> counts;
    for (std::int64_t count = 0; stream >> count;) counts.push_back(count);
    std::string acting;
    for (std::size_t j = 0; j < factors.size() && !counts.empty(); ++j) {
        if (factors[j].find(" between ") == std::string::npos) continue;
        acting += fmt::format(" {}", counts[counts.size() == 1 ? 0 : std::min(j, counts.size() - 1)]);
    }
    return acting;
}

/// The same factor with every old level kept: a lattice grows so.
bool levels_added(std::string_view before, std::string_view after) {
    const auto parts = [](std::string_view line) {
        std::vector<std::string_view> words;
        const auto start = line.find(" levels ");
        if (start == std::string_view::npos) return words;
        words.push_back(line.substr(0, start));
        line.remove_prefix(start + 8);
        for (auto bar = line.find(" | "); bar != std::string_view::npos; bar = line.find(" | ")) {
            words.push_back(line.substr(0, bar));
            line.remove_prefix(bar + 3);
        }
        words.push_back(line);
        return words;
    };
    const auto old_words = parts(before);
    const auto new_words = parts(after);
    return !old_words.empty() && !new_words.empty() && old_words.front() == new_words.front() &&
           std::ranges::all_of(old_words,
                               [&](auto word) { return std::ranges::find(new_words, word) != new_words.end(); });
}

/// First line in which two texts differ, "nothing" where one has ended.
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

CampaignTexts texts_of(const Campaign& campaign) {
    CampaignTexts texts;
    const auto& design = designs::design_named(campaign.design);
    for (const auto& factor : campaign.space.factors) texts.factors += line_of(factor) + '\n';
    for (const auto& [name, value] : campaign.space.fixed)
        texts.fixed += fmt::format("{} = {}\n", name, campaign::identity_text(value));
    for (const auto& [name, value] : campaign.request.options) {
        if (std::holds_alternative<designs::Rows>(value)) continue;  // compared row by row, by what they ask
        const auto* option = find_option(design, name);
        const bool extent = option != nullptr && option->extent;
        (extent ? texts.extent : texts.options) += fmt::format("{} = {}\n", name, text_of(value));
    }
    return texts;
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

/// A design that does not extend stands as it was asked first.
void refuse_another_size(const Store::Impl& archive, const Campaign& campaign, const std::string& stored,
                         const CampaignTexts& asked) {
    const auto& design = designs::design_named(campaign.design);
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
        const auto before = value_of(stored, option), after = value_of(asked.extent, option);
        const bool per_factor = option.kind == designs::OptionSpec::Kind::counts;
        if (before == after || (per_factor && counts_that_act(before, factors) == counts_that_act(after, factors)))
            continue;
        throw campaign::wrong_question(
            "$.design." + option.name, shown(after),
            fmt::format("campaign '{}' stands in '{}' with {}, and a {} of another size is another design, with other "
                        "points under the same numbers: give it a campaign name of its own; cases that both ask are "
                        "not computed again",
                        campaign.name, archive.file.string(), shown(before), campaign.design));
    }
}

}  // namespace

std::int64_t sequences_of(const Campaign& campaign) {
    const auto found = campaign.request.options.find("sequences");
    const auto* count = found == campaign.request.options.end() ? nullptr : std::get_if<std::int64_t>(&found->second);
    return count == nullptr ? 1 : *count;
}

std::optional<std::int64_t> match_campaign(const Store::Impl& archive, const Campaign& campaign) {
    const auto& db = archive.db;
    auto rows = db.ask(
        "SELECT campaign_id, name, scene, revision, seed, factors, fixed, condition, design, design_options, "
        "design_extent "
        "FROM campaign WHERE name = ?",
        campaign.name);
    if (!rows.next()) return std::nullopt;

    const std::string name = rows.get<std::string>(1);
    const auto refuse = [&](std::string_view where, std::string_view asked, std::string_view stored) {
        throw campaign::wrong_question(
            where, asked,
            fmt::format("campaign '{}' stands in '{}' with {}: another question needs another name", name,
                        archive.file.string(), stored));
    };
    const auto same = [&](std::string_view where, std::string_view what, const std::string& stored,
                          const std::string& asked, bool may_add_levels = false) {
        const auto [before, after] = first_difference(stored, asked, may_add_levels);
        if (before != after) refuse(where, after, what.empty() ? before : fmt::format("{} {}", what, before));
    };
    const auto texts = texts_of(campaign);
    const auto& design = designs::design_named(campaign.design);
    same("$.campaign", "the name", name, campaign.name);
    same("$.scene", "scene", rows.get<std::string>(2), campaign.scene().name);
    if (rows.get<std::int64_t>(3) != campaign.scene().revision) {
        refuse("$.scene", fmt::format("revision {} of {}", campaign.scene().revision, campaign.scene().name),
               fmt::format("revision {}, whose answers differ", rows.get<std::int64_t>(3)));
    }
    const auto seed = static_cast<std::uint64_t>(rows.get<std::int64_t>(4));
    same("$.seed", "seed", std::to_string(seed), std::to_string(campaign.seed));
    same("$.design.kind", "design", rows.get<std::string>(8), campaign.design);
    same("$.factors", "factor", rows.get<std::string>(5), texts.factors,
         design.beginning == designs::Beginning::corner);
    same("$.fixed", "fixed", rows.get<std::string>(6), texts.fixed);
    if (rows.get<std::string>(7) != campaign.where) {
        const std::string stored = rows.get<std::string>(7);
        refuse("$.where", campaign.where.empty() ? "none" : campaign.where,
               stored.empty() ? "no condition" : fmt::format("the condition {}", stored));
    }
    // Which option is of the extent is the program's to say, not the archive's: both texts are sorted anew.
    const auto options = rows.get<std::string>(9) + rows.get<std::string>(10);
    same("$.design", "design option", options_of(design, options, false),
         options_of(design, texts.options + texts.extent, false));
    refuse_another_size(archive, campaign, options, texts);
    return rows.get<std::int64_t>(0);
}

}  // namespace grainsweep::store
