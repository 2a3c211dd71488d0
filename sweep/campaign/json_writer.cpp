#include "sweep/campaign/json_writer.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace grainsweep::campaign {
namespace {

/// Neither ends a text nor begins an escape, and is one byte long.
bool is_plain_in_json(char c) {
    return c >= 0x20 && c < 0x7F && c != '"' && c != '\\';
}

template <class Whole>
void append_digits(std::string& to, Whole whole) {
    std::array<char, 24> digits{};
    to.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), whole).ptr);
}

}  // namespace

void append_json(std::string& to, double number) {
    if (!std::isfinite(number)) {
        to += "null";
        return;
    }
    std::array<char, 64> digits{};
    to.append(digits.data(), nlohmann::detail::to_chars(digits.data(), digits.data() + digits.size(), number));
}

void append_json(std::string& to, std::int64_t whole) {
    append_digits(to, whole);
}

void append_json(std::string& to, std::uint64_t whole) {
    append_digits(to, whole);
}

void append_json(std::string& to, std::string_view words) {
    if (std::ranges::all_of(words, is_plain_in_json))
        to.append("\"").append(words) += '"';
    else
        to += nlohmann::json(words).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

JsonText::JsonText() : text_("null") {}
JsonText::JsonText(const JsonText&) = default;
JsonText::JsonText(JsonText&&) noexcept = default;
JsonText& JsonText::operator=(const JsonText&) = default;
JsonText& JsonText::operator=(JsonText&&) noexcept = default;
JsonText::~JsonText() = default;

JsonText::JsonText(std::initializer_list<Member> members) : text_("{}") {
    for (const auto& [name, value] : members) add(name, value);
}

JsonText JsonText::array() {
    JsonText value;
    value.text_ = "[]";
    return value;
}

JsonText JsonText::object() {
    JsonText value;
    value.text_ = "{}";
    return value;
}

void JsonText::push_back(const JsonText& value) {
    text_.pop_back();
    if (text_.size() > 1) text_ += ',';
    text_ += value.text_;
    text_ += ']';
}

JsonText& JsonText::add(std::string_view name, const JsonText& value) {
    if (text_ == "null") text_ = "{}";
    text_.pop_back();
    if (text_.size() > 1) text_ += ',';
    append_json(text_, name);
    text_ += ':';
    text_ += value.text_;
    text_ += '}';
    return *this;
}

JsonText& JsonText::add(const JsonText& object) {
    if (object.text_.size() <= 2) return *this;
    text_.pop_back();
    if (text_.size() > 1) text_ += ',';
    text_.append(object.text_, 1);
    return *this;
}

}  // namespace grainsweep::campaign
