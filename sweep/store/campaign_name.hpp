// Check that a campaign's name can be used in SQL without quotes: SELECT * FROM NAME.
#pragma once

#include <string_view>

namespace grainsweep::store {

/// Throws InputError (at $.campaign), in upper or lower case, for a name that SQLite uses itself (json_each,
/// pragma_table_info, sqlite_schema), and for a name in the database schema. Also for a word of SQL that cannot name a
/// table without quotes (SELECT, ORDER). Other words of SQL (FIRST, PLAN, KEY) are accepted. SQLite itself decides
/// this, not a list.
void check_campaign_name(std::string_view name);

}  // namespace grainsweep::store
