// Whether a campaign's name can be written in SQL as it is: SELECT * FROM NAME.
#pragma once

#include <string_view>

namespace grainsweep::store {

/// Throws WrongQuestion (at $.campaign) for a word of SQL, in upper or lower case, that cannot name a table without
/// quotes (SELECT, ORDER, TABLE, ...). Words that can (FIRST, PLAN, KEY) are accepted.
void check_campaign_name(std::string_view name);

}  // namespace grainsweep::store
