// Whether a campaign's name can be written in SQL as it is: SELECT * FROM NAME.
#pragma once

#include <string_view>

namespace grainsweep::store {

/// Throws WrongQuestion (at $.campaign), in upper or lower case, for a name that SQLite resolves by itself (json_each,
/// pragma_table_info, sqlite_schema) and for a name of the archive's own. Also for a word of SQL that cannot name a
/// table without quotes (SELECT, ORDER). Words that can (FIRST, PLAN, KEY) are accepted. SQLite decides, not a list.
void check_campaign_name(std::string_view name);

}  // namespace grainsweep::store
