// Results that were computed elsewhere: where they come from, and the campaigns that hold them.
#include "sweep/store/archive.hpp"
#include "sweep/store/checksum.hpp"
#include "sweep/store/soundness.hpp"

#include <fmt/format.h>

namespace grainsweep::store {
namespace {

constexpr std::string_view table_of_imports = "attempt_import";

std::uint64_t sum_of_import(std::int64_t key, std::int64_t number, std::string_view name, std::string_view hash,
                            std::int64_t line) {
    return Digest().add(key).add(number).add(name).add(hash).add(line).value();
}

}  // namespace

void store_import(Connection& db, std::int64_t key, std::int64_t number, const campaign::ImportedLine& line) {
    db.run("INSERT INTO attempt_import (case_key, number, name, hash, line, checksum) VALUES (?, ?, ?, ?, ?, ?)", key,
           number, line.file, line.hash, line.line,
           as_sql(sum_of_import(key, number, line.file, line.hash, line.line)));
}

std::map<std::int64_t, campaign::ImportedLine> imported_lines(const Connection& db, std::int64_t key) {
    std::map<std::int64_t, campaign::ImportedLine> lines;
    if (!has_table(db, table_of_imports)) return lines;
    auto rows = db.ask("SELECT number, name, hash, line FROM attempt_import WHERE case_key = ?", key);
    while (rows.next())
        lines.emplace(
            rows.get<std::int64_t>(0),
            campaign::ImportedLine{rows.get<std::string>(1), rows.get<std::string>(2), rows.get<std::int64_t>(3)});
    return lines;
}

std::map<std::int64_t, std::string> imported_campaigns(const Connection& db) {
    std::map<std::int64_t, std::string> campaigns;
    if (!has_table(db, "campaign_import")) return campaigns;
    auto rows = db.ask(
        "SELECT i.campaign_id, g.name FROM campaign_import AS i JOIN campaign AS g ON g.campaign_id = i.of_campaign");
    while (rows.next()) campaigns.emplace(rows.get<std::int64_t>(0), rows.get<std::string>(1));
    return campaigns;
}

std::vector<std::string> damaged_imports(const Connection& db) {
    std::vector<std::string> damaged;
    if (!has_table(db, table_of_imports)) return damaged;
    auto rows = db.ask(
        "SELECT i.case_key, i.number, i.name, i.hash, i.line, i.checksum, c.hash IS NULL FROM attempt_import AS i "
        "LEFT JOIN program_content AS c ON c.hash = i.hash");
    while (rows.next()) {
        const auto key = rows.get<std::int64_t>(0), number = rows.get<std::int64_t>(1);
        const auto name = rows.get<std::string>(2), hash = rows.get<std::string>(3);
        if (as_sql(sum_of_import(key, number, name, hash, rows.get<std::int64_t>(4))) != rows.get<std::int64_t>(5))
            damaged.push_back(
                fmt::format("table attempt_import: attempt {} of case {} is not as written", number, key));
        if (rows.get<std::int64_t>(6) != 0)
            damaged.push_back(fmt::format("table program_content: {}, imported file '{}', is missing", hash, name));
    }
    return damaged;
}

std::string count_of_imports(const Connection& db, std::string_view campaign) {
    if (!has_table(db, table_of_imports)) return "0";
    return fmt::format(
        "(SELECT count(*) FROM campaign_case AS p JOIN sim_case AS c ON c.case_key = p.case_key JOIN attempt_import AS "
        "i "
        "ON i.case_key = c.case_key AND i.number = (SELECT max(number) FROM attempt AS a WHERE a.case_key = c.case_key "
        "AND a.outcome = c.outcome) WHERE p.campaign_id = {})",
        campaign);
}

std::int64_t Store::imported_cases(std::string_view campaign) const {
    return impl_->db
        .value<std::int64_t>(fmt::format("SELECT {} WHERE ?1 > 0", count_of_imports(impl_->db, "?1")),
                             impl_->campaign_key(campaign))
        .value_or(0);
}

void Store::mark_imported(std::string_view campaign, std::string_view into) {
    impl_->require_group();
    impl_->db.run("INSERT INTO campaign_import (campaign_id, of_campaign) VALUES (?, ?) ON CONFLICT DO NOTHING",
                  impl_->campaign_key(campaign), impl_->campaign_key(into));
}

}  // namespace grainsweep::store
