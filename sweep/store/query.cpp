// SQL from outside: one statement that only reads.
#include "sweep/campaign/wrong_question.hpp"
#include "sweep/store/archive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace grainsweep::store {

namespace {

/// What a question may do. ATTACH, BEGIN and most pragmas are read-only to SQLite, but no questions. Statements that
/// write are told by sqlite3_stmt_readonly: table-valued functions (json_each) declare a table on the way.
bool may(SqlAction action, std::string_view name) {
    constexpr std::array pragmas = {"table_info", "table_xinfo", "table_list",
                                    "index_list", "index_info",  "foreign_key_list"};
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

Table rows_of(const Connection& db, std::string_view sql) {
    Statement statement = db.prepare(sql);
    if (!statement.valid()) throw RefusedSql("the question is empty");
    for (auto rest = statement.tail(); !rest.empty();) {
        const Statement next = db.prepare(rest);
        if (next.valid()) throw RefusedSql("one statement at a time");
        rest = next.tail().size() < rest.size() ? next.tail() : std::string_view{};
    }
    if (!statement.read_only() || statement.columns() == 0) throw RefusedSql("the archive is only read here");
    if (statement.parameters() > 0) throw RefusedSql("values are written out, not left open with ? or :name");

    Table table;
    for (int column = 0; column < statement.columns(); ++column) table.columns.push_back(statement.column_name(column));
    while (statement.step()) {
        auto& row = table.rows.emplace_back();
        row.reserve(table.columns.size());
        for (int column = 0; column < statement.columns(); ++column) row.push_back(statement.cell(column));
    }
    return table;
}

}  // namespace

Table Store::query(std::string_view sql) const {
    const Authorized authorized(impl_->db);
    try {
        return rows_of(impl_->db, sql);
    } catch (const RefusedSql& refused) {
        throw campaign::wrong_question("SQL", {}, refused.words());
    }
}

}  // namespace grainsweep::store
