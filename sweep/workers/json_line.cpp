#include "sweep/workers/json_line.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>

namespace grainsweep::workers::json_line {
namespace {

using Json = nlohmann::json;

/// Neither ends a text nor begins an escape, and is one byte long.
bool is_plain(char c) {
    return c >= 0x20 && c < 0x7F && c != '"' && c != '\\';
}

bool begins_with_digit(std::string_view text) {
    return !text.empty() && text.front() >= '0' && text.front() <= '9';
}

bool is_real(std::string_view number) {
    return number.find_first_of(".eE") != std::string_view::npos;
}

}  // namespace

void Writer::put(const Value& value) {
    std::visit([&](const auto& held) { put(held); }, value);
}

void Writer::put(const Sample& sample) {
    line += '[';
    for (const double number : {sample.time, sample.bin, sample.value}) separate(), put(number);
    line += ']';
}

bool Reader::takes(std::string_view word) {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\r"), rest_.size()));
    if (!rest_.starts_with(word)) return false;
    rest_.remove_prefix(word.size());
    if (!word.empty()) last_ = word.back();
    return true;
}

void Reader::expect(std::string_view word) {
    if (!takes(word)) refuse("it is no such JSON");
}

bool Reader::takes_member(std::string_view name) {
    const auto before = rest_;
    const char last = last_;
    if ((last_ == '{' || takes(",")) && takes("\"") && rest_.starts_with(name)) {
        rest_.remove_prefix(name.size());
        if (rest_.starts_with('"') && takes("\"") && takes(":")) return true;
    }
    rest_ = before;
    last_ = last;
    return false;
}

void Reader::get(std::string& text) {
    expect("\"");
    auto end = static_cast<std::size_t>(std::ranges::find_if_not(rest_, is_plain) - rest_.begin());
    const bool plain = end < rest_.size() && rest_[end] == '"';
    while (end < rest_.size() && rest_[end] != '"') end += rest_[end] == '\\' ? 2 : 1;
    if (end >= rest_.size()) refuse("a text has no end");
    text = rest_.substr(0, end);
    rest_.remove_prefix(end);
    expect("\"");
    if (plain) return;
    try {
        text = Json::parse("\"" + text + "\"").get<std::string>();
    } catch (const Json::exception& error) {
        refuse(error.what());
    }
}

void Reader::get(bool& set) {
    set = takes("true");
    if (!set) expect("false");
}

std::string_view Reader::number_word() {
    (void)takes("");
    const auto found = rest_.substr(0, rest_.find_first_not_of("0123456789+-.eE"));
    rest_.remove_prefix(found.size());
    last_ = '0';
    return found;
}

bool Reader::is_number(std::string_view word) {
    const auto digits = word.starts_with('-') ? word.substr(1) : word;
    const auto point = digits.find('.');
    return begins_with_digit(digits) && !(digits.front() == '0' && begins_with_digit(digits.substr(1))) &&
           (point == std::string_view::npos || begins_with_digit(digits.substr(point + 1)));
}

void Reader::get(double& number) {
    number = std::numeric_limits<double>::quiet_NaN();
    if (takes("null")) return;
    const auto word = number_word();
    if (is_real(word)) return number_in(word, number);
    std::int64_t whole = 0;  // as another program may write it
    number_in(word, whole);
    number = static_cast<double>(whole);
}

void Reader::get(Value& value) {
    (void)takes("");
    if (rest_.starts_with('"')) return get(value.emplace<std::string>());
    const auto word = number_word();
    if (is_real(word))
        number_in(word, value.emplace<double>());
    else
        number_in(word, value.emplace<std::int64_t>());
}

void Reader::get(Sample& sample) {
    expect("[");
    get(sample.time);
    expect(",");
    get(sample.bin);
    expect(",");
    get(sample.value);
    expect("]");
}

bool Reader::over() {
    (void)takes("");
    return rest_.empty();
}

void Reader::refuse(const char* what) {
    throw std::invalid_argument(what);
}

}  // namespace grainsweep::workers::json_line
