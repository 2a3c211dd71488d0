// Programs in the archive: definitions, contents of files, messages on attempts.
#include "sweep/store/archive.hpp"

#include <fmt/format.h>

#include <set>
#include <stdexcept>
#include <utility>

namespace grainsweep::store {
namespace {

std::uint64_t sum_of_facts(std::int64_t key, std::int64_t number, const std::optional<std::string>& version,
                           double peak_memory, const std::optional<std::int64_t>& status) {
    Digest digest;
    digest.add(key).add(number);
    if (version)
        digest.add(std::string_view(*version));
    else
        digest.absent();
    return digest.add(peak_memory).add(status).value();
}

/// None where the text is no definition, that of another scene, or of a program that no campaign file may ask for;
/// `why` says so.
std::optional<campaign::Program> definition_in(const std::string& text, std::string_view scene, std::string& why) {
    why = "is not as written";
    try {
        auto program = campaign::program_in(text);
        if (campaign::program_scene_name(program) == scene) return program;
    } catch (const std::invalid_argument& refused) {
        why = fmt::format("is refused: {}", refused.what());
    }
    return std::nullopt;
}

/// Column by column: scene, definition.
std::vector<std::pair<std::string, std::string>> definitions(const Connection& db) {
    std::vector<std::pair<std::string, std::string>> all;
    auto rows = db.ask("SELECT scene, definition FROM program NOT INDEXED ORDER BY scene");
    while (rows.next()) all.emplace_back(rows.get<std::string>(0), rows.get<std::string>(1));
    return all;
}

}  // namespace

bool has_programs(const Connection& db) {
    return has_table(db, "attempt_program");
}

void enter_programs(const Connection& db) {
    if (!has_programs(db)) return;
    for (const auto& [scene, text] : definitions(db)) {
        if (find_scene(scene) != nullptr) continue;
        std::string why;
        if (auto program = definition_in(text, scene, why))
            campaign::enter_program(std::make_shared<const campaign::Program>(std::move(*program)));
    }
}

void store_program(Connection& db, const campaign::Campaign& campaign) {
    const auto program = campaign::known_program(campaign.scene().name);
    if (program == nullptr) return;
    for (const auto& file : program->files) {
        if (file.contents.empty() && campaign::content_hash("") != file.hash) continue;  // from the archive itself
        db.run("INSERT INTO program_content (hash, contents) VALUES (?, ?) ON CONFLICT DO NOTHING", file.hash,
               Blob{file.contents});
    }
    db.run(
        "INSERT INTO program (scene, definition) VALUES (?, ?) ON CONFLICT DO UPDATE SET definition = "
        "excluded.definition",
        campaign.scene().name, campaign::program_text(*program));
}

std::shared_ptr<const campaign::Program> Store::program(std::string_view scene) const {
    const auto& db = impl_->db;
    if (!campaign::is_program(scene) || !has_programs(db)) return nullptr;
    const auto damaged = [&](const std::string& what) {
        return SystemError(fmt::format("database '{}': damaged: {}", impl_->file.string(), what));
    };
    std::optional<campaign::Program> program;
    {
        auto rows = db.ask("SELECT definition FROM program WHERE scene = ?", scene);
        if (!rows.next()) return nullptr;
        std::string why;
        program = definition_in(rows.get<std::string>(0), scene, why);
        if (!program) throw damaged(fmt::format("the definition of {} {}", scene, why));
    }
    for (auto& file : program->files) {
        auto rows = db.ask("SELECT contents FROM program_content WHERE hash = ?", file.hash);
        if (rows.next()) file.contents = rows.blob(0);
        if (campaign::content_hash(file.contents) != file.hash)
            throw damaged(fmt::format("the contents of '{}' are not as written", file.name));
    }
    return std::make_shared<const campaign::Program>(std::move(*program));
}

void store_program_facts(Connection& db, std::int64_t key, std::int64_t number, const campaign::ProgramFacts& facts) {
    const auto version = facts.version.empty() ? std::nullopt : std::optional(facts.version);
    db.run(
        "INSERT OR REPLACE INTO attempt_program (case_key, number, version, peak_memory, exit_status, checksum) "
        "VALUES (?, ?, ?, ?, ?, ?)",
        key, number, version, facts.peak_memory, facts.exit_status,
        as_sql(sum_of_facts(key, number, version, facts.peak_memory, facts.exit_status)));
}

std::map<std::int64_t, campaign::ProgramFacts> program_facts(const Connection& db, std::int64_t key) {
    std::map<std::int64_t, campaign::ProgramFacts> facts;
    if (!has_programs(db)) return facts;
    auto rows = db.ask(
        "SELECT number, version, peak_memory, exit_status, checksum FROM attempt_program WHERE case_key = ?", key);
    while (rows.next()) {
        const auto number = rows.get<std::int64_t>(0);
        const auto version = rows.get<std::optional<std::string>>(1);
        const auto status = rows.get<std::optional<std::int64_t>>(3);
        if (as_sql(sum_of_facts(key, number, version, rows.get<double>(2), status)) != rows.get<std::int64_t>(4))
            throw SystemError(
                fmt::format("the database is damaged: table attempt_program: attempt {} of case {} is not as written",
                            number, key));
        facts.emplace(number, campaign::ProgramFacts{version.value_or(""), rows.get<double>(2), status});
    }
    return facts;
}

std::vector<std::string> damaged_programs(const Connection& db) {
    std::vector<std::string> damaged;
    if (!has_programs(db)) return damaged;
    std::set<std::string> needed;
    for (const auto& [scene, text] : definitions(db)) {
        std::string why;
        const auto program = definition_in(text, scene, why);
        if (!program) damaged.push_back(fmt::format("table program: {} {}", scene, why));
        if (program)
            for (const auto& file : program->files) needed.insert(file.hash);
    }
    {
        auto rows = db.ask("SELECT hash, contents FROM program_content NOT INDEXED");
        while (rows.next()) {
            const auto hash = rows.get<std::string>(0);
            needed.erase(hash);
            if (campaign::content_hash(rows.blob(1)) != hash)
                damaged.push_back(fmt::format("table program_content: {} is not as written", hash));
        }
    }
    for (const auto& hash : needed) damaged.push_back(fmt::format("table program_content: {} is missing", hash));
    auto rows = db.ask("SELECT case_key, number, version, peak_memory, exit_status, checksum FROM attempt_program");
    while (rows.next()) {
        const auto key = rows.get<std::int64_t>(0), number = rows.get<std::int64_t>(1);
        const auto sum = sum_of_facts(key, number, rows.get<std::optional<std::string>>(2), rows.get<double>(3),
                                      rows.get<std::optional<std::int64_t>>(4));
        if (as_sql(sum) != rows.get<std::int64_t>(5))
            damaged.push_back(
                fmt::format("table attempt_program: attempt {} of case {} is not as written", number, key));
    }
    return damaged;
}

}  // namespace grainsweep::store
