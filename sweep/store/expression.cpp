#include "sweep/store/expression.hpp"

#include "sweep/campaign/wrong_question.hpp"
#include "sweep/store/database.hpp"
#include "sweep/store/expression_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <stdexcept>
#include <utility>

namespace grainsweep::store {

namespace {

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

campaign::WrongQuestion refusal(const Written& written, std::string_view why, std::string_view suggestion = {}) {
    return campaign::wrong_question(written.path, written.text, why, suggestion);
}

/// SQLite's words, and the nearest name where it did not know one.
campaign::WrongQuestion refusal_by_sqlite(const Written& written, std::string_view words,
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

/// Prepares the expression as the only output of one SELECT over one row of inputs, and reports which columns it
/// reads. The authorizer sees everything the expression would do.
std::set<std::string> check_names(Connection& db, const Written& written, std::span<const std::string> names) {
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
            throw campaign::wrong_question(path_, "", refused.words());
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
            throw campaign::wrong_question(path_, "", refused.words());
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
