#include "sweep/store/campaign_name.hpp"

#include "sweep/campaign/wrong_question.hpp"
#include "sweep/store/database.hpp"

#include <string>

namespace grainsweep::store {

namespace {

/// Whether SQLite takes the name for a table without quotes, as it does many of its words (first, plan, key).
bool names_a_table(std::string_view name) {
    try {
        (void)Connection::in_memory().prepare("SELECT * FROM " + std::string(name));
    } catch (const RefusedSql& refused) {
        return refused.words().starts_with("no such table");
    }
    return true;
}

}  // namespace

void check_campaign_name(std::string_view name) {
    if (!is_sql_word(name) || names_a_table(name)) return;
    throw campaign::wrong_question("$.campaign", name, "is a word of SQL, and the campaign's view bears its name",
                                   std::string(name) + "_1");
}

}  // namespace grainsweep::store
