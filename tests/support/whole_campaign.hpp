// A short campaign run the way the scheduler does, and what must hold of its archive after any misfortune.
#pragma once

#include "tests/support/archive.hpp"

#include <filesystem>
#include <functional>
#include <set>
#include <string>

namespace grainsweep::tests {

struct WholeCampaign {
    campaign::Campaign campaign = small_campaign("misfortune");
    std::vector<campaign::PlacedCase> cases;
    std::size_t group_size = 3;
    store::Store::Disk disk = store::Store::Disk::found_out;

    explicit WholeCampaign(std::int64_t points, store::Store::Disk on = store::Store::Disk::found_out)
        : cases(small_design(campaign, points)), disk(on) {}

    /// Opens the archive, enrols, and settles what is not settled, a few cases to a group.
    /// `shown` gets the number of cases settled so far, after each group and once after enrolling.
    void run(const std::filesystem::path& file, const std::function<void(std::size_t settled)>& shown) const;
    /// The dump of a run that nothing disturbed.
    [[nodiscard]] std::string undisturbed() const;
};

/// "ok", or what SQLite's integrity check, foreign keys or a forbidden state of ours complain about.
[[nodiscard]] std::string complaints(const std::filesystem::path& file);
/// Completed cases in the file, -1 where it has no campaign yet.
[[nodiscard]] std::int64_t completed_in(const std::filesystem::path& file);

}  // namespace grainsweep::tests
