// Thin layer on SQLite: connection, prepared statement with typed columns, transaction.
//
//     auto row = db.ask("SELECT name FROM campaign WHERE seed > ?", 7);
//     while (row.next()) use(row.get<std::string>(0));
//
// Statements are prepared once per text and kept. Errors of the disk or of other processes throw SystemError with a
// sentence. Errors in the text of a statement throw RefusedSql with SQLite's message.
#pragma once

#include "solver/scenes/values.hpp"
#include "sweep/files/locked_files.hpp"
#include "sweep/files/system_error.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <variant>
#include <vector>

struct sqlite3;
struct sqlite3_stmt;

namespace grainsweep::store {

/// Error: SQLite refuses the statement (syntax, unknown name, not authorised, a constraint). For the program's own
/// statements it means that the file has been changed. Callers that run a user's statement catch it.
class RefusedSql : public SystemError {
public:
    explicit RefusedSql(std::string words, const std::string& file = "the database")
        : SystemError(file + ": not as this program made it, damaged or altered (" + words + ")"),
          words_(std::move(words)) {}
    [[nodiscard]] const std::string& words() const { return words_; }  ///< message of SQLite

private:
    std::string words_;
};

/// Error: a limit of time or memory stopped a statement (Connection::stop_after, limit_memory).
class StatementLimit : public RefusedSql {
public:
    using RefusedSql::RefusedSql;
};

/// Limits the memory of SQLite in this process, bytes, for all connections; 0: no limit.
void limit_memory(std::int64_t bytes);

/// Value: NULL, integer, real, text.
using SqlValue = std::variant<std::monostate, std::int64_t, double, std::string>;

/// Bytes, not text.
struct Blob {
    std::string_view bytes;
};

/// Prepared statement. Parameters count from 1, columns from 0.
class Statement {
public:
    Statement() = default;
    Statement(sqlite3* database, std::string_view sql);

    void bind(int parameter, std::nullopt_t);
    void bind(int parameter, std::int64_t value);
    void bind(int parameter, int value) { bind(parameter, std::int64_t{value}); }
    void bind(int parameter, bool value) { bind(parameter, std::int64_t{value}); }
    void bind(int parameter, double value);            ///< NaN is NULL
    void bind(int parameter, std::string_view value);  ///< refers to the text until reset()
    void bind(int parameter, const char* value) { bind(parameter, std::string_view(value)); }
    void bind(int parameter, const std::string& value) { bind(parameter, std::string_view(value)); }
    void bind(int parameter, const Blob& value);  ///< refers to the bytes until reset()
    void bind(int parameter, const Value& value);
    template <class T>
    void bind(int parameter, const std::optional<T>& value) {
        value ? bind(parameter, *value) : bind(parameter, std::nullopt);
    }

    [[nodiscard]] bool step();  ///< returns whether there is a row
    void reset();
    [[nodiscard]] bool valid() const { return handle_ != nullptr; }
    [[nodiscard]] bool busy() const;  ///< returns whether it is between its first row and its reset
    [[nodiscard]] bool read_only() const;
    [[nodiscard]] int parameters() const;
    [[nodiscard]] int columns() const;
    [[nodiscard]] std::string column_name(int column) const;

    [[nodiscard]] bool is_null(int column) const;
    /// Returns a column as int64, double (NULL is NaN), string, string_view (valid until the next step) or an optional
    /// of these.
    template <class T>
    [[nodiscard]] T get(int column) const;
    [[nodiscard]] SqlValue cell(int column) const;
    [[nodiscard]] Value value(int column) const;  ///< value of a column that is never NULL
    [[nodiscard]] std::string blob(int column) const;
    /// Returns the text after the first statement (the text of the constructor must still exist).
    [[nodiscard]] std::string_view tail() const { return tail_; }

private:
    struct Finalize {
        void operator()(sqlite3_stmt* statement) const;
    };
    [[nodiscard]] std::int64_t integer(int column) const;
    [[nodiscard]] double real(int column) const;
    [[nodiscard]] std::string_view text(int column) const;

