#include "sweep/store/expression_text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <vector>

namespace grainsweep::store {
namespace {

struct Token {
    enum class Kind { word, quoted, sign } kind = Kind::sign;
    std::size_t at = 0;
    std::string_view text;

    [[nodiscard]] std::size_t end() const { return at + text.size(); }
    [[nodiscard]] bool is(std::string_view sign) const { return kind == Kind::sign && text == sign; }
    [[nodiscard]] bool is_word(std::string_view lower) const {
        return kind == Kind::word &&
               std::ranges::equal(text, lower, {}, [](unsigned char c) { return std::tolower(c); });
    }
};

bool part_of_word(char c) {
    const auto byte = static_cast<unsigned char>(c);
    return std::isalnum(byte) != 0 || c == '_' || c == '$' || c == '.' || byte >= 0x80;
}

/// Where the quoted text or comment ends that begins at `at`; none: it is neither. An open one ends with the
/// expression.
std::optional<std::size_t> closed_at(std::string_view all, std::size_t at) {
    const auto rest = all.substr(at);
    std::string_view close;
    if (rest.starts_with('\'') || rest.starts_with('"') || rest.starts_with('`')) close = rest.substr(0, 1);
    if (rest.starts_with('[')) close = "]";
    if (rest.starts_with("--")) close = "\n";
    if (rest.starts_with("/*")) close = "*/";
    if (close.empty()) return std::nullopt;
    const auto found = all.find(close, at + (close == "*/" ? 2 : 1));
    return found == std::string_view::npos ? all.size() : found + close.size();
}

/// A name, a keyword or a number with its exponent.
std::size_t word_end(std::string_view all, std::size_t at) {
    const bool number = std::isdigit(static_cast<unsigned char>(all[at])) != 0 || all[at] == '.';
    const bool hexadecimal = number && at + 1 < all.size() && (all[at + 1] == 'x' || all[at + 1] == 'X');
    std::size_t end = at;
    while (end < all.size()) {
        const bool exponent = number && !hexadecimal && (all[end] == '+' || all[end] == '-') &&
                              (all[end - 1] == 'e' || all[end - 1] == 'E');
        if (!part_of_word(all[end]) && !exponent) break;
        ++end;
    }
    return end;
}

/// Comments and blanks are left out.
std::vector<Token> tokens_of(std::string_view all) {
    constexpr std::array<std::string_view, 11> long_signs = {
        "->>", "->", "<<", ">>", "<=", ">=", "<>", "==", "!=", "||", "//"};
    std::vector<Token> tokens;
    for (std::size_t at = 0; at < all.size();) {
        if (std::isspace(static_cast<unsigned char>(all[at])) != 0) {
            ++at;
        } else if (const auto end = closed_at(all, at)) {
            const bool comment = all[at] == '-' || all[at] == '/';
            if (!comment) tokens.push_back({Token::Kind::quoted, at, all.substr(at, *end - at)});
            at = *end;
        } else if (part_of_word(all[at])) {
            tokens.push_back({Token::Kind::word, at, all.substr(at, word_end(all, at) - at)});
            at = tokens.back().end();
        } else {
            std::size_t length = 1;
            for (const auto sign : long_signs)
                if (all.substr(at).starts_with(sign)) length = std::max(length, sign.size());
            tokens.push_back({Token::Kind::sign, at, all.substr(at, length)});
            at += length;
        }
    }
    return tokens;
}

bool compares(const Token& token) {
    constexpr std::array<std::string_view, 8> signs = {"<", "<=", ">", ">=", "=", "==", "!=", "<>"};
    return token.kind == Token::Kind::sign && std::ranges::find(signs, token.text) != signs.end();
}

/// Operands and comparisons between two words that divide them, within one bracket.
struct Row {
    std::size_t first = 0;                 ///< its first token
    std::vector<std::size_t> comparisons;  ///< tokens
    bool has_between = false;
    bool between_is_open = false;  ///< the next AND belongs to it

    [[nodiscard]] std::optional<ChainedComparison> chain(std::string_view all, const std::vector<Token>& tokens,
                                                         std::size_t end) const {
        if (comparisons.size() < 2) return std::nullopt;
        const auto part = [&](std::size_t from, std::size_t to) {
            return all.substr(tokens[from].at, tokens[to - 1].end() - tokens[from].at);
        };
        if (comparisons.front() == first || comparisons.back() + 1 == end) return std::nullopt;  // SQLite refuses it
        ChainedComparison found{part(first, end), {}};
        for (std::size_t k = 0; k < comparisons.size() && !has_between; ++k) {
            const auto from = k == 0 ? first : comparisons[k - 1] + 1;
            const auto to = k + 1 == comparisons.size() ? end : comparisons[k + 1];
            if (from == comparisons[k]) return std::nullopt;
            found.meant += (k == 0 ? "" : " AND ") + std::string(part(from, to));
        }
        return found;
    }
};

}  // namespace

bool unbalanced(std::string_view expression) {
    int depth = 0;
    for (const auto& token : tokens_of(expression)) {
        if (token.is("(")) ++depth;
        if (token.is(")") && --depth < 0) return true;
    }
    return depth != 0;
}

std::string with_real_division(std::string_view expression) {
    std::string real;
    std::size_t copied = 0;
    for (const auto& token : tokens_of(expression)) {
        if (!token.is("/")) continue;
        real.append(expression.substr(copied, token.at - copied)).append("*1.0");
        copied = token.at;
    }
    return real.append(expression.substr(copied));
}

std::optional<ChainedComparison> chained_comparison(std::string_view expression) {
    const auto tokens = tokens_of(expression);
    std::vector<Row> rows(1);
    for (std::size_t k = 0; k <= tokens.size(); ++k) {
        const bool end = k == tokens.size();
        const auto is_word = [&](std::string_view word) { return !end && tokens[k].is_word(word); };
        const bool opens = !end && (tokens[k].is("(") || is_word("case"));
        const bool closes = !end && (tokens[k].is(")") || is_word("end"));
        Row& row = rows.back();
        if (is_word("and") && row.between_is_open) {
            row.between_is_open = false;
            continue;
        }
        const bool divides = end || closes || is_word("and") || is_word("or") || is_word("when") || is_word("then") ||
                             is_word("else") || tokens[k].is(",");
        if (divides) {
            if (auto chain = row.chain(expression, tokens, k)) return chain;
            row = {.first = k + 1, .comparisons = {}};
        } else if (is_word("not") && row.first == k) {
            row.first = k + 1;
        } else if (is_word("between") || compares(tokens[k])) {
            row.comparisons.push_back(k);
            if (is_word("between")) row.has_between = row.between_is_open = true;
        }
        if (closes && rows.size() > 1) rows.pop_back();
        if (opens) rows.push_back({.first = k + 1, .comparisons = {}});
    }
    return std::nullopt;
}

}  // namespace grainsweep::store
