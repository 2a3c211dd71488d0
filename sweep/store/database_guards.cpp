// Limits and extensions of the statements of a connection: an authorizer, limits of time, memory and length,
// aggregates.
#include "sweep/store/database.hpp"
#include "sweep/store/database_errors.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <ctime>
#include <new>
#include <stdexcept>
#include <utility>

namespace grainsweep::store {

namespace {

int call_authorizer(void* user, int action, const char* first, const char* second, const char*, const char*) {
    const auto& authorizer = *static_cast<const Authorizer*>(user);
    const auto text = [](const char* words) { return words == nullptr ? std::string_view{} : std::string_view(words); };
    const auto ask = [&](SqlAction kind, const char* a, const char* b) {
        return authorizer(kind, text(a), text(b)) ? SQLITE_OK : SQLITE_DENY;
    };
    switch (action) {
        case SQLITE_SELECT:
            return ask(SqlAction::select, nullptr, nullptr);
        case SQLITE_RECURSIVE:
            return ask(SqlAction::recursive, nullptr, nullptr);
        case SQLITE_READ:
            return ask(SqlAction::read, first, second);
        case SQLITE_FUNCTION:
            return ask(SqlAction::function, second, nullptr);
        case SQLITE_PRAGMA:
            return ask(SqlAction::pragma, first, second);
        case SQLITE_ATTACH:
        case SQLITE_DETACH:
        case SQLITE_TRANSACTION:
        case SQLITE_SAVEPOINT:
            return ask(SqlAction::control, first, second);
        default:
            return ask(SqlAction::other, first, second);
    }
}

using Statistic = std::optional<double> (*)(std::span<double>);

struct Group {
    std::vector<double>* numbers = nullptr;  // made at the first row
};

void add_to_group(sqlite3_context* context, int count, sqlite3_value** arguments) {
    auto* group = static_cast<Group*>(sqlite3_aggregate_context(context, sizeof(Group)));
    if (group == nullptr) return sqlite3_result_error_nomem(context);
    const std::span row(arguments, static_cast<std::size_t>(count));
    for (auto* value : row) {
        const int type = sqlite3_value_type(value);
        if (type == SQLITE_NULL) return;
        if (type != SQLITE_INTEGER && type != SQLITE_FLOAT)
            return sqlite3_result_error(context, "a statistic is asked of numbers, this is a word", -1);
    }
    try {
        if (group->numbers == nullptr) group->numbers = new std::vector<double>();
        for (auto* value : row) group->numbers->push_back(sqlite3_value_double(value));
    } catch (const std::bad_alloc&) {
        sqlite3_result_error_nomem(context);
    }
}

void finish_group(sqlite3_context* context) {
    auto* group = static_cast<Group*>(sqlite3_aggregate_context(context, 0));
    if (group == nullptr || group->numbers == nullptr) return sqlite3_result_null(context);
    const std::unique_ptr<std::vector<double>> numbers(std::exchange(group->numbers, nullptr));
    const auto statistic = reinterpret_cast<Statistic>(sqlite3_user_data(context));
    try {
        const auto answer = numbers->empty() ? std::nullopt : statistic(*numbers);
        answer ? sqlite3_result_double(context, *answer) : sqlite3_result_null(context);
    } catch (const std::bad_alloc&) {
        sqlite3_result_error_nomem(context);
    } catch (const std::invalid_argument& refused) {
        sqlite3_result_error(context, refused.what(), -1);
    }
}

}  // namespace

void Connection::authorize(Authorizer authorizer) const {
    authorizer_ = authorizer ? std::make_unique<Authorizer>(std::move(authorizer)) : nullptr;
    sqlite3_set_authorizer(handle_.get(), authorizer_ ? call_authorizer : nullptr, authorizer_.get());
}

void limit_memory(std::int64_t bytes) {
    sqlite3_hard_heap_limit64(bytes);
}

void Connection::limit_lengths(int value) const {
    sqlite3_limit(handle_.get(), SQLITE_LIMIT_LENGTH, value);
    sqlite3_limit(handle_.get(), SQLITE_LIMIT_LIKE_PATTERN_LENGTH, 1000);
}

/// Called every so many of SQLite's own instructions: a statement that is over before costs no look at a clock.
int Connection::look_at_time(void* allowances) {
    auto& allowed = *static_cast<Allowances*>(allowances);
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    const double seconds = static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
    return allowed.one.over(seconds) || allowed.all.over(seconds) || (allowed.ended && allowed.ended()) ? 1 : 0;
}

Connection::Allowances& Connection::allowances() const {
    constexpr int instructions = 1000;
    if (!allowances_) {
        allowances_ = std::make_unique<Allowances>();
        sqlite3_progress_handler(handle_.get(), instructions, look_at_time, allowances_.get());
    }
    return *allowances_;
}

void Connection::stop_after(double seconds) const {
    if (allowances_ || seconds > 0) allowances().one = {seconds, -1};
}

void Connection::limit_all(double seconds, std::function<bool()> ended) const {
    allowances() = {allowances().one, {seconds, -1}, std::move(ended)};
}

void Connection::add_aggregate(const char* name, int arguments, Statistic statistic) {
    check(handle_.get(), sqlite3_create_function_v2(
                             handle_.get(), name, arguments, SQLITE_UTF8 | SQLITE_DETERMINISTIC | SQLITE_INNOCUOUS,
                             reinterpret_cast<void*>(statistic), nullptr, add_to_group, finish_group, nullptr));
}

std::vector<std::string> Connection::functions() const {
    std::vector<std::string> names;
    auto rows = prepare("PRAGMA function_list");  // a row for each number of arguments
    while (rows.step()) names.push_back(rows.get<std::string>(0));
    std::ranges::sort(names);
    const auto again = std::ranges::unique(names);
    names.erase(again.begin(), again.end());
    return names;
}

}  // namespace grainsweep::store
