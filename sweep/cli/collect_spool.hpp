// `collect`: imports the answers of a spool into a database.
#pragma once

#include "sweep/campaign/campaign.hpp"
#include "sweep/campaign/cases.hpp"
#include "sweep/spool/collect.hpp"
#include "sweep/store/store.hpp"
#include "sweep/workers/crew.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace grainsweep::cli {

/// Returns the campaign of a spool. Throws WrongQuestion if there is none, or a file that it names has changed.
[[nodiscard]] campaign::Campaign campaign_of_spool(const std::filesystem::path& spool);
/// Throws WrongQuestion if these are not the cases of the spool.
void refuse_other_cases(const std::filesystem::path& spool, const campaign::Cases& cases);
/// Imports the answers into the database, in which the cases must be enrolled, and into their states.
[[nodiscard]] spool::Collected import_answers(const std::filesystem::path& spool, const campaign::Campaign& campaign,
                                              const campaign::Cases& cases, store::Store& store,
                                              std::vector<store::CaseState>& states,
                                              const std::function<void(const std::string&)>& note);

/// Crew of a run that computes no case.
class NoCrew final : public workers::Crew {
public:
    void expect(std::size_t) override {}
    [[nodiscard]] std::optional<workers::Place> place_for(double) override { return std::nullopt; }
    void give(const workers::Place&, const campaign::Attempt&, const campaign::Case&) override {}
    [[nodiscard]] std::optional<workers::PoolEvent> wait(std::chrono::milliseconds) override { return std::nullopt; }
    void retire() override {}
    void dismiss() override {}
};

}  // namespace grainsweep::cli
