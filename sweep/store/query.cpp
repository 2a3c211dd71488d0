// SQL from outside: one statement that only reads.
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/plain_name.hpp"
#include "sweep/store/archive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace grainsweep::store {

namespace {

/// Returns whether a query may do this. ATTACH, BEGIN and most pragmas are read-only to SQLite, but are no queries.
/// Statements that write are found by sqlite3_stmt_readonly: table-valued functions (json_each) declare a table on the
/// way.
bool may(SqlAction action, std::string_view name) {
    constexpr std::array pragmas = {"table_info", "table_xinfo",      "table_list",   "index_list",
                                    "index_info", "foreign_key_list", "function_list"};
    switch (action) {
        case SqlAction::select:
        case SqlAction::recursive:
        case SqlAction::read:
            return true;
        case SqlAction::function:
            return name != "load_extension" && name != "fts3_tokenizer";
        case SqlAction::pragma:
            return std::ranges::find(pragmas, name) != pragmas.end();
        case SqlAction::control:
            return false;
        case SqlAction::other:
            return true;
    }
    return false;
}

class Authorized {
public:
    explicit Authorized(const Connection& db) : db_(&db) {
        db.authorize([](SqlAction action, std::string_view name, std::string_view) { return may(action, name); });
    }
    Authorized(const Authorized&) = delete;
    Authorized& operator=(const Authorized&) = delete;
    ~Authorized() { db_->authorize({}); }

private:
    const Connection* db_;
};

using ColumnSink = std::function<void(const std::vector<std::string>& columns)>;
using RowSink = std::function<void(const std::vector<Table::Cell>& row)>;

void visit_rows(const Connection& db, std::string_view sql, const ColumnSink& begin, const RowSink& each) {
    Statement statement = db.prepare(sql);
    if (!statement.valid()) throw RefusedSql("the question is empty");
    for (auto rest = statement.tail(); !rest.empty();) {
        const Statement next = db.prepare(rest);
        if (next.valid()) throw RefusedSql("one statement at a time");
        rest = next.tail().size() < rest.size() ? next.tail() : std::string_view{};
    }
    if (!statement.read_only() || statement.columns() == 0) throw RefusedSql("the archive is only read here");
    if (statement.parameters() > 0) throw RefusedSql("values are written out, not left open with ? or :name");

    std::vector<std::string> columns;
    for (int column = 0; column < statement.columns(); ++column) columns.push_back(statement.column_name(column));
    begin(columns);
    std::vector<Table::Cell> row(columns.size());
    while (statement.step()) {
        for (int column = 0; column < statement.columns(); ++column)
            row[static_cast<std::size_t>(column)] = statement.cell(column);
        each(row);
    }
}

/// Limits of this process and connection, gone with it.
class Limited {
public:
    Limited(const Connection& db, const Store::QueryLimits& limits) : db_(&db), memory_(limits.bytes > 0) {
        db.stop_after(limits.seconds);
        if (memory_) limit_memory(limits.bytes);
    }
    Limited(const Limited&) = delete;
    Limited& operator=(const Limited&) = delete;
    ~Limited() {
        db_->stop_after(0);
        if (memory_) limit_memory(0);
    }

private:
    const Connection* db_;
    bool memory_;
};

std::vector<std::string> names_from(const Connection& db, std::string_view sql) {
    std::vector<std::string> names;
    auto statement = db.prepare(sql);
    while (statement.step()) names.push_back(statement.get<std::string>(0));
    return names;
}

/// Campaigns first, then the fixed views, then tables.
std::vector<std::string> tables_of(const Connection& db) {
    return names_from(db,
                      "SELECT name FROM sqlite_schema WHERE type IN ('view', 'table') AND name NOT LIKE 'sqlite_%' "
                      "ORDER BY name NOT IN (SELECT name FROM campaign), type = 'table', name");
}

/// By the statement: a view may stand in the place of the function pragma_table_info(). Of a view that cannot be read,
/// none.
std::vector<std::string> table_columns(const Connection& db, const std::string& table) {
    std::vector<std::string> names;
    try {
        auto columns = db.prepare(fmt::format("PRAGMA table_info({})", quoted_name(table)));
        while (columns.step()) names.push_back(columns.get<std::string>(1));
    } catch (const RefusedSql&) {
    }
    return names;
}

/// Whether the text names the word, as a word of its own.
bool mentions(std::string_view sql, std::string_view word) {
    const auto same = [](char a, char b) { return campaign::small_letter(a) == campaign::small_letter(b); };
    auto at = sql.begin();
    while ((at = std::search(at, sql.end(), word.begin(), word.end(), same)) != sql.end()) {
        const auto end = at + static_cast<std::ptrdiff_t>(word.size());
        if ((at == sql.begin() || !campaign::is_name_sign(*(at - 1))) &&
            (end == sql.end() || !campaign::is_name_sign(*end)))
            return true;
        ++at;
    }
    return false;
}

/// What SQLite did not know, with the names there are and the nearest of them.
campaign::InputError refusal_of_column(const Connection& db, std::string_view sql, std::string_view column) {
    std::string_view plain = column;
    if (const auto dot = plain.rfind('.'); dot != std::string_view::npos) plain.remove_prefix(dot + 1);
    std::vector<std::string> near, elsewhere;
    std::string rule = fmt::format("no such column: {}", column);
    for (const auto& table : tables_of(db)) {
        const auto columns = table_columns(db, table);
        if (mentions(sql, table)) {
            rule += fmt::format("; {} has {}", table, campaign::listed(columns));
            near.insert(near.end(), columns.begin(), columns.end());
        } else if (std::ranges::find(columns, plain) != columns.end()) {
            elsewhere.push_back(table);
        }
    }
    if (!elsewhere.empty()) rule += fmt::format("; '{}' is a column of {}", plain, campaign::listed(elsewhere));
    const std::string quoted = fmt::format("\"{}\"", plain);
    if (sql.find(quoted) != std::string_view::npos)
        return campaign::input_error("SQL", {}, rule + "; a text stands in single quotes", std::string(plain));
    return campaign::input_error("SQL", {}, rule, campaign::nearest_word(plain, near));
}

campaign::InputError refused_query(const Connection& db, std::string_view sql, std::string_view words) {
    const auto after = [&](std::string_view start) {
        return words.starts_with(start) ? words.substr(start.size()) : std::string_view{};
    };
    if (const auto column = after("no such column: "); !column.empty()) {
        return refusal_of_column(db, sql, column.substr(0, column.find(" - ")));  // newer SQLite adds advice
    }
    if (const auto table = after("no such table: "); !table.empty()) {
        const auto tables = tables_of(db);
        return campaign::input_error("SQL", {}, fmt::format("{}; there are {}", words, campaign::listed(tables)),
                                     campaign::nearest_word(table, tables));
    }
    if (const auto function = after("no such function: "); !function.empty())
        return campaign::input_error("SQL", {}, words, campaign::nearest_word(function, db.functions()));
    return campaign::input_error("SQL", {}, words);
}

}  // namespace

void Store::limit(double seconds, std::function<bool()> ended) const {
    impl_->db.limit_all(seconds, std::move(ended));
}

Table Store::query(std::string_view sql) const {
    Table table;
    query(
        sql, {}, [&](const auto& columns) { table.columns = columns; },
        [&](const auto& row) { table.rows.push_back(row); });
    return table;
}

void Store::query(std::string_view sql, const QueryLimits& limits, const ColumnSink& begin, const RowSink& each) const {
    const Authorized authorized(impl_->db);
    try {
        const Limited limited(impl_->db, limits);
        visit_rows(impl_->db, sql, begin, each);
    } catch (const StatementLimit& limit) {
        throw campaign::input_error("SQL", {},
                                    fmt::format("{} (limits: {} s of processor time, {} MiB)", limit.words(),
                                                campaign::shortest(limits.seconds), limits.bytes >> 20U));
    } catch (const RefusedSql& refused) {
        throw refused_query(impl_->db, sql, refused.words());
    }
}

}  // namespace grainsweep::store
