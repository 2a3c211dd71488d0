#include "tests/support/whole_campaign.hpp"

#include "sweep/campaign/input_error.hpp"
#include "sweep/store/database.hpp"

#include <algorithm>

namespace grainsweep::tests {

void WholeCampaign::run(const std::filesystem::path& file, const std::function<void(std::size_t)>& shown) const {
    store::Store store(file, store::Store::Mode::create, disk);
    const auto states = store.enrol(campaign, cases, here());
    std::size_t settled = 0;
    std::vector<std::pair<const campaign::Case*, std::int64_t>> open;
    for (std::size_t k = 0; k < cases.size(); ++k) {
        const auto& state = states[k];
        if (state.outcome && campaign::settles(*state.outcome)) {
            ++settled;
        } else {
            open.emplace_back(&cases[k].question, state.attempts + 1);
        }
    }
    shown(settled);
    for (std::size_t first = 0; first < open.size(); first += group_size) {
        const auto group = std::span(open).subspan(first, std::min(group_size, open.size() - first));
        store.group([&] {
            for (const auto& [question, attempt] : group) store.begin({question->id, attempt});
        });
        store.group([&] {
            for (const auto& [question, attempt] : group) store.finish(answer(*question, attempt));
        });
        settled += group.size();
        shown(settled);
    }
}

std::string WholeCampaign::undisturbed() const {
    const Folder folder;
    run(folder / "whole.db", [](std::size_t) {});
    return dump_of(store::Store(folder / "whole.db", store::Store::Mode::read));
}

std::string complaints(const std::filesystem::path& file) {
    const store::Connection db(file, store::Connection::Access::read);
    std::string text;
    const auto collect = [&](const char* sql) {
        auto statement = db.prepare(sql);
        while (statement.step()) text += statement.get<std::string>(0) + '\n';
    };
    collect("PRAGMA integrity_check");
    if (text == "ok\n") text.clear();
    collect("PRAGMA foreign_key_check");
    auto tables = db.prepare("SELECT count(*) FROM sqlite_schema WHERE name = 'sim_case'");
    if (tables.step() && tables.get<std::int64_t>(0) == 1) {
        collect(
            "SELECT 'completed without its answer: ' || case_id FROM sim_case AS c WHERE (outcome = 'completed') <> "
            "EXISTS (SELECT 1 FROM observation AS o WHERE o.case_key = c.case_key)");
        collect(
            "SELECT 'attempts disagree: ' || case_id FROM sim_case AS c WHERE attempts <> coalesce((SELECT max(number) "
            "FROM attempt AS t WHERE t.case_key = c.case_key), 0)");
    }
    return text.empty() ? "ok" : text;
}

std::int64_t completed_in(const std::filesystem::path& file) {
    try {
        const store::Store store(file, store::Store::Mode::read);
        const auto status = store.status();
        if (status.rows.empty()) return -1;
        const auto column = std::ranges::find(status.columns, "completed") - status.columns.begin();
        return std::get<std::int64_t>(status.rows[0][static_cast<std::size_t>(column)]);
    } catch (const campaign::InputError&) {  // nothing there yet
        return -1;
    }
}

}  // namespace grainsweep::tests
