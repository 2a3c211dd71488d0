// The view that bears a campaign's name: one row per case, a column per factor and per scalar observable.
#include "sweep/campaign/plain_name.hpp"
#include "sweep/store/archive.hpp"
#include "sweep/store/schema.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace grainsweep::store {

namespace {

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
        while (!taken_.insert(campaign::small_letters(free)).second) free += suffix;
        text_ += fmt::format("{}{} AS {}", text_.empty() ? "" : ",\n       ", expression, quoted_name(free));
    }
    [[nodiscard]] const std::string& text() const { return text_; }

private:
    std::set<std::string> taken_;
    std::string text_;
};

/// Contents of a campaign's view.
struct Shown {
    std::string name, scene;
    std::int64_t key = 0, revision = 0;
    std::vector<std::string> factors, scalars;
};

std::string select_text(const Connection& db, const Shown& shown) {
    Columns columns;
    for (const char* name : {"point", "sequence", "replicate"}) columns.add(name, "_", fmt::format("p.{}", name));
    for (const char* name : {"case_id", "seed", "outcome", "attempts", "wall_seconds"}) {
        columns.add(name, "_", fmt::format("c.{}", name));
    }
    for (const auto& factor : shown.factors) {
        auto rows =
            db.ask("SELECT parameter_id, default_value FROM parameter WHERE scene = ? AND revision = ? AND name = ?",
                   shown.scene, shown.revision, factor);
        if (!rows.next())
            throw SystemError(
                fmt::format("campaign '{}': its factor {} is no parameter of the scene", shown.name, factor));
        columns.add(factor, "_input",
                    fmt::format("coalesce((SELECT i.value FROM case_input AS i WHERE i.case_key = p.case_key AND "
                                "i.parameter_id = {}), {})",
                                rows.get<std::int64_t>(0), literal(rows.value(1))));
    }
    for (const auto& scalar : shown.scalars) {
        const auto key =
            db.value<std::int64_t>("SELECT observable_id FROM observable WHERE scene = ? AND revision = ? AND name = ?",
                                   shown.scene, shown.revision, scalar);
        columns.add(scalar, "_observed",
                    fmt::format("(SELECT o.value FROM observation AS o WHERE o.case_key = p.case_key AND "
                                "o.observable_id = {} AND o.sample = 0)",
                                key.value_or(0)));
    }
    return fmt::format(
        "SELECT {}\nFROM campaign_case AS p\nJOIN sim_case AS c ON c.case_key = p.case_key\nWHERE p.campaign_id = {}",
        columns.text(), shown.key);
}

std::string view_text(const Connection& db, const Shown& shown) {
    return fmt::format("CREATE VIEW {} AS\n{}", quoted_name(shown.name), select_text(db, shown));
}

void make_view(Connection& db, const Shown& shown) {
    const std::string text = view_text(db, shown);
    const auto present = db.value<std::string>("SELECT sql FROM sqlite_schema WHERE name = ?", shown.name);
    if (present == text) return;
    if (present) db.execute(fmt::format("DROP VIEW {}", quoted_name(shown.name)));
    db.execute(text);
}

/// Every campaign, as the archive describes it.
std::vector<Shown> stored_campaigns(const Connection& db) {
    std::vector<Shown> all;
    auto rows = db.ask(fmt::format("SELECT campaign_id, {} FROM campaign NOT INDEXED", identity_columns(db)));
    while (rows.next()) {
        const auto identity = identity_at(rows, 1);
        Shown shown{identity.name, identity.scene, rows.get<std::int64_t>(0), identity.revision, {}, {}};
        for (const auto& factor : identity.factors) shown.factors.push_back(factor.name);
        auto scalars = db.ask(
            "SELECT name FROM observable NOT INDEXED WHERE scene = ? AND revision = ? AND shape = 'scalar' ORDER BY "
            "observable_id",
            shown.scene, shown.revision);
        while (scalars.next()) shown.scalars.push_back(scalars.get<std::string>(0));
        all.push_back(std::move(shown));
    }
    return all;
}

}  // namespace

std::string Store::rows_of(std::string_view campaign) const {
    const auto all = stored_campaigns(impl_->db);
    const auto found = std::ranges::find(all, campaign, &Shown::name);
    if (found == all.end()) (void)impl_->campaign_key(campaign);  // refuses the name
    return select_text(impl_->db, *found);
}

void make_views(Store::Impl& archive, const campaign::Campaign& campaign, std::int64_t campaign_key) {
    auto& db = archive.db;
    if (!damaged_views(db).empty()) {
        archive.notes.push_back("views of the database were dropped or altered and are made anew");
        db.execute(schema_views());
        for (const auto& other : stored_campaigns(db))
            if (other.key != campaign_key) make_view(db, other);
    }
    const auto& scene = campaign.scene();
    Shown shown{campaign.name, scene.name, campaign_key, scene.revision, {}, {}};
    for (const auto& factor : campaign.space.factors) shown.factors.push_back(factor.name);
    for (const auto& observable : scene.observables)
        if (observable.shape == Shape::scalar) shown.scalars.push_back(observable.name);
    make_view(db, shown);
}

}  // namespace grainsweep::store
