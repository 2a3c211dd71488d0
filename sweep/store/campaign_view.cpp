// The view that bears a campaign's name: one row per case, a column per factor and per scalar observable.
#include "sweep/campaign/wrong_question.hpp"
#include "sweep/store/archive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>

namespace grainsweep::store {

namespace {

std::string lower(std::string_view text) {
    std::string folded(text);
    std::ranges::transform(folded, folded.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return folded;
}

/// A value as SQL writes it, of its own type.
std::string literal(const Value& value) {
    if (const auto* word = std::get_if<std::string>(&value)) return quoted_text(*word);
    std::string text = campaign::to_text(value);
    if (std::holds_alternative<double>(value) && text.find_first_of(".en") == std::string::npos) text += ".0";
    return text;
}

/// Column names of one view: SQL does not distinguish upper from lower case, and a name already taken gets a suffix.
class Columns {
public:
    void add(const std::string& name, std::string_view suffix, const std::string& expression) {
        std::string free = name;
        while (!taken_.insert(lower(free)).second) free += suffix;
        text_ += fmt::format("{}{} AS {}", text_.empty() ? "" : ",\n       ", expression, quoted_name(free));
    }
    [[nodiscard]] const std::string& text() const { return text_; }

private:
    std::set<std::string> taken_;
    std::string text_;
};

std::int64_t key_of(const Connection& db, std::string_view sql, const campaign::Campaign& campaign,
                    const std::string& name) {
    auto rows = db.ask(sql, campaign.scene().name, campaign.scene().revision, name);
    return rows.next() ? rows.get<std::int64_t>(0) : 0;
}

std::string view_text(const Connection& db, const campaign::Campaign& campaign, std::int64_t campaign_key) {
    Columns columns;
    for (const char* name : {"point", "sequence", "replicate"}) columns.add(name, "_", fmt::format("p.{}", name));
    for (const char* name : {"case_id", "seed", "outcome", "attempts", "wall_seconds"}) {
        columns.add(name, "_", fmt::format("c.{}", name));
    }
    for (const auto& factor : campaign.space.factors) {
        const auto* spec = campaign.scene().find_parameter(factor.name);
        if (spec == nullptr) throw std::logic_error(fmt::format("factor {} is no parameter of the scene", factor.name));
        const auto key = key_of(db, "SELECT parameter_id FROM parameter WHERE scene = ? AND revision = ? AND name = ?",
                                campaign, factor.name);
        columns.add(factor.name, "_input",
                    fmt::format("coalesce((SELECT i.value FROM case_input AS i WHERE i.case_key = p.case_key AND "
                                "i.parameter_id = {}), {})",
                                key, literal(spec->default_value)));
    }
    for (const auto& observable : campaign.scene().observables) {
        if (observable.shape != Shape::scalar) continue;
        const auto key =
            key_of(db, "SELECT observable_id FROM observable WHERE scene = ? AND revision = ? AND name = ?", campaign,
                   observable.name);
        columns.add(observable.name, "_observed",
                    fmt::format("(SELECT o.value FROM observation AS o WHERE o.case_key = p.case_key AND "
                                "o.observable_id = {} AND o.sample = 0)",
                                key));
    }
    return fmt::format(
        "CREATE VIEW {} AS\nSELECT {}\nFROM campaign_case AS p\nJOIN sim_case AS c ON c.case_key = p.case_key\n"
        "WHERE p.campaign_id = {}",
        quoted_name(campaign.name), columns.text(), campaign_key);
}

}  // namespace

void make_campaign_view(Store::Impl& archive, const campaign::Campaign& campaign, std::int64_t campaign_key) {
    auto& db = archive.db;
    const std::string text = view_text(db, campaign, campaign_key);
    std::optional<std::string> present;
    {
        auto rows = db.ask("SELECT sql FROM sqlite_schema WHERE name = ?", campaign.name);
        if (rows.next()) present = rows.get<std::string>(0);
    }
    if (present == text) return;
    if (present) db.execute(fmt::format("DROP VIEW {}", quoted_name(campaign.name)));
    db.execute(text);
}

}  // namespace grainsweep::store
