// One value of one parameter: its type, its bounds, its words, its file.
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/quantity.hpp"
#include "sweep/campaign/reader.hpp"
#include "sweep/campaign/sections.hpp"
#include "sweep/files/whole_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <stdexcept>

namespace grainsweep::campaign {

namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t largest_named_file = 1ULL << 30U;

/// Unit and meaning for a message: " m".
std::string unit_of(const ParameterSpec& parameter) {
    return parameter.unit.empty() || parameter.unit == "1" ? "" : " " + parameter.unit;
}

Value read_file_word(const Cursor& place, const Words& words, const fs::path& folder) {
    std::vector<std::string> known = words.allowed;
    const auto name = place.text();
    std::error_code error;
    const fs::path path = fs::weakly_canonical(fs::absolute(folder / name, error), error);
    if (error || !fs::is_regular_file(path, error)) {
        for (const auto& entry : fs::directory_iterator(path.parent_path(), error)) {
            known.push_back(entry.path().filename().string());
        }
        place.refuse(fmt::format("must be {}{}a file beside the campaign file, and there is no such file",
                                 in_words(words.allowed), words.allowed.empty() ? "" : " or "),
                     nearest_word(name, known));
    }
    if (fs::file_size(path, error) > largest_named_file || error)
        place.refuse("the file must be readable and at most 1 GiB");
    const std::string contents = files::whole_file(path, error);
    if (error) place.refuse(fmt::format("the file cannot be read: {}", error.message()));
    if (words.check_file) {
        try {
            words.check_file(contents);
        } catch (const std::invalid_argument& reason) {
            place.refuse(fmt::format("the file is none of the kind asked for: {}", reason.what()));
        }
    }
    return fmt::format("file:{}:{}", content_hash(contents), path.string());
}

Value read_word(const Cursor& place, const ParameterSpec& parameter, const fs::path& folder) {
    const auto& words = std::get<Words>(parameter.bounds);
    const bool allowed =
        place.json().is_string() &&
        std::ranges::find(words.allowed, place.json().get_ref<const std::string&>()) != words.allowed.end();
    if (allowed || !words.file_allowed) return place.word(words.allowed);
    if (!place.json().is_string())
        place.refuse(fmt::format("'{}' must be a word or the name of a file", parameter.name));
    return read_file_word(place, words, folder);
}

}  // namespace

std::string rule_of(const ParameterSpec& parameter) {
    const bool whole = std::holds_alternative<std::int64_t>(parameter.default_value);
    return fmt::format("'{}' must be a {}number{}{}", parameter.name, whole ? "whole " : "",
                       in_words(std::get<Interval>(parameter.bounds)), unit_of(parameter));
}

Value read_value(const Cursor& place, const ParameterSpec& parameter, const fs::path& folder, Reads reads) {
    if (std::holds_alternative<std::string>(parameter.default_value)) return read_word(place, parameter, folder);
    const auto& bounds = std::get<Interval>(parameter.bounds);
    const bool whole = std::holds_alternative<std::int64_t>(parameter.default_value);
    const auto rule = rule_of(parameter);
    const auto& json = place.json();
    if (json.is_string()) {
        const auto value = in_si(json.get_ref<const std::string&>(), parameter.unit);
        if (const auto* why = std::get_if<std::string>(&value)) place.refuse(fmt::format("{}: {}", rule, *why));
        double number = std::get<double>(value);
        if (reads == Reads::difference) {  // 5 degC more are 5 K more
            const auto unit = unit_of_quantity(json.get_ref<const std::string&>());
            number -= std::get<double>(in_si(fmt::format("0 {}", unit), parameter.unit));
        }
        const Value counted = coerced(Value{number}, parameter.default_value);
        if (!bounds.contains(number) || counted.index() != parameter.default_value.index())
            place.refuse(fmt::format("{}, and this is {}{}", rule, shortest(number), unit_of(parameter)));
        return counted;
    }
    if (!json.is_number() || !bounds.contains(json.get<double>())) place.refuse(rule);
    if (!whole) return place.number(bounds);
    if (json.is_number_float() && coerced(Value{json.get<double>()}, parameter.default_value).index() != 1)
        place.refuse(rule);
    return place.whole(bounds);
}

Value parse_value(const ParameterSpec& parameter, std::string_view word, const fs::path& folder,
                  std::string_view where) {
    if (std::holds_alternative<std::string>(parameter.default_value)) {
        const Json json = std::string(word);
        return read_value(Cursor(json, std::string(where)), parameter, folder);
    }
    Json json = std::string(word);
    double real = 0;
    std::int64_t whole = 0;
    const char* end = word.data() + word.size();
    if (const auto [stop, error] = std::from_chars(word.data(), end, whole); error == std::errc() && stop == end) {
        json = whole;
    } else if (const auto [last, trouble] = std::from_chars(word.data(), end, real);
               trouble == std::errc() && last == end && real - real == 0) {
        json = real;
    }
    return read_value(Cursor(json, std::string(where)), parameter, folder);
}

}  // namespace grainsweep::campaign
