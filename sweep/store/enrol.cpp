// Enrolling: enters a campaign and its cases in the archive, or joins them with stored ones.
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/stored_identity.hpp"
#include "sweep/store/archive.hpp"
#include "sweep/store/campaign_name.hpp"
#include "sweep/store/moment.hpp"
#include "sweep/store/soundness.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <stdexcept>

namespace grainsweep::store {

using campaign::Campaign;

namespace {

/// A campaign's name becomes the name of a view, so no table, fixed view or index may have it.
void refuse_taken_name(const Connection& db, const Campaign& campaign) {
    const auto taken =
        db.value<std::string>("SELECT type FROM sqlite_schema WHERE name = ? COLLATE NOCASE", campaign.name);
    if (!taken) return;
    throw campaign::input_error("$.campaign", campaign.name, fmt::format("the database has a {} of that name", *taken));
}

/// Declares the parameters and observables of the scene; returns the parameters sorted by name.
std::vector<DeclaredParameter> declare_scene(Store::Impl& archive, const SceneInfo& scene) {
    auto& db = archive.db;
    for (const auto& parameter : scene.parameters) {
        db.run(
            "INSERT INTO parameter (scene, revision, name, unit, meaning, default_value) VALUES (?, ?, ?, ?, ?, ?) "
            "ON CONFLICT (scene, revision, name) DO UPDATE SET unit = excluded.unit, meaning = excluded.meaning",
            scene.name, scene.revision, parameter.name, parameter.unit, parameter.meaning, parameter.default_value);
    }
    for (const auto& observable : scene.observables) {
        const char* shape = observable.shape == Shape::scalar   ? "scalar"
                            : observable.shape == Shape::series ? "series"
                                                                : "profile";
        db.run(
            "INSERT INTO observable (scene, revision, name, unit, meaning, shape) VALUES (?, ?, ?, ?, ?, ?) "
            "ON CONFLICT (scene, revision, name) DO UPDATE SET unit = excluded.unit, meaning = excluded.meaning, "
            "shape = excluded.shape",
            scene.name, scene.revision, observable.name, observable.unit, observable.meaning, shape);
    }
    std::vector<DeclaredParameter> parameters;
    auto rows = db.ask(
        "SELECT name, parameter_id, default_value FROM parameter WHERE scene = ? AND revision = ? "
        "ORDER BY name",
        scene.name, scene.revision);
    while (rows.next()) {
        parameters.push_back({rows.get<std::string>(0), rows.get<std::int64_t>(1), rows.value(2)});
        const auto* spec = scene.find_parameter(parameters.back().name);
        if (spec != nullptr && spec->default_value != parameters.back().default_value) {
            // Ids do not include default values. With another default the stored answers would belong to other cases.
            throw campaign::input_error(
                "$.scene", fmt::format("default {} = {}", spec->name, campaign::to_text(spec->default_value)),
                fmt::format("'{}' holds revision {} of {} with default {}: a changed default needs a new revision",
                            archive.file.string(), scene.revision, scene.name,
                            campaign::to_text(parameters.back().default_value)));
        }
    }
    return parameters;
}

/// The writer's lock is ours, so the program that began these attempts has ended.
void close_dead_attempts(Store::Impl& archive) {
    if (std::exchange(archive.dead_attempts_closed, true)) return;
    auto& db = archive.db;
    std::vector<std::pair<std::int64_t, std::int64_t>> dead;
    {
        auto rows = db.ask("SELECT case_key, number FROM attempt WHERE outcome IS NULL");
        while (rows.next()) dead.emplace_back(rows.get<std::int64_t>(0), rows.get<std::int64_t>(1));
    }
    for (const auto& [key, number] : dead) {
        db.run(
            "UPDATE attempt SET outcome = 'abandoned', message = 'the run that began it ended before it did' "
            "WHERE case_key = ? AND number = ?",
            key, number);
        renew_attempt(db, key, number);
        const auto changed = db.run(  // an answer stands until the next one is there
            "UPDATE sim_case SET outcome = 'abandoned', wall_seconds = NULL WHERE case_key = ? "
            "AND coalesce(outcome, '') NOT IN ('completed', 'skipped', 'unstable', 'rejected')",
            key);
        if (changed == 0) continue;
        db.run("DELETE FROM observation WHERE case_key = ?", key);
        renew_answer(db, key);
    }
}

std::string gates_text(const campaign::Convergence& rule) {
    std::string text;
    for (const auto& gate : rule.gates) text += (text.empty() ? "" : " ") + gate;
    return text;
}

/// Stores the present rule; verdicts by another rule, and a stop that is no longer wanted, are forgotten.
void store_rule(Connection& db, std::int64_t campaign_key, const std::optional<campaign::Convergence>& rule) {
    if (!rule) {
        const auto changed = db.run(
            "UPDATE campaign SET convergence_observable = NULL, convergence_rule = NULL, convergence_gates = NULL, "
            "convergence_tolerance = NULL, convergence_block = NULL, convergence_stop = NULL "
            "WHERE campaign_id = ? AND convergence_rule IS NOT NULL",
            campaign_key);
        if (changed > 0) forget_convergence(db, campaign_key);
        return;
    }
    const auto changed = db.run(
        "UPDATE campaign SET convergence_observable = ?1, convergence_rule = ?2, convergence_gates = ?3, "
        "convergence_tolerance = ?4, convergence_block = ?5 WHERE campaign_id = ?6 AND (convergence_observable, "
        "convergence_rule, convergence_gates, convergence_tolerance, convergence_block) IS NOT (?1, ?2, ?3, ?4, ?5)",
        rule->observable, rule->rule, gates_text(*rule), rule->tolerance, rule->block, campaign_key);
    if (changed > 0) forget_convergence(db, campaign_key);
    db.run("UPDATE campaign SET convergence_stop = ?1, stopped_at = iif(?1, stopped_at, NULL) WHERE campaign_id = ?2",
           rule->stop, campaign_key);
}

/// Points the design numbers; where its options are not known, as many as are placed.
std::int64_t candidates_in(const Campaign& campaign, const campaign::Cases& cases) {
    std::int64_t candidates = 0;
    for (std::size_t i = 0; i < cases.size(); ++i)
        candidates = std::max(candidates, std::int64_t{cases.place(i).point} + 1);
    try {
        candidates = std::max(candidates, campaign::candidates_of(campaign));
    } catch (const std::invalid_argument&) {  // a campaign that no file was read for
    }
    return candidates;
}

/// What is asked now; what is stored grows to it where the design extends, and changes with it elsewhere.
void store_extent(Store::Impl& archive, const Campaign& campaign, std::int64_t key, std::int64_t candidates) {
    archive.db.run(
        "UPDATE campaign SET replicates = max(replicates, ?1), candidates = iif(?2, max(coalesce(candidates, (SELECT "
        "max(point) + 1 FROM campaign_case AS p WHERE p.campaign_id = campaign.campaign_id), 0), ?3), ?3), "
        "asked_candidates = ?3, asked_replicates = ?1 WHERE campaign_id = ?4",
        campaign.replicates, designs::design_named(campaign.design).extends, candidates, key);
}

std::int64_t store_campaign(Store::Impl& archive, const Campaign& campaign, const campaign::Cases& cases) {
    auto& db = archive.db;
    const auto known = match_campaign(archive, campaign);
    auto identity = campaign::identity_of(campaign);
    std::int64_t key = 0;
    if (known) {
        key = known->key;
        campaign::keep_extent(identity, known->identity);
    } else {
        const auto texts = campaign::texts_of(identity);
        check_campaign_name(campaign.name);
        refuse_taken_name(db, campaign);
        db.run(
            "INSERT INTO campaign (name, scene, revision, seed, factors, fixed, condition, design, design_options, "
            "design_extent, sequences, replicates) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
            campaign.name, campaign.scene().name, campaign.scene().revision, static_cast<std::int64_t>(campaign.seed),
            texts.factors, texts.fixed, campaign.where, campaign.design, texts.options, texts.extent,
            campaign::sequences_of(campaign), campaign.replicates);
        key = db.last_row();
    }
    store_identity(db, key, identity);
    store_extent(archive, campaign, key, candidates_in(campaign, cases));
    store_rule(db, key, campaign.convergence);
    return key;
}

void store_provenance(Store::Impl& archive, const Campaign& campaign, std::int64_t key, const Provenance& by) {
    if (archive.provenance && archive.provenance_campaign == key) return;  // the same run, its design refined
    archive.run_clock = {};
    archive.db.run(
        "INSERT INTO provenance (campaign_id, version, \"commit\", compiler, flags, instruction_path, processor, host, "
        "start, campaign_text, campaign_hash, process) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
        key, by.version, by.commit, by.compiler, by.flags, by.instruction_path, by.processor, by.host,
        archive.run_clock.start(), campaign.text, campaign::content_hash(campaign.text), std::int64_t{getpid()});
    archive.provenance = archive.db.last_row();
    archive.provenance_campaign = key;
}

/// Data about the file in memory, restored if enrolling fails and is rolled back.
class Remembered {
public:
    explicit Remembered(Store::Impl& archive)
        : archive_(&archive),
          provenance_(archive.provenance),
          campaign_(archive.provenance_campaign),
          closed_(archive.dead_attempts_closed) {}
    Remembered(const Remembered&) = delete;
    Remembered& operator=(const Remembered&) = delete;
    ~Remembered() {
        if (archive_ == nullptr) return;
        archive_->provenance = provenance_;
        archive_->provenance_campaign = campaign_;
        archive_->dead_attempts_closed = closed_;
    }
    void keep() { archive_ = nullptr; }

private:
    Store::Impl* archive_;
    std::optional<std::int64_t> provenance_;
    std::int64_t campaign_;
    bool closed_;
};

/// Verdicts that are not as written are given anew.
void drop_damaged_verdicts(Store::Impl& archive, std::int64_t campaign_key) {
    auto& db = archive.db;
    if (sum_of_table(db, "convergence", campaign_key) == stored_sum(db, "convergence", campaign_key)) return;
    archive.notes.push_back("the verdicts on convergence were damaged in the database and are given anew");
    forget_convergence(db, campaign_key);
}

/// Returns whether enrolling this campaign repairs all damage.
bool only_of(std::int64_t campaign_key, const std::vector<DamagedTable>& damaged) {
    return std::ranges::all_of(damaged, [&](const DamagedTable& one) { return one.part == campaign_key; });
}

}  // namespace

std::vector<CaseState> Store::enrol(const Campaign& campaign, const campaign::Cases& cases,
                                    const Provenance& provenance, std::size_t at_once) {
    impl_->require_writer();
    impl_->placing.reset();
    impl_->open.clear();
    Remembered remembered(*impl_);
    auto& db = impl_->db;
    Transaction transaction(db);
    impl_->bring_up_to_date();
    impl_->notes.clear();
    if (impl_->data_version() != impl_->version) impl_->as_remembered = false;
    impl_->refuse_damage(damaged_descriptions(db), {});
    if (!impl_->as_remembered) impl_->refuse_damage(tables_out_of_order(db), {});
    close_dead_attempts(*impl_);
    const std::int64_t key = store_campaign(*impl_, campaign, cases);
    const auto parameters = declare_scene(*impl_, campaign.scene());
    impl_->observables.clear();
    store_provenance(*impl_, campaign, key, provenance);
    store_program(db, campaign);
    store_machine(db, campaign);
    store_files(db, key, campaign);

    KnownCases known = known_cases(db, cases);
    const bool as_remembered = std::exchange(impl_->as_remembered, false);
    impl_->whole = as_remembered;
    if (!as_remembered) {
        const bool others_sound = ask_damaged_again(*impl_, cases, parameters, known);
        drop_damaged_verdicts(*impl_, key);
        impl_->whole = others_sound && only_of(key, damaged_parts(db));
    }
    Placing placing(cases, std::move(known.keys), parameters, key);
    if (placing.adds_to(db)) {
        if (placing.inside()) forget_convergence(db, key);
        placing.enter(db, at_once);
    } else {
        placing.enter_cases(db);
        place_anew(*impl_, campaign, key, cases, placing);
        placing = {{}, {}, {}, key};
    }
    impl_->refuse_damage(damaged_numbers(db, key), {});
    make_views(*impl_, campaign, key);
    renew_descriptions(db);
    transaction.commit();
    impl_->sound = true;
    if (!placing.done()) impl_->placing.emplace(std::move(placing));
    remembered.keep();
    return std::move(known.states);
}

bool Store::enrols() const {
    return impl_->placing.has_value();
}

void Store::enrol_more(std::size_t places) {
    if (!impl_->placing) return;
    impl_->require_writer();
    impl_->require_in_place();
    // Where this fails, it no longer says what is in the file.
    Placing placing = std::move(*std::exchange(impl_->placing, std::nullopt));
    Transaction transaction(impl_->db);
    placing.enter(impl_->db, places);
    transaction.commit();
    impl_->sound = false;
    if (!placing.done()) impl_->placing.emplace(std::move(placing));
}

}  // namespace grainsweep::store
