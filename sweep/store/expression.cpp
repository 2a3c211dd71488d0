#include "sweep/store/expression.hpp"

#include "sweep/campaign/input_error.hpp"
#include "sweep/store/database.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

namespace grainsweep::store {
namespace {

// ---- checks and changes of the text before SQLite parses it
//
// Conditions are about quantities, so two rules of SQL do not apply. In SQL the quotient of whole numbers is a whole
// number (1/2 is 0). And a comparison is a number that can be compared again: 0.2 < a < 0.5 is (0.2 < a) < 0.5, always
// true.

/// Consecutive comparisons without AND, OR or brackets between them.
struct ChainedComparison {
    std::string_view text;  ///< "0.2 < a < 0.5"
    std::string meant;      ///< "0.2 < a AND a < 0.5"; empty if it contains a BETWEEN
};

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

/// Returns whether brackets are unbalanced. Brackets in quotes and comments do not count.
bool unbalanced(std::string_view expression) {
    int depth = 0;
    for (const auto& token : tokens_of(expression)) {
        if (token.is("(")) ++depth;
        if (token.is(")") && --depth < 0) return true;
    }
    return depth != 0;
}

/// Returns the expression with real quotients: "a*1.0/b" for "a/b". The factor stands left of the division, so the
/// order of evaluation does not change: a * b / c is a * b *1.0/ c.
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

// ---- compiled by SQLite

// A condition is about one case. If it needs more than this, it is a mistake or no condition.
constexpr int longest_value = 10'000;
constexpr std::size_t longest_expression = 100'000;
constexpr double longest_time = 1;  // s

/// Functions whose answer depends on nothing but their arguments.
constexpr std::array deterministic = {
    "abs",     "acos",      "acosh",   "asin",   "asinh",   "atan",   "atan2",  "atanh",    "ceil",
    "ceiling", "coalesce",  "cos",     "cosh",   "degrees", "exp",    "floor",  "format",   "glob",
    "ifnull",  "iif",       "instr",   "length", "like",    "likely", "ln",     "log",      "log10",
    "log2",    "lower",     "ltrim",   "max",    "min",     "mod",    "nullif", "pi",       "pow",
    "power",   "radians",   "replace", "round",  "rtrim",   "sign",   "sin",    "sinh",     "sqrt",
    "substr",  "substring", "tan",     "tanh",   "trim",    "trunc",  "typeof", "unlikely", "upper",
};

/// What is compiled: where it stands in the campaign file, its text, and what it may not be asked for.
struct Written {
    std::string_view path, text, about;  ///< about: "a condition is asked of one case"
};

Written condition_of(std::string_view text, std::string_view path) {
    return {path, text, "a condition is asked of one case"};
}

campaign::InputError refusal(const Written& written, std::string_view why, std::string_view suggestion = {}) {
    return campaign::input_error(written.path, written.text, why, suggestion);
}

/// SQLite's words, and the nearest name where it did not know one.
campaign::InputError refusal_by_sqlite(const Written& written, std::string_view words,
                                       std::span<const std::string> names) {
    constexpr std::string_view unknown_column = "no such column: ";
    constexpr std::string_view unknown_function = "no such function: ";
    if (words.starts_with(unknown_column)) {
        return refusal(written, words, campaign::nearest_word(words.substr(unknown_column.size()), names));
    }
    if (words.starts_with(unknown_function)) {
        const std::vector<std::string> functions(deterministic.begin(), deterministic.end());
        return refusal(written, words, campaign::nearest_word(words.substr(unknown_function.size()), functions));
    }
    return refusal(written, words);
}

std::string columns_of(std::span<const std::string> names) {
    std::string text;
    for (const auto& name : names) text += (text.empty() ? "" : ", ") + quoted_name(name);
    return text;
}

/// Refuses a < b < c: SQL would compare the result of the first comparison, 0 or 1, with c.
void refuse_chains(const Written& written) {
    const auto chain = chained_comparison(written.text);
    if (!chain) return;
    const std::string instead = chain->meant.empty() ? "brackets" : fmt::format("'{}', or brackets", chain->meant);
    throw refusal(written, fmt::format("'{}' compares the outcome of a comparison; write {}", chain->text, instead));
}

/// Refuses what other languages write: && and ||, decimal commas, and numbers in quotes, which are texts: SQL puts
/// every number before every text, so that a comparison with one holds always or never.
void refuse_foreign_words(const Written& written) {
    const auto tokens = tokens_of(written.text);
    const auto orders = [&](std::size_t k) {
        if (k >= tokens.size()) return false;
        const Token& token = tokens[k];
        const bool equal = token.is("=") || token.is("==") || token.is("!=") || token.is("<>");
        return (compares(token) && !equal) || token.is_word("between");
    };
    for (std::size_t k = 0; k < tokens.size(); ++k) {
        const Token& token = tokens[k];
        const auto is_digits = [&](std::size_t at) {
            return at < tokens.size() && tokens[at].kind == Token::Kind::word &&
                   std::isdigit(static_cast<unsigned char>(tokens[at].text[0])) != 0;
        };
        if (token.is("&") && k + 1 < tokens.size() && tokens[k + 1].is("&") && tokens[k + 1].at == token.end())
            throw refusal(written, "'&&' is no word of SQL: write AND");
        if (token.is("||") && k > 0 && (is_digits(k - 1) || tokens[k - 1].is(")")))
            throw refusal(written, "'||' joins texts in SQL: write OR");
        if (token.is(",") && k > 0 && is_digits(k - 1) && is_digits(k + 1) && tokens[k - 1].end() == token.at &&
            tokens[k + 1].at == token.end() && k > 1 && compares(tokens[k - 2]))
            throw refusal(written,
                          fmt::format("'{},{}': numbers have a decimal point", tokens[k - 1].text, tokens[k + 1].text));
        const bool text = token.kind == Token::Kind::quoted && token.text.size() > 2 && token.text[0] == '\'';
        const bool upper_end =
            k > 2 && tokens[k - 1].is_word("and") && orders(k - 3) && tokens[k - 3].is_word("between");
        if (!text || (k > 0 && tokens[k - 1].is("||")) || !((k > 0 && orders(k - 1)) || orders(k + 1) || upper_end))
            continue;
        const std::string_view inside = token.text.substr(1, token.text.size() - 2);
        if (std::string_view("0123456789.+-").find(inside[0]) == std::string_view::npos) continue;
        throw refusal(written,
                      fmt::format("{} is a text, and no number lies above it: write numbers without quotes, in "
                                  "the unit of the parameter",
                                  token.text));
    }
}

/// Prepares the expression as the only output of one SELECT over one row of inputs, and reports which columns it
/// reads. The authorizer sees everything the expression would do.
std::set<std::string> check_names(Connection& db, const Written& written, std::span<const std::string> names) {
    refuse_foreign_words(written);
    refuse_chains(written);
    const std::string_view expression = written.text;
    db.execute("DROP TABLE IF EXISTS inputs");
    db.execute(fmt::format("CREATE TABLE inputs ({})", columns_of(names)));
    std::set<std::string> read;
    int selects = 0;
    std::string forbidden;
    db.authorize([&](SqlAction action, std::string_view first, std::string_view second) {
        switch (action) {
            case SqlAction::select:
                return ++selects == 1;
            case SqlAction::read:
                if (std::ranges::find(names, second) == names.end()) return second.empty();
                read.emplace(second);
                return true;
            case SqlAction::function:
                if (std::ranges::find(deterministic, first) != deterministic.end()) return true;
                forbidden = first;
                return false;
            default:
                return false;
        }
    });
    const auto finish = [&] { db.authorize({}); };
    try {
        if (unbalanced(expression)) throw RefusedSql("a bracket is not closed, or closed without being opened");
        // An expression with brackets of its own in order cannot close ours; the line break ends a comment.
        const std::string plain = fmt::format("SELECT ({}\n) FROM inputs", expression);
        const Statement select = db.prepare(plain);
        if (select.parameters() > 0) throw RefusedSql("names stand as they are, without ? or :");
        if (select.columns() != 1 || !select.tail().empty()) throw RefusedSql("one expression is expected");
    } catch (const RefusedSql& refused) {
        finish();
        if (!forbidden.empty()) {
            throw refusal(written, fmt::format("'{}' is not among the deterministic functions of SQLite", forbidden));
        }
        if (selects > 1) throw refusal(written, fmt::format("{}: no SELECT inside", written.about));
        if (std::string_view(refused.words()).find("row value misused") != std::string_view::npos)
            throw refusal(written, "one expression is expected");
        throw refusal_by_sqlite(written, refused.words(), names);
    }
    finish();
    return read;
}

/// "?1 AS "gap", ?2 AS "speed"": one row of inputs.
std::string row_of(std::span<const std::string> columns) {
    std::string row;
    for (std::size_t k = 0; k < columns.size(); ++k)
        row += fmt::format("{}?{} AS {}", k == 0 ? "" : ", ", k + 1, quoted_name(columns[k]));
    return row.empty() ? "NULL" : row;
}

void require_sane(const Written& written) {
    if (written.text.find('\0') != std::string_view::npos)
        throw refusal({written.path, "an expression with a NUL byte", written.about}, "text is expected");
    if (written.text.size() > longest_expression)
        throw refusal({written.path, fmt::format("an expression of {} characters", written.text.size()), written.about},
                      fmt::format("at most {} are read", longest_expression));
}

/// The compiled expression and the columns it reads, bound anew for every case.
class CompiledCondition {
public:
    CompiledCondition(std::string_view expression, std::span<const std::string> names, std::string_view path)
        : text_(expression), path_(path), db_(Connection::in_memory()) {
        db_.limit_lengths(longest_value);
        const auto read = check_names(db_, condition_of(expression, path), names);
        columns_.assign(read.begin(), read.end());
        const std::string sql = fmt::format("SELECT (({}\n)) IS TRUE FROM (SELECT {}) AS inputs",
                                            with_real_division(expression), row_of(columns_));
        try {
            statement_ = db_.prepare(sql);
        } catch (const RefusedSql& refused) {  // a collation is looked up where something compares by it
            throw refusal(condition_of(expression, path), refused.words());
        }
    }

