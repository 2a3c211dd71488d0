// Whether a campaign's name can be written in SQL as it is: SELECT * FROM NAME.
#pragma once

#include <string_view>

namespace grainsweep::store {

/// Throws WrongQuestion (at $.campaign) for a name that SQLite resolves by itself (json_each, pragma_table_info,
/// sqlite_schema), that is one of the archive's own, or a word of SQL that cannot name a table without quotes (SELECT,
/// ORDER), in upper or lower case. Words that can (FIRST, PLAN, KEY) are accepted. SQLite decides, not a list.
void check_campaign_name(std::string_view name);

}  // namespace grainsweep::store
