// Machines in the archive: definitions, the contents of files.
#include "sweep/campaign/machine.hpp"
#include "sweep/store/archive.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <vector>

namespace grainsweep::store {
namespace {

struct StoredMachine {
    std::string scene, definition;
};

std::vector<StoredMachine> stored_machines(const Connection& db) {
    std::vector<StoredMachine> all;
    if (!has_table(db, "machine")) return all;
    auto rows = db.ask("SELECT scene, definition FROM machine NOT INDEXED ORDER BY scene");
    while (rows.next()) all.push_back({rows.get<std::string>(0), rows.get<std::string>(1)});
    return all;
}

/// Returns nullptr, with the reason in `why`, if the text is no definition, if it is the definition of another scene,
/// or if a file has changed.
std::shared_ptr<const campaign::Machine> machine_of(const Connection& db, const StoredMachine& stored,
                                                    std::string& why) {
    const auto contents_of = [&](const std::string& hash) {
        auto rows = db.ask("SELECT contents FROM program_content WHERE hash = ?", hash);
        std::string contents = rows.next() ? std::string(rows.blob(0)) : std::string();
        if (campaign::content_hash(contents) != hash)
            throw std::invalid_argument(fmt::format("the contents of file {} are not as written", hash));
        return contents;
    };
    try {
        auto machine = campaign::machine_in(stored.definition, contents_of);
        if (campaign::machine_scene_name(*machine) == stored.scene) return machine;
        why = "is not as written";
    } catch (const std::invalid_argument& refused) {
        why = fmt::format("is refused: {}", refused.what());
    }
    return nullptr;
}

}  // namespace

void enter_machines(const Connection& db) {
    for (const auto& stored : stored_machines(db)) {
        if (find_scene(stored.scene) != nullptr) continue;
        std::string why;
        if (auto machine = machine_of(db, stored, why)) campaign::enter_machine(std::move(machine));
    }
}

void store_machine(Connection& db, const campaign::Campaign& campaign) {
    const auto machine = campaign::known_machine(campaign.scene().name);
    if (machine == nullptr) return;
    for (const auto& [name, contents] : machine->files)
        db.run("INSERT INTO program_content (hash, contents) VALUES (?, ?) ON CONFLICT DO NOTHING",
               campaign::content_hash(contents), Blob{contents});
    db.run(
        "INSERT INTO machine (scene, name, definition) VALUES (?, ?, ?) ON CONFLICT DO UPDATE SET name = "
        "excluded.name, "
        "definition = excluded.definition",
        campaign.scene().name, machine->name, campaign::machine_text(*machine));
}

std::vector<std::string> damaged_machines(const Connection& db) {
    std::vector<std::string> damaged;
    for (const auto& stored : stored_machines(db)) {
        std::string why;
        if (machine_of(db, stored, why) == nullptr)
            damaged.push_back(fmt::format("table machine: the definition of {} {}", stored.scene, why));
    }
    return damaged;
}

}  // namespace grainsweep::store
