#include "tests/support/archive.hpp"

#include "sweep/store/database.hpp"

#include "solver/scenes/catalogue.hpp"

#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <stdexcept>

namespace grainsweep::tests {

campaign::Campaign small_campaign(const std::string& name, std::size_t factors) {
    static const SceneInfo scene = rehearsal_scene();
    campaign::Campaign campaign;
    campaign.name = name;
    campaign.space.scene = unowned(scene);
    for (std::size_t j = 1; j <= factors; ++j) {
        campaign.space.factors.push_back({"x" + std::to_string(j), campaign::Between{0, 1, campaign::Scale::linear}});
    }
    campaign.design = "halton";
    campaign.request.levels.assign(factors, 0);
    campaign.request.options = {
        {"scramble", std::string("random")}, {"points", std::int64_t{8}}, {"sequences", std::int64_t{2}}};
    campaign.text = "{\"campaign\": \"" + name + "\"}";
    return campaign;
}

campaign::Case question(const campaign::Campaign& campaign, const Inputs& inputs, std::int64_t replicate) {
    const auto& scene = campaign.scene();
    static const Inputs defaults = scene.defaults();
    campaign::Case asked;
    asked.scene = scene.name;
    asked.revision = scene.revision;
    asked.inputs = inputs;
    const auto unseeded = campaign::canonical_text(scene.name, scene.revision, inputs, defaults, std::nullopt);
    asked.seed = campaign::case_seed(campaign.seed, unseeded, replicate);
    asked.id =
        campaign::content_hash(campaign::canonical_text(scene.name, scene.revision, inputs, defaults, asked.seed));
    return asked;
}

std::vector<campaign::PlacedCase> small_design(const campaign::Campaign& campaign, std::int64_t points) {
    static const Inputs defaults = campaign.scene().defaults();
    std::vector<campaign::PlacedCase> cases;
    for (std::int64_t point = 0; point < points; ++point) {
        Inputs inputs = defaults;
        double u = std::fmod(0.618033988749895 * static_cast<double>(point + 1), 1.0);
        for (const auto& factor : campaign.space.factors) {
            inputs.find(factor.name)->second = u;
            u = std::fmod(u * 7.3, 1.0);
        }
        for (std::int64_t replicate = 0; replicate < campaign.replicates; ++replicate) {
            cases.push_back({question(campaign, inputs, replicate), point, point % 2, replicate});
        }
    }
    return cases;
}

store::Provenance here() {
    return {"0.1.0", "abc123", "g++ 12", "-O3", "x86-64-v2", "a processor", "a host"};
}

campaign::CaseResult answer(const campaign::Case& question, std::int64_t attempt) {
    campaign::CaseResult result;
    result.attempt = {question.id, attempt};
    result.observations.scalars["y"] = static_cast<double>(std::stoull(question.id.substr(0, 12), nullptr, 16)) / 3e14;
    result.cost.wall_seconds = 0.25;
    return result;
}

void settle(store::Store& store, const campaign::Case& question, std::int64_t attempt) {
    store.group([&] {
        store.begin({question.id, attempt});
        if (!store.finish(answer(question, attempt))) throw std::logic_error("taken for stale");
    });
}

void take_back_to_schema(int version, const std::filesystem::path& file) {
    store::Connection db(file, store::Connection::Access::write);
    db.execute(  // 12
        "ALTER TABLE campaign DROP COLUMN resolved; DELETE FROM table_checksum WHERE name = 'campaign.resolved'; "
        "PRAGMA "
        "user_version = 11");
    if (version == 11) return;
    db.execute("DROP TABLE attempt_import; DROP TABLE campaign_import; PRAGMA user_version = 10");  // 11
    if (version == 10) return;
    db.execute("DROP TABLE campaign_file; PRAGMA user_version = 9");  // 10
    if (version == 9) return;
    db.execute("DROP TABLE machine; PRAGMA user_version = 8");  // 9
    if (version == 8) return;
    db.execute("ALTER TABLE attempt DROP COLUMN threads; PRAGMA user_version = 7");  // 8
    if (version == 7) return;
    db.execute(  // 7
        "DROP TABLE program; DROP TABLE program_content; DROP TABLE attempt_program; PRAGMA user_version = 6");
    if (version == 6) return;
    db.execute("DROP TABLE file_checksum; PRAGMA user_version = 5");  // 6
    if (version == 5) return;
    db.execute(  // 5
        "DROP TABLE table_checksum; ALTER TABLE sim_case DROP COLUMN checksum; ALTER TABLE sim_case DROP COLUMN "
        "checksum_by_observable; ALTER TABLE attempt DROP COLUMN checksum; PRAGMA user_version = 4");
    if (version == 4) return;
    // 4: a column with a foreign key cannot be dropped
    db.execute(
        "CREATE TABLE attempt_1 (case_key INTEGER NOT NULL REFERENCES sim_case, number INTEGER NOT NULL, "
        "provenance_id INTEGER NOT NULL REFERENCES provenance, started TEXT NOT NULL, outcome TEXT, message TEXT, "
        "wall_seconds REAL, cpu_seconds REAL, particle_steps REAL, phases TEXT, PRIMARY KEY (case_key, number)) "
        "STRICT, WITHOUT ROWID;"
        "INSERT INTO attempt_1 SELECT case_key, number, provenance_id, started, outcome, message, wall_seconds, "
        "cpu_seconds, particle_steps, phases FROM attempt;"
        "DROP TABLE attempt; ALTER TABLE attempt_1 RENAME TO attempt; DROP TABLE attempt_computer");
    for (const char* column : {"candidates", "asked_candidates", "asked_replicates"})  // 3
        if (version < 3) db.execute("ALTER TABLE campaign DROP COLUMN " + std::string(column));
    if (version < 2) db.execute("DROP INDEX campaign_case_by_case; ALTER TABLE provenance DROP COLUMN process");
    db.execute("PRAGMA user_version = " + std::to_string(version));
}

std::string dump_of(const store::Store& store) {
    std::string text;
    store.dump([&](std::string_view line) { text.append(line).append("\n"); });
    return text;
}

std::string text_of(const store::Table::Cell& cell) {
    if (std::holds_alternative<std::monostate>(cell)) return "NULL";
    if (const auto* whole = std::get_if<std::int64_t>(&cell)) return std::to_string(*whole);
    if (const auto* real = std::get_if<double>(&cell)) return campaign::shortest(*real);
    return std::get<std::string>(cell);
}

std::string only_cell(const store::Store& store, std::string_view sql) {
    const auto table = store.query(sql);
    if (table.rows.size() != 1 || table.columns.size() != 1) throw std::logic_error("one cell was expected");
    return text_of(table.rows[0][0]);
}

}  // namespace grainsweep::tests
