// Whether a campaign's name can be written in SQL as it is: SELECT * FROM NAME.
#pragma once

#include <string_view>

namespace grainsweep::store {

/// Throws WrongQuestion (at $.campaign) for a word of SQL (SELECT, ORDER, PLAN, ...), in upper or lower case: a view of
/// that name could be asked only in quotes.
void check_campaign_name(std::string_view name);

}  // namespace grainsweep::store
