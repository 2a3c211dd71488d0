// What makes a campaign the same campaign: its scene, factors, fixed values, condition, seed and kind of design.
//
// More points, levels or replicates extend it. Where an extension renumbers the points (a lattice with more
// levels), the new placement replaces the old one: cases are known by what they ask, so every answer is kept
// and those the new design asks for again are shared.
#include "sweep/campaign/wrong_question.hpp"
#include "sweep/store/archive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
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

/// Counts say how much of a design is asked, and may grow; these two say which.
bool says_which(std::string_view option, const designs::OptionValue& value) {
    return std::holds_alternative<std::string>(value) || option == "first" || option == "sequences";
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
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
    for (const auto& factor : campaign.space.factors) texts.factors += line_of(factor) + '\n';
    for (const auto& [name, value] : campaign.space.fixed)
        texts.fixed += fmt::format("{} = {}\n", name, campaign::identity_text(value));
    for (const auto& [name, value] : campaign.request.options) {
        if (std::holds_alternative<designs::Rows>(value)) continue;  // compared row by row, by what they ask
        (says_which(name, value) ? texts.options : texts.extent) += fmt::format("{} = {}\n", name, text_of(value));
    }
    return texts;
}

std::int64_t sequences_of(const Campaign& campaign) {
    const auto found = campaign.request.options.find("sequences");
    const auto* count = found == campaign.request.options.end() ? nullptr : std::get_if<std::int64_t>(&found->second);
    return count == nullptr ? 1 : *count;
}

std::optional<std::int64_t> match_campaign(const Store::Impl& archive, const Campaign& campaign) {
    const auto& db = archive.db;
    auto rows = db.ask(
        "SELECT campaign_id, name, scene, revision, seed, factors, fixed, condition, design, design_options "
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
    same("$.campaign", "the name", name, campaign.name);
    same("$.scene", "scene", rows.get<std::string>(2), campaign.scene().name);
    if (rows.get<std::int64_t>(3) != campaign.scene().revision) {
        refuse("$.scene", fmt::format("revision {} of {}", campaign.scene().revision, campaign.scene().name),
               fmt::format("revision {}, whose answers differ", rows.get<std::int64_t>(3)));
    }
    const auto seed = static_cast<std::uint64_t>(rows.get<std::int64_t>(4));
    same("$.seed", "seed", std::to_string(seed), std::to_string(campaign.seed));
    same("$.design.kind", "design", rows.get<std::string>(8), campaign.design);
    same("$.factors", "factor", rows.get<std::string>(5), texts.factors, campaign.design == "lattice");
    same("$.fixed", "fixed", rows.get<std::string>(6), texts.fixed);
    if (rows.get<std::string>(7) != campaign.where) {
        const std::string stored = rows.get<std::string>(7);
        refuse("$.where", campaign.where.empty() ? "none" : campaign.where,
               stored.empty() ? "no condition" : fmt::format("the condition {}", stored));
    }
    same("$.design", "design option", rows.get<std::string>(9), texts.options);
    return rows.get<std::int64_t>(0);
}

}  // namespace grainsweep::store
