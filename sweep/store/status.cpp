// How far the campaigns of an archive have come.
#include "sweep/store/archive.hpp"

#include <fmt/format.h>

namespace grainsweep::store {

Table Store::status() const {
    Table table;
    table.columns = {"campaign", "scene", "cases"};
    for (const auto outcome : campaign::outcomes) table.columns.emplace_back(campaign::to_string(outcome));
    for (const char* name : {"waiting", "stopped_at", "rate", "time_left", "candidates", "dropped", "points",
                             "replicates", "finished", "asked_points", "asked_replicates", "imported"})
        table.columns.emplace_back(name);

    // rate: answers per second of the last run; time_left: s, for what is waiting or abandoned, at that rate.
    auto rows = impl_->db.ask(fmt::format(
        "WITH count AS (SELECT p.campaign_id, c.outcome, count(*) AS cases FROM campaign_case AS p "
        "  JOIN sim_case AS c ON c.case_key = p.case_key GROUP BY p.campaign_id, c.outcome), "
        "last AS (SELECT campaign_id, max(provenance_id), "
        "  iif(last_result > start, settled / ((julianday(last_result) - julianday(start)) * 86400.0), NULL) AS rate "
        "  FROM provenance WHERE settled > 0 GROUP BY campaign_id), "
        "total AS (SELECT g.campaign_id, g.name, g.scene, g.stopped_at, "
        "  coalesce((SELECT sum(cases) FROM count AS n WHERE n.campaign_id = g.campaign_id), 0) AS cases, "
        "  coalesce((SELECT sum(cases) FROM count AS n WHERE n.campaign_id = g.campaign_id "
        "    AND (n.outcome IS NULL OR n.outcome = 'abandoned')), 0) AS open, l.rate "
        "  FROM campaign AS g LEFT JOIN last AS l ON l.campaign_id = g.campaign_id), "
        "extent (campaign_id, replicates, points, candidates, asked_points, asked_replicates) AS "
        "  (SELECT g.campaign_id, g.replicates, (SELECT count(DISTINCT point) FROM campaign_case AS p "
        "  WHERE p.campaign_id = g.campaign_id), {} FROM campaign AS g) "
        "SELECT t.name, t.scene, t.cases, t.stopped_at, t.rate, iif(t.stopped_at IS NULL, t.open / t.rate, 0.0), "
        "  e.candidates, e.candidates - e.points, e.points, e.replicates, t.cases - t.open, e.asked_points, "
        "  e.asked_replicates, {}, n.outcome, n.cases FROM total AS t JOIN extent AS e ON e.campaign_id = "
        "t.campaign_id "
        "LEFT JOIN count AS n ON n.campaign_id = t.campaign_id ORDER BY t.campaign_id",
        extent_columns(impl_->keeps_extents()), count_of_imports(impl_->db, "t.campaign_id")));
    constexpr int outcome_column = 14;
    const std::size_t first_outcome = 3;
    const std::size_t waiting = first_outcome + campaign::outcomes.size();
    while (rows.next()) {
        const Table::Cell name = rows.get<std::string>(0);
        if (table.rows.empty() || table.rows.back().front() != name) {
            auto& row = table.rows.emplace_back(table.columns.size(), Table::Cell(std::int64_t{0}));
            row[0] = name;
            row[1] = rows.cell(1);
            row[2] = rows.cell(2);
            for (int column = 3; column < outcome_column; ++column)
                row[waiting + static_cast<std::size_t>(column) - 2] = rows.cell(column);
        }
        if (rows.is_null(outcome_column + 1)) continue;  // a campaign without cases
        const auto outcome = outcome_at(rows, outcome_column);
        table.rows.back()[outcome ? first_outcome + static_cast<std::size_t>(*outcome) : waiting] =
            rows.cell(outcome_column + 1);
    }
    return table;
}

}  // namespace grainsweep::store
