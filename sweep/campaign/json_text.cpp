#include "sweep/campaign/json_text.hpp"

#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/json_builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <utility>

namespace grainsweep::campaign {

namespace {

constexpr std::size_t deepest = 32;
constexpr std::size_t longest_shown = 60;

/// Line and column (in characters) of a byte, both from 1.
std::string place_of(std::string_view text, std::size_t byte) {
    const std::string_view before = text.substr(0, std::min(byte, text.size()));
    const auto line = std::ranges::count(before, '\n') + 1;
    const std::size_t start = before.rfind('\n') == std::string_view::npos ? 0 : before.rfind('\n') + 1;
    const auto continuation = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; };
    const std::string_view in_line = before.substr(start);
    const auto column = static_cast<std::ptrdiff_t>(in_line.size()) - std::ranges::count_if(in_line, continuation) + 1;
    return fmt::format("line {}, column {}", line, column);
}

/// Returns the parser's message without its own statement of the place: "unexpected end of input; expected '}'".
std::string complaint_of(std::string_view what) {
    if (const auto marker = what.find("last read: '"); marker != std::string_view::npos) {
        // The quoted token may hold any bytes: it is shown by the caller, escaped.
        const auto end = what.rfind('\'');
        std::string_view head = what.substr(0, marker);
        while (head.ends_with(' ') || head.ends_with(';')) head.remove_suffix(1);
        std::string joined(head);
        if (end != std::string_view::npos && end + 1 < what.size()) joined += what.substr(end + 1);
        return complaint_of(joined);
    }
    const auto dash = what.rfind(" - ");
    if (dash != std::string_view::npos) return std::string(what.substr(dash + 3));
    const auto bracket = what.find("] ");
    return std::string(bracket == std::string_view::npos ? what : what.substr(bracket + 2));
}

/// Returns the word or number around a byte, or the byte alone, with its start.
std::pair<std::size_t, std::string> word_at(std::string_view text, std::size_t byte) {
    const auto of_word = [&](std::size_t k) {
        const char c = text[k];
        return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '+' || c == '-' || c == '.';
    };
    byte = std::min(byte, text.size() - 1);
    if (!of_word(byte)) return {byte, std::string(text.substr(byte, 1))};
    std::size_t start = byte;
    std::size_t end = byte + 1;
    while (start > 0 && byte - start < longest_shown && of_word(start - 1)) --start;
    while (end < text.size() && end - byte < longest_shown && of_word(end)) ++end;
    return {start, std::string(text.substr(start, end - start))};
}

/// Returns the last byte before `end` that is no white space; npos: none.
std::size_t last_before(std::string_view text, std::size_t end) {
    return text.substr(0, end).find_last_not_of(" \t\r\n");
}

/// Construct of other dialects of JSON at which the parser stopped: its beginning, its characters, and the right form.
struct Dialect {
    std::size_t byte = 0;
    std::string word;
    std::string rule;
};

std::optional<Dialect> dialect_at(std::string_view text, std::size_t byte) {
    if (byte >= text.size()) return std::nullopt;
    // A comment: the parser stops within its first two bytes.
    for (const std::size_t start : {byte, byte == 0 ? byte : byte - 1})
        for (const std::string_view mark : {"//", "/*", "#"})
            if (text.substr(start).starts_with(mark))
                return Dialect{start, std::string(mark),
                               "JSON has no comments; write \"notes\": \"...\", in any object"};
    const std::size_t before = last_before(text, byte);
    const bool closes = text[byte] == ']' || text[byte] == '}';
    if (closes && before != std::string_view::npos && text[before] == ',')
        return Dialect{before, ",",
                       fmt::format("a trailing comma: JSON has none before '{}'; take it out", text[byte])};
    if (text[byte] == '\'') return Dialect{byte, "'", "JSON has its texts and keys in double quotes"};
    return std::nullopt;
}

/// Names places by JSON paths, and by line and column.
class CampaignJson final : public JsonBuilder {
public:
    explicit CampaignJson(std::string_view text) : JsonBuilder(deepest), text_(text) {}

    bool string(string_t& value) override {
        if (value.find('\0') != std::string::npos)
            throw input_error(here(), shown(value), "a text must not contain the NUL character");
        return JsonBuilder::string(value);
    }
    bool parse_error(std::size_t position, const std::string& token,
                     const nlohmann::detail::exception& error) override {
        const std::string complaint = complaint_of(error.what());
        if (const auto dialect = dialect_at(text_, position == 0 ? 0 : position - 1))
            throw input_error(place_of(text_, dialect->byte), shown(dialect->word), dialect->rule);
        if (complaint.find("invalid string") != std::string::npos) {
            throw input_error(place_of(text_, position - 1), shown(token), "not JSON: " + complaint);
        }
        if (complaint.find("unexpected end of input") != std::string::npos) {
            throw input_error(place_of(text_, text_.size()), "", "not JSON: " + complaint);
        }
        const auto [start, word] = word_at(text_, position == 0 ? 0 : position - 1);
        std::string rule = "not JSON: " + complaint;
        if (complaint.find("number overflow") != std::string::npos)
            rule = "a number must be finite in double precision";
        if (word == "NaN" || word.ends_with("Infinity")) rule = "JSON has no NaN and no Infinity";
        throw input_error(place_of(text_, start), shown(word), rule);
    }

private:
    void refuse_twice() const override { throw input_error(here(), "", "this key is there twice; keep one"); }
    void refuse_depth() const override {
        throw input_error(here(), "", fmt::format("nested deeper than {} levels; a campaign needs 6", deepest));
    }
    [[nodiscard]] std::string here() const {
        std::string path = "$";
        for (const auto& frame : frames())
            path = frame.value.is_object() ? path_of(path, frame.key) : path_of(path, frame.value.size());
        return path;
    }

    std::string_view text_;
};

}  // namespace

Json parse_json(std::string_view text) {
    constexpr std::string_view utf8_mark = "\xEF\xBB\xBF";
    if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) {
        throw input_error("line 1, column 1", "a UTF-16 byte-order mark", "the file must be UTF-8 text");
    }
    if (text.starts_with(utf8_mark)) text.remove_prefix(utf8_mark.size());
    if (text.find_first_not_of(" \t\r\n") == std::string_view::npos) {
        throw input_error("line 1, column 1", "nothing", "a campaign file is one JSON object");
    }
    CampaignJson builder(text);
    Json::sax_parse(text.begin(), text.end(), &builder);
    return std::move(builder.result);
}

std::string shown(const Json& value) {
    std::string text = value.dump(-1, ' ', true, Json::error_handler_t::replace);
    if (text.size() > longest_shown) text = text.substr(0, longest_shown - 4) + " ...";
    return text;
}

std::string path_of(std::string_view parent, std::string_view key) {
    const auto plain = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-'; };
    if (!key.empty() && key.size() <= longest_shown && std::ranges::all_of(key, plain)) {
        return std::string(parent).append(1, '.').append(key);
    }
    return fmt::format("{}[{}]", parent, shown(std::string(key)));
}

std::string path_of(std::string_view parent, std::size_t index) {
    return std::string(parent).append(1, '[').append(std::to_string(index)).append(1, ']');
}

}  // namespace grainsweep::campaign
