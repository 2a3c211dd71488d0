#include "sweep/store/campaign_name.hpp"

#include "sweep/campaign/input_error.hpp"
#include "sweep/store/database.hpp"
#include "sweep/store/schema.hpp"

#include <optional>
#include <string>

namespace grainsweep::store {

namespace {

/// Whether SQLite takes the text for a table that is not there.
bool names_no_table(std::string_view name) {
    try {
        (void)Connection::in_memory().prepare("SELECT 1 FROM " + std::string(name));
    } catch (const RefusedSql& refused) {
        return refused.words().starts_with("no such table: ");
    }
    return false;
}

/// Why the database of a campaign cannot have a view of that name.
std::optional<std::string> why_no_view(std::string_view name) {
    // Tables of SQLite's own, which need not be made: a view of the name would hide them from this program, too.
    if (!names_no_table(quoted_name(name))) return "is a table of SQLite's own, and the campaign's view bears its name";
    // Many words of SQL (first, plan, key) stand for a table without quotes all the same.
    if (is_sql_word(name) && !names_no_table(name)) return "is a word of SQL, and the campaign's view bears its name";
    auto scratch = Connection::in_memory();
    for (const auto migration : schema_migrations()) scratch.execute(migration);
    scratch.execute(schema_views());
    try {
        scratch.execute("CREATE VIEW " + quoted_name(name) + " AS SELECT 1");
    } catch (const RefusedSql& refused) {
        return "the campaign's view cannot bear this name: " + refused.words();
    }
    return std::nullopt;
}

}  // namespace

void check_campaign_name(std::string_view name) {
    if (const auto why = why_no_view(name))
        throw campaign::input_error("$.campaign", name, *why, std::string(name) + "_1");
}

}  // namespace grainsweep::store