    [[nodiscard]] bool holds(const Inputs& inputs) {
        int parameter = 0;
        for (const auto& name : columns_) {
            const auto found = inputs.find(name);
            if (found == inputs.end()) throw std::invalid_argument(fmt::format("a case without the input {}", name));
            statement_.bind(++parameter, found->second);
        }
        const Rows rows(statement_);
        db_.stop_after(longest_time);
        try {
            return statement_.step() && statement_.get<std::int64_t>(0) != 0;
        } catch (const RefusedSql& refused) {
            throw refusal(condition_of(text_, path_), refused.words());
        }
    }
    [[nodiscard]] const std::vector<std::string>& reads() const { return columns_; }

private:
    std::string text_, path_;
    Connection db_;
    std::vector<std::string> columns_;
    Statement statement_;
};

/// Several expressions as the columns of one row, over all names.
class NumberRow {
public:
    NumberRow(std::span<const std::string> expressions, std::span<const std::string> names, std::string_view path)
        : path_(path), count_(names.size()), db_(Connection::in_memory()) {
        db_.limit_lengths(longest_value);
        std::string columns;
        for (std::size_t k = 0; k < expressions.size(); ++k) {
            const std::string place = fmt::format("{}[{}]", path, k);
            const Written written{place, expressions[k], "a feature is a number of one case"};
            require_sane(written);
            if (check_names(db_, written, names).empty())
                throw refusal(written, "depends on no factor: it would be the same everywhere");
            columns += fmt::format("{0}iif(typeof(({1}\n)) IN ('integer', 'real'), ({1}\n), NULL)", k == 0 ? "" : ", ",
                                   with_real_division(expressions[k]));
        }
        db_.execute("DROP TABLE inputs");
        try {
            statement_ = db_.prepare(fmt::format("SELECT {} FROM (SELECT {}) AS inputs", columns, row_of(names)));
        } catch (const RefusedSql& refused) {  // a collation is looked up where something compares by it
            throw campaign::input_error(path_, "", refused.words());
        }
    }

