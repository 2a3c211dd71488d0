#include "sweep/campaign/cursor.hpp"

#include "sweep/campaign/field_text.hpp"

#include "sweep/campaign/case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ranges>

namespace grainsweep::campaign {

void Cursor::refuse(std::string_view rule, std::string_view suggestion) const {
    throw input_error(path_, shown(*value_), rule, suggestion);
}

double Cursor::number(const Interval& bounds) const {
    if (!value_->is_number()) refuse(fmt::format("must be a number{}", in_words(bounds)));
    const auto x = value_->get<double>();
    if (!bounds.contains(x)) refuse(fmt::format("must be a number{}", in_words(bounds)));
    return x == 0 ? 0 : x;
}

std::int64_t Cursor::whole(const Interval& bounds) const {
    constexpr double limit = 0x1p63;
    const auto rule = [&] { return fmt::format("must be a whole number{}", in_words(bounds)); };
    if (!value_->is_number()) refuse(rule());
    const auto x = value_->get<double>();
    if (!bounds.contains(x) || !(x >= -limit && x < limit)) refuse(rule());
    if (!value_->is_number_float()) return value_->get<std::int64_t>();
    if (x != std::floor(x)) refuse(rule());
    return static_cast<std::int64_t>(x);
}

bool Cursor::flag() const {
    if (!value_->is_boolean()) refuse("must be true or false");
    return value_->get<bool>();
}

std::string Cursor::text() const {
    if (!value_->is_string() || value_->get_ref<const std::string&>().empty()) refuse("must be a non-empty text");
    return value_->get<std::string>();
}

std::string Cursor::word(const WordList& words) const {
    const auto rule = [&] { return fmt::format("must be {}", in_words(words)); };
    if (!value_->is_string()) refuse(rule());
    const auto& word = value_->get_ref<const std::string&>();
    if (std::ranges::find(words, word) == words.end()) refuse(rule(), nearest_word(word, words));
    return word;
}

std::vector<Cursor> Cursor::elements() const {
    if (!value_->is_array()) refuse("must be a list");
    std::vector<Cursor> cursors;
    cursors.reserve(value_->size());
    for (std::size_t k = 0; k < value_->size(); ++k) cursors.push_back((*this)[k]);
    return cursors;
}

/// Calls visit(name) for every member but notes, which are checked. No path is made before there is an error: a
/// campaign reads its machine once a case.
template <class Visit>
static void each_member(const Cursor& place, Visit&& visit) {
    for (const auto& [name, value] : place.json().items()) {
        if (name == schema_key) continue;
        if (name != notes_key) {
            visit(name);
            continue;
        }
        const bool texts = value.is_array() && std::ranges::all_of(value, [](const Json& x) { return x.is_string(); });
        if (!value.is_string() && !texts) place[name].refuse("notes are a text or a list of texts");
    }
}

std::vector<std::pair<std::string, Cursor>> Cursor::members(std::string_view rule) const {
    if (!value_->is_object()) refuse(rule);
    std::vector<std::pair<std::string, Cursor>> members;
    each_member(*this, [&](const std::string& name) { members.emplace_back(name, (*this)[name]); });
    return members;
}

Section::Section(Cursor place, std::span<const Field> keys) : place_(std::move(place)), keys_(keys) {
    if (!place_.json().is_object()) place_.refuse("must be an object");
    each_member(place_, [&](const std::string& name) {
        if (std::ranges::find(keys_, name, &Field::name) != keys_.end()) return;
        WordList known(std::views::transform(keys_, &Field::name));
        known.push_back(notes_key);
        throw input_error(path_of(place_.path(), name), "",
                          fmt::format("unknown key; {} has {}", place_.path(), in_words(known)),
                          nearest_word(name, known));
    });
    for (const auto& key : keys_) {
        if (key.required && !place_.json().contains(key.name)) {
            throw input_error(place_.path(), "", fmt::format("key '{}' is missing: {}", key.name, meaning_text(key)));
        }
    }
}

std::optional<Cursor> Section::find(std::string_view key) const {
    if (!place_.json().contains(key)) return std::nullopt;
    return place_[key];
}

Cursor Section::at(std::string_view key) const {
    return place_[key];
}

const Field& Section::row(std::string_view key) const {
    return *std::ranges::find(keys_, key, &Field::name);
}

double Section::number(std::string_view key, double standard) const {
    const auto cursor = find(key);
    return cursor ? cursor->number(row(key).bounds) : standard;
}

std::int64_t Section::whole(std::string_view key, std::int64_t standard) const {
    const auto cursor = find(key);
    return cursor ? cursor->whole(row(key).bounds) : standard;
}

std::int64_t Section::whole_or_word(std::string_view key, std::int64_t standard, std::int64_t of_word) const {
    const auto cursor = find(key);
    if (!cursor) return standard;
    const Field& known = row(key);
    const auto& value = cursor->json();
    const std::string rule =
        fmt::format("must be {} or a whole number{}", in_words(known.words), in_words(known.bounds));
    if (value.is_string()) {
        const auto& word = value.get_ref<const std::string&>();
        if (std::ranges::find(known.words, word) == known.words.end())
            cursor->refuse(rule, nearest_word(word, known.words));
        return of_word;
    }
    const bool whole = value.is_number() && value.get<double>() == std::floor(value.get<double>());
    if (!whole || !known.bounds.contains(value.get<double>())) cursor->refuse(rule);
    return cursor->whole(known.bounds);
}

bool Section::flag(std::string_view key, bool standard) const {
    const auto cursor = find(key);
    return cursor ? cursor->flag() : standard;
}

std::string Section::word(std::string_view key, std::string_view standard) const {
    const auto cursor = find(key);
    return cursor ? cursor->word(row(key).words) : std::string(standard);
}

std::vector<std::string> Section::words(std::string_view key, const std::vector<std::string>& standard) const {
    const auto cursor = find(key);
    if (!cursor) return standard;
    const auto& allowed = row(key).words;
    std::vector<std::string> words;
    for (const auto& element : cursor->elements()) {
        const auto begins = [&](std::string_view word) {
            return word.ends_with(':') && element.json().is_string() &&
                   element.json().get_ref<const std::string&>().starts_with(word);
        };
        const bool free = allowed.empty() || std::ranges::any_of(allowed, begins);
        words.push_back(free ? element.text() : element.word(allowed));
    }
    return words;
}

std::string in_words(const Interval& bounds) {
    const bool below = std::isfinite(bounds.low);
    const bool above = std::isfinite(bounds.high);
    const auto plain = [](double x) {  // 1000000 rather than 1e+06
        const bool whole = x == std::floor(x) && std::abs(x) < 0x1p63;
        return whole ? std::to_string(static_cast<std::int64_t>(x)) : shortest(x);
    };
    std::string words;
    if (below) words += fmt::format(" {} {}", bounds.low_open ? "above" : "from", plain(bounds.low));
    if (below && above && bounds.low_open) words += " and";
    if (above && bounds.high_open)
        words += fmt::format(" {} {}", below && !bounds.low_open ? "to below" : "below", plain(bounds.high));
    if (above && !bounds.high_open)
        words += fmt::format(" {} {}", below && !bounds.low_open ? "to" : "up to", plain(bounds.high));
    return words;
}

std::string in_words(const WordList& words) {
    std::string list;
    for (std::size_t k = 0; k < words.size(); ++k) {
        if (k > 0) list += k + 1 == words.size() ? " or " : ", ";
        list += fmt::format("'{}'", words[k]);
    }
    return list;
}

}  // namespace grainsweep::campaign