    std::unique_ptr<sqlite3_stmt, Finalize> handle_;
    std::string_view tail_;
};

/// Kept statement in use; it is reset when this object is destroyed.
class Rows {
public:
    explicit Rows(Statement& statement) : statement_(&statement) {}
    Rows(Rows&& other) noexcept : statement_(std::exchange(other.statement_, nullptr)) {}
    Rows& operator=(Rows&&) = delete;
    ~Rows() {
        if (statement_ != nullptr) statement_->reset();
    }
    [[nodiscard]] bool next() { return statement_->step(); }
    template <class T>
    [[nodiscard]] T get(int column) const {
        return statement_->get<T>(column);
    }
    [[nodiscard]] bool is_null(int column) const { return statement_->is_null(column); }
    [[nodiscard]] Value value(int column) const { return statement_->value(column); }
    [[nodiscard]] SqlValue cell(int column) const { return statement_->cell(column); }
    [[nodiscard]] std::string blob(int column) const { return statement_->blob(column); }

private:
    Statement* statement_;
};

/// Action of a statement, as reported by SQLite's authorizer. `control`: attach, detach, transactions, savepoints.
enum class SqlAction { select, recursive, read, function, pragma, control, other };
/// Function that returns whether an action is permitted. Arguments: for `read` table and column, for `function` its
/// name, for `pragma` name and argument.
using Authorizer = std::function<bool(SqlAction action, std::string_view first, std::string_view second)>;

class Connection {
public:
    enum class Access { write, read };
    enum class Journal { write_ahead, rollback };

    /// write: makes the file if absent, and runs no statement before use(). read: no statement changes the file. If the
    /// file is writable, opening and closing recover the journal of a dead writer. A file in a read-only folder is read
    /// without recovery.
    Connection(const std::filesystem::path& file, Access access);
    [[nodiscard]] static Connection in_memory();

    /// Returns SQLite's own descriptor of the file. SQLite closes it with the connection; callers must not.
    [[nodiscard]] int descriptor() const { return descriptor_; }

    /// Chooses the journal, and synchronous FULL. A write-ahead log lets readers and the writer work at the same time,
    /// but needs shared memory, which network file systems lack; these need the rollback journal. Both are synced at
    /// every commit.
    void use(Journal journal);

    /// Runs every statement of a script.
    void execute(std::string_view script);
    /// Runs one kept statement to its end. Returns the number of changed rows.
    template <class... Arguments>
    std::int64_t run(std::string_view sql, const Arguments&... arguments) {
        Statement& statement = kept(sql);
        const Rows guard(statement);
        int parameter = 0;
        (statement.bind(++parameter, arguments), ...);
        while (statement.step()) {
        }
        return changes();
    }
    /// Starts one kept statement. Text arguments must outlive the rows.
    template <class... Arguments>
    [[nodiscard]] Rows ask(std::string_view sql, const Arguments&... arguments) const {
        Statement& statement = kept(sql);
        int parameter = 0;
        (statement.bind(++parameter, arguments), ...);
        return Rows(statement);
    }
    /// Returns the first column of every row.
    template <class T, class... Arguments>
    [[nodiscard]] std::vector<T> column(std::string_view sql, const Arguments&... arguments) const {
        std::vector<T> values;
        for (auto rows = ask(sql, arguments...); rows.next();) values.push_back(rows.template get<T>(0));
        return values;
    }
    /// Returns the first column of the first row; empty if there is no row.
    template <class T, class... Arguments>
    [[nodiscard]] std::optional<T> value(std::string_view sql, const Arguments&... arguments) const {
        auto rows = ask(sql, arguments...);
        return rows.next() ? std::optional<T>(rows.template get<T>(0)) : std::nullopt;
    }
    /// Returns a new statement, which is not kept.
    [[nodiscard]] Statement prepare(std::string_view sql) const { return {handle_.get(), sql}; }

    [[nodiscard]] std::int64_t last_row() const;
    [[nodiscard]] std::int64_t changes() const;
    [[nodiscard]] bool in_transaction() const;
    /// Returns whether the opened file was moved, deleted or replaced.
    [[nodiscard]] bool has_moved() const;
    /// Returns the size of the file, without a write-ahead log. Uses SQLite's own descriptor (locked_files.hpp).
    [[nodiscard]] std::int64_t file_bytes() const;
    void read_file(std::int64_t offset, std::span<std::byte> into) const;

