// Check that a campaign's name can be used in SQL without quotes: SELECT * FROM NAME.
#pragma once

#include <string_view>

namespace grainsweep::store {

/// Throws WrongQuestion (at $.campaign) for a name that SQLite uses itself (json_each, pragma_table_info,
/// sqlite_schema), for a name in the database schema, and for a word of SQL that cannot name a table without quotes
/// (SELECT, ORDER), in upper or lower case. Other words of SQL (FIRST, PLAN, KEY) are accepted. SQLite itself decides
/// this, not a list.
void check_campaign_name(std::string_view name);

}  // namespace grainsweep::store