    [[nodiscard]] std::vector<double> of(std::span<const Value> values) {
        if (values.size() != count_) throw std::invalid_argument("expressions: one value is needed for each name");
        int parameter = 0;
        for (const auto& value : values) statement_.bind(++parameter, value);
        const Rows rows(statement_);
        db_.stop_after(longest_time);
        std::vector<double> numbers(static_cast<std::size_t>(statement_.columns()), NAN);
        try {
            if (!statement_.step()) return numbers;
        } catch (const RefusedSql& refused) {
            throw campaign::input_error(path_, "", refused.words());
        }
        for (int k = 0; k < statement_.columns(); ++k)
            if (!statement_.is_null(k)) numbers[static_cast<std::size_t>(k)] = statement_.get<double>(k);
        return numbers;
    }

private:
    std::string path_;
    std::size_t count_;
    Connection db_;
    Statement statement_;
};

}  // namespace

Condition make_condition(std::string_view expression, std::span<const std::string> names, std::string_view path) {
    require_sane(condition_of(expression, path));
    if (names.empty())
        throw refusal(condition_of(expression, path), "the campaign has no factor and no fixed value it could use");
    auto condition = std::make_shared<CompiledCondition>(expression, names, path);
    auto reads = condition->reads();
    return {[condition = std::move(condition)](const Inputs& inputs) { return condition->holds(inputs); },
            std::move(reads)};
}

campaign::Filter make_filter(std::string_view expression, std::span<const std::string> names) {
    if (expression.find_first_not_of(" \t\r\n") == std::string_view::npos) {
        return [](const Inputs&) { return true; };
    }
    return make_condition(expression, names, "$.where").holds;
}

Numbers make_numbers(std::span<const std::string> expressions, std::span<const std::string> names,
                     std::string_view path) {
    auto row = std::make_shared<NumberRow>(expressions, names, path);
    return [row = std::move(row)](std::span<const Value> values) { return row->of(values); };
}

}  // namespace grainsweep::store
