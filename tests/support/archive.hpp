// What the tests of the store need: campaigns of the rehearsal scene made by hand, and answers made up from their ids.
#pragma once

#include "sweep/campaign/campaign.hpp"
#include "sweep/store/store.hpp"
#include "tests/support/process.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::tests {

/// `factors` factors x1, x2, ... between 0 and 1 over the rehearsal scene, a Halton design.
[[nodiscard]] campaign::Campaign small_campaign(const std::string& name, std::size_t factors = 2);
/// Points 0 ... points-1 with evenly spread coordinates, each `campaign.replicates` times.
[[nodiscard]] std::vector<campaign::PlacedCase> small_design(const campaign::Campaign& campaign, std::int64_t points);
[[nodiscard]] campaign::Case question(const campaign::Campaign& campaign, const Inputs& inputs, std::int64_t replicate);

[[nodiscard]] store::Provenance here();
/// The answer every run would give to the case: y from its id.
[[nodiscard]] campaign::CaseResult answer(const campaign::Case& question, std::int64_t attempt);
/// begin and finish, in one group.
void settle(store::Store& store, const campaign::Case& question, std::int64_t attempt);

/// Gives the file the form of an older schema (1, 2, 4 or 5), with what is in it.
void take_back_to_schema(int version, const std::filesystem::path& file);

[[nodiscard]] std::string dump_of(const store::Store& store);
/// The only cell of a query's answer, as text.
[[nodiscard]] std::string only_cell(const store::Store& store, std::string_view sql);
[[nodiscard]] std::string text_of(const store::Table::Cell& cell);

}  // namespace grainsweep::tests