    /// Sets the authorizer of all statements prepared from now on; empty: all are permitted.
    void authorize(Authorizer authorizer) const;
    /// Limits the total processor time of the statements from now on; more throws StatementLimit; 0: no limit.
    void stop_after(double seconds) const;
    /// Limits the processor time of this thread in all statements from now on, s, beside stop_after(); `ended` is asked
    /// often and stops them too. More throws StatementLimit. Zero and empty: no limit.
    void limit_all(double seconds, std::function<bool()> ended) const;
    /// Limits the length of texts, bytes; statements that make longer texts are refused.
    void limit_lengths(int value) const;
    /// Adds an aggregate of the rows of a group, each with `arguments` numbers, row after row. Rows with a NULL are
    /// skipped; an empty result is NULL. If the statistic throws std::invalid_argument, the statement is refused.
    void add_aggregate(const char* name, int arguments, std::optional<double> (*statistic)(std::span<double> numbers));
    /// Returns the functions that statements may call.
    [[nodiscard]] std::vector<std::string> functions() const;

private:
    struct Close {
        void operator()(sqlite3* database) const;
    };
    explicit Connection(sqlite3* handle);
    /// Opens the file, and finds the descriptor.
    void open(const std::filesystem::path& file, const std::string& name, int flags);
    [[nodiscard]] Statement& kept(std::string_view sql) const;
    void configure();
    void probe() const;  ///< reads the first page, and recovers the log of a dead writer

    struct TextHash : std::hash<std::string_view> {
        using is_transparent = void;
    };
    files::LockedFile entry_;
    std::unique_ptr<sqlite3, Close> handle_;
    int descriptor_ = -1;
    mutable std::unordered_map<std::string, Statement, TextHash, std::equal_to<>> kept_;
    mutable std::unique_ptr<Authorizer> authorizer_;
    struct Allowance {
        double seconds = 0;
        double since = -1;  ///< processor time of the thread at the start; negative: not started
        /// Returns whether the time is over; 0 seconds: never.
        bool over(double now) {
            if (since < 0) since = now;
            return seconds > 0 && now - since > seconds;
        }
    };
    struct Allowances {
        Allowance one, all;
        std::function<bool()> ended;
    };
    mutable std::unique_ptr<Allowances> allowances_;
    /// Sets the handler if there is a limit.
    Allowances& allowances() const;
    static int look_at_time(void* allowances);
};

/// Transaction: BEGIN ... COMMIT; it rolls back unless committed. A transaction that only reads sees one state of the
/// file.
class Transaction {
public:
    enum class Kind { write, read };
    explicit Transaction(Connection& connection, Kind kind = Kind::write);
    Transaction(const Transaction&) = delete;
    Transaction& operator=(const Transaction&) = delete;
    ~Transaction();
    void commit();

private:
    Connection* connection_;
};

/// Returns the first bytes of a file, at most `most`, read by SQLite without a lock, a journal or a change. Throws
/// SystemError if it cannot be opened.
[[nodiscard]] std::string beginning_of(const std::filesystem::path& file, std::size_t most);

/// Returns whether a word, in any case, is a keyword of SQLite.
[[nodiscard]] bool is_sql_word(std::string_view word);
/// Return an identifier, or a text, quoted for SQL.
[[nodiscard]] std::string quoted_name(std::string_view name);
[[nodiscard]] std::string quoted_text(std::string_view text);

template <>
inline std::int64_t Statement::get<std::int64_t>(int column) const {
    return integer(column);
}
template <>
inline double Statement::get<double>(int column) const {
    return real(column);
}
template <>
inline std::string_view Statement::get<std::string_view>(int column) const {
    return text(column);
}
template <>
inline std::string Statement::get<std::string>(int column) const {
    return std::string(text(column));
}
template <>
inline std::optional<std::int64_t> Statement::get<std::optional<std::int64_t>>(int column) const {
    return is_null(column) ? std::nullopt : std::optional(integer(column));
}
template <>
inline std::optional<std::string> Statement::get<std::optional<std::string>>(int column) const {
    return is_null(column) ? std::nullopt : std::optional(std::string(text(column)));
}

}  // namespace grainsweep::store
