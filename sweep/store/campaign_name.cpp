#include "sweep/store/campaign_name.hpp"

#include "sweep/campaign/wrong_question.hpp"
#include "sweep/store/database.hpp"

#include <string>

namespace grainsweep::store {

void check_campaign_name(std::string_view name) {
    if (!is_sql_word(name)) return;
    throw campaign::wrong_question("$.campaign", name, "is a word of SQL, and the campaign's view bears its name",
                                   std::string(name) + "_1");
}

}  // namespace grainsweep::store
